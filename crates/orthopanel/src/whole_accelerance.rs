//! The accelerance that all modes of a model make together, those that a sum leaves out included.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{ModalModel, ModeRange, ModelError, PanelModel, Place, RelaxingLines};

/// Modes summed one by one unless said; the rest, taken at rest, errs by the fourth power of a line over its modes.
const SUMMED: usize = 300;
/// Least ratio of the highest summed natural frequency to the highest line.
const MARGIN: f64 = 20.0;

/// The modes up to `highest` \[Hz\] as seen from two places; those that can be resolved, where they do not reach so far.
pub fn modes_up_to(model: &PanelModel, highest: f64, force: Place, response: Place) -> Result<ModalModel, ModelError> {
    let of = |range| model.modal_model(range, &[force], &[response]);
    match of(ModeRange::UpTo(highest)) {
        Err(ModelError::BeyondBasis { available, .. }) => of(ModeRange::Count(available)),
        modes => modes,
    }
}

/// Modes of a panel with a viscoelastic core below this many times the highest line, and some, stand by themselves; what
/// the others do, shapes of their own for force and response hold.
const RELAXING_MARGIN: f64 = 3.0;
const RELAXING_SPARE: f64 = 2000.0; // Hz

/// The accelerance of a model from one place to another.
pub enum WholeAccelerance {
    /// By a sum over modes.
    Modes {
        modes: ModalModel,
        /// Flexibility of the modes beyond `modes` \[m/N\].
        beyond: f64,
    },
    /// Line by line with the modulus of a viscoelastic core.
    Relaxing(Box<RelaxingLines>),
}

impl WholeAccelerance {
    /// With modes enough for lines up to `highest` \[Hz\]; those that can be resolved, and
    /// [`ModelError::BeyondBasis`] where they end below.
    pub fn up_to(model: &PanelModel, highest: f64, force: Place, response: Place) -> Result<Self, ModelError> {
        let margin = ModeRange::UpTo(RELAXING_MARGIN * highest + RELAXING_SPARE);
        let relaxing = match model.relaxing_lines(margin, &[force], &[response]) {
            Err(ModelError::BasisTooSmall { available, .. }) => {
                model.relaxing_lines(ModeRange::Count(available), &[force], &[response])
            }
            lines => lines,
        };
        if let Some(lines) = relaxing? {
            return Ok(Self::Relaxing(Box::new(lines)));
        }
        let usual = match Self::of(model, ModeRange::Count(SUMMED), force, response) {
            Err(ModelError::BasisTooSmall { available, .. }) => {
                let all = Self::of(model, ModeRange::Count(available), force, response)?;
                let reached = all.natural_frequencies().last().unwrap_or(0.0);
                let beyond = ModelError::BeyondBasis { frequency: highest, available, reached };
                return if reached < highest { Err(beyond) } else { Ok(all) };
            }
            usual => usual?,
        };
        if model.structure.has_modes_across()
            || usual.natural_frequencies().last().is_some_and(|last| last >= MARGIN * highest)
        {
            return Ok(usual);
        }
        match Self::of(model, ModeRange::UpTo(MARGIN * highest), force, response) {
            // Fewer than the margin asks for, and enough for the lines.
            Err(ModelError::BeyondBasis { available, reached, .. }) if reached >= highest => {
                Self::of(model, ModeRange::Count(available), force, response)
            }
            Err(ModelError::BeyondBasis { available, reached, .. }) => {
                Err(ModelError::BeyondBasis { frequency: highest, available, reached })
            }
            whole => whole,
        }
    }

    /// With the modes of `range`, and the static part of all others where it is known.
    pub fn of(model: &PanelModel, range: ModeRange, force: Place, response: Place) -> Result<Self, ModelError> {
        if let Some(lines) = model.relaxing_lines(range, &[force], &[response])? {
            return Ok(Self::Relaxing(Box::new(lines)));
        }
        let modes = model.modal_model(range, &[force], &[response])?;
        let beyond = model.static_remainder(&modes, &[force], &[response])?[0][0];
        Ok(Self::Modes { modes, beyond })
    }

    /// Real and imaginary part \[(m/s²)/N\] at `frequency` \[Hz\].
    pub fn at(&self, frequency: f64) -> (f64, f64) {
        match self {
            Self::Modes { modes, beyond } => {
                let value = modes.accelerance(0, 0, frequency);
                (value.re - (TAU * frequency).powi(2) * beyond, value.im)
            }
            Self::Relaxing(lines) => {
                let value = lines.at(Complex64::new(0.0, TAU * frequency))[0][0];
                (value.re, value.im)
            }
        }
    }

    /// Natural frequencies of the flexible modes that are summed \[Hz\], in rising order; none where no sum of modes is made.
    pub fn natural_frequencies(&self) -> impl Iterator<Item = f64> {
        let modes = match self {
            Self::Modes { modes, .. } => modes.modes(),
            Self::Relaxing(_) => &[],
        };
        modes.iter().map(|mode| mode.angular_frequency / TAU).filter(|&frequency| frequency > 0.0)
    }
}
