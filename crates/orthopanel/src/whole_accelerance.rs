//! The accelerance that all modes of a model make together, those that a sum leaves out included.

use std::f64::consts::TAU;

use orthopanel_model::{ModalModel, Mode, ModeRange, ModelError, PanelModel, Place, StaticFlexibility, StructureKind};

/// Modes summed one by one unless said; the rest, taken at rest, errs by the fourth power of a line over its modes.
const SUMMED: usize = 300;
/// Least ratio of the highest summed natural frequency to the highest line.
const MARGIN: f64 = 20.0;

/// $\sum_m W_m(l_1)W_m(l_x)/\omega_m^2$ over all flexible modes \[m/N\], where a closed form of it is known: for a beam.
pub fn static_flexibility(model: &PanelModel, force: Place, response: Place) -> Result<Option<f64>, ModelError> {
    match model.structure {
        StructureKind::TimoshenkoBeam => {
            let all = StaticFlexibility::new(&model.piece, model.boundary)?;
            let (e_x, g_zx) = (model.constant("e_x")?, model.constant("g_zx")?);
            Ok(Some(all.between(force.x, response.x, e_x, g_zx).0))
        }
        StructureKind::MindlinPlate => Ok(None),
    }
}

/// The accelerance of a model from one place to another.
pub struct WholeAccelerance {
    modes: ModalModel,
    /// Flexibility of the modes beyond `modes` \[m/N\].
    beyond: f64,
}

impl WholeAccelerance {
    /// With modes enough for lines up to `highest` \[Hz\].
    pub fn up_to(model: &PanelModel, highest: f64, force: Place, response: Place) -> Result<Self, ModelError> {
        let usual = Self::of(model, ModeRange::Count(SUMMED), force, response)?;
        if usual.modes.modes().last().is_some_and(|mode| mode.angular_frequency >= MARGIN * TAU * highest) {
            return Ok(usual);
        }
        Self::of(model, ModeRange::UpTo(MARGIN * highest), force, response)
    }

    /// With the modes of `range`, and the static part of all others where it is known.
    pub fn of(model: &PanelModel, range: ModeRange, force: Place, response: Place) -> Result<Self, ModelError> {
        let modes = model.modal_model(range, &[force], &[response])?;
        let flexible = modes.modes().iter().filter(|mode| mode.angular_frequency > 0.0);
        let own =
            |mode: &Mode| Some(mode.at_forces.first()? * mode.at_responses.first()? / mode.angular_frequency.powi(2));
        let summed: f64 = flexible.filter_map(own).sum();
        let beyond = static_flexibility(model, force, response)?.map_or(0.0, |all| all - summed);
        Ok(Self { modes, beyond })
    }

    /// Real and imaginary part \[(m/s²)/N\] at `frequency` \[Hz\].
    pub fn at(&self, frequency: f64) -> (f64, f64) {
        let value = self.modes.accelerance(0, 0, frequency);
        (value.re - (TAU * frequency).powi(2) * self.beyond, value.im)
    }

    /// Natural frequencies of the flexible modes that are summed \[Hz\], in rising order.
    pub fn natural_frequencies(&self) -> impl Iterator<Item = f64> {
        self.modes.modes().iter().map(|mode| mode.angular_frequency / TAU).filter(|&frequency| frequency > 0.0)
    }
}
