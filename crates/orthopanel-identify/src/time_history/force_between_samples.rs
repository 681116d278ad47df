//! How a force that is known at its samples runs between them.

use orthopanel_data::Transforms;
use orthopanel_model::{ForceRecord, ModalModel, ModelError};

use super::spectrum;

/// Steps from one sample to the next under a band-limited force: what straight lines between them add above half the
/// rate is below $1/31^2$, a thousandth of the line it mirrors.
const FINER: usize = 16;

/// How the force runs between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ForceBetweenSamples {
    /// As the smooth function without content above half the sampling rate that passes through them. This is what a
    /// record taken through an anti-alias filter holds; response and force then lack nothing of each other.
    #[default]
    BandLimited,
    /// In straight lines, as the paper interpolates and as a simulator feeds an FMU. The force loses the part
    /// $1 - \mathrm{sinc}^2(f/f_s)$: 5 % at an eighth of the sampling rate $f_s$, 19 % at a quarter.
    Linear,
}

/// How the modes are carried from sample to sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stepping {
    /// Exactly: [`ModalStepper`](orthopanel_model::ModalStepper).
    #[default]
    Exact,
    /// By the classic Runge-Kutta method of section 3.5, the witness beside it:
    /// [`ModalModel::acceleration_by_runge_kutta`].
    RungeKutta {
        /// Equal steps from one sample to the next.
        steps: usize,
    },
}

impl ForceBetweenSamples {
    /// Forces \[N\] at finer instants such that straight lines between them drive a model as this force does, and the
    /// number of such steps from one sample to the next.
    ///
    /// The samples are even in time. Band-limited, the record is taken to repeat, so it should end as it begins; and the
    /// new values at the samples are not the old ones, since what straight lines lose is made up for.
    pub fn straight_lines(self, force: &[f64]) -> (Vec<f64>, usize) {
        if force.is_empty() { (Vec::new(), 1) } else { self.lines(force.to_vec(), &mut Transforms::default()) }
    }

    fn lines(self, force: Vec<f64>, transforms: &mut Transforms) -> (Vec<f64>, usize) {
        match self {
            Self::BandLimited => (spectrum::finer(transforms, &force, FINER), FINER),
            Self::Linear => (force, 1),
        }
    }

    /// Acceleration \[m/s²\] at the model's first response port at the instants of the samples; at rest before.
    pub(super) fn acceleration(
        self,
        model: &ModalModel,
        force: Vec<f64>,
        rate: f64,
        stepping: Stepping,
        transforms: &mut Transforms,
    ) -> Result<Vec<f64>, ModelError> {
        let (force, finer) = self.lines(force, transforms);
        let record = ForceRecord::new(1.0 / (rate * finer as f64), vec![force])?;
        let all = match stepping {
            Stepping::Exact => model.acceleration_under(&record)?,
            Stepping::RungeKutta { steps } => model.acceleration_by_runge_kutta(&record, steps.div_ceil(finer))?,
        };
        let first = all.into_iter().next().unwrap_or_default();
        Ok(first.into_iter().step_by(finer).collect())
    }
}
