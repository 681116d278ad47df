//! What may differ from the even beam, or plate: shear stiffness lost over a span, rotary inertia, supports that yield.

use crate::ModelError;

/// Terms of stiffness and mass beyond the even beam with ideal ends.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamTerms {
    /// Factor \[1\] on the rotary inertia $\rho I = \rho t\,b\,t^2/12$ of evenly spread mass.
    pub rotary_factor: f64,
    /// Spans that have lost shear stiffness.
    pub losses: Vec<ShearLoss>,
    /// What holds every clamped end, or edge, where that is not rigid.
    pub support: Option<Support>,
}

impl Default for BeamTerms {
    fn default() -> Self {
        Self { rotary_factor: 1.0, losses: vec![], support: None }
    }
}

impl BeamTerms {
    /// Checks that stiffness and inertia stay positive.
    ///
    /// # Errors
    /// [`ModelError::Size`] names the first number that has no physical meaning.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        let mut sizes = vec![("rotary factor", self.rotary_factor, "")];
        for loss in &self.losses {
            sizes
                .extend([("remaining shear stiffness", 1.0 - loss.loss, ""), ("span of a shear loss", loss.span, "m")]);
            if !loss.at.is_finite() {
                return Err(ModelError::NotFinite { what: "place of a shear loss", value: loss.at });
            }
        }
        if let Some(support) = self.support {
            sizes.push(("translation stiffness of a support", support.translation, "N/m"));
            sizes.push(("rotation stiffness of a support", support.rotation, "N m/rad"));
        }
        match sizes.into_iter().find(|(_, value, _)| !(value.is_finite() && *value > 0.0)) {
            Some((name, value, unit)) => Err(ModelError::Size { name, value, unit }),
            None => Ok(()),
        }
    }
}

/// Shear stiffness $k'G_{zx}A\,(1-\text{loss})$ for $|x - \text{at}| < \text{span}/2$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearLoss {
    /// Part of the shear stiffness that is lost \[1\], below 1.
    pub loss: f64,
    /// Length of the span \[m\].
    pub span: f64,
    /// Middle of the span \[m\].
    pub at: f64,
}

impl ShearLoss {
    /// The span's ends, as far as they lie on the beam.
    pub(crate) fn edges(&self, half_length: f64) -> [f64; 2] {
        [-0.5, 0.5].map(|side| (self.at + side * self.span).clamp(-half_length, half_length))
    }

    /// Whether a place lies in the span.
    pub(crate) fn holds(&self, x: f64, half_length: f64) -> bool {
        let [low, high] = self.edges(half_length);
        (low..high).contains(&x)
    }
}

/// Springs between a clamped end, or a plate's edge of its width's length, and the ground; infinite stiffness is the ideal clamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Against deflection \[N/m\].
    pub translation: f64,
    /// Against rotation $\psi$ \[N m/rad\].
    pub rotation: f64,
}
