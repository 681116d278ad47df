//! The paper's section 3.5 on measured hits: finite elements, modal damping, Runge-Kutta.

use orthopanel_data::TimeHistory;
use orthopanel_identify::{ForceBetweenSamples, HistorySettings, IdentifyError, Stepping, compare_time_history};
use orthopanel_model::{BeamElements, ModalModel, ModelError, PanelModel, Ports, StructureKind};
use serde::Serialize;

use crate::measured_pairs::ComparedPair;

/// Greatest $\omega h$ of a step unless said: a mode's frequency is then off by $0.2^4/120$, 1.3e-5, at most, and by the
/// fourth power less for lower ones.
const ANGLE_OF_STEP: f64 = 0.2;

/// Elements a flexible mode, and at least: frequencies err by the fourth power of their length.
const ELEMENTS_OF_MODE: usize = 4;
const LEAST_ELEMENTS: usize = 32;

/// What was integrated, and in which steps.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Integration {
    /// Beam elements along the piece.
    pub elements: usize,
    /// Steps of Runge-Kutta from one sample to the next.
    pub steps: usize,
}

/// Whether its finite elements can be made of a model: those of a beam, without effects.
pub fn takes(model: &PanelModel) -> bool {
    model.structure == StructureKind::TimoshenkoBeam && model.effects.is_empty()
}

/// Equations 26 to 28 for a pair of places: the modes of beam elements, as many as `exact` has.
fn of_elements(
    model: &PanelModel,
    history: &TimeHistory,
    exact: &ModalModel,
) -> Result<(ModalModel, usize), ModelError> {
    let count = exact.modes().iter().filter(|mode| mode.angular_frequency > 0.0).count();
    let elements = (ELEMENTS_OF_MODE * count).max(LEAST_ELEMENTS);
    let structure = BeamElements::new(&model.piece, model.boundary, elements)?;
    let values = [model.constant("e_x")?, model.constant("g_zx")?];
    let ports = Ports { forces: vec![history.force_at], responses: vec![history.response_at] };
    Ok((ModalModel::of_structure(&structure, &values, count, &model.damping, &ports)?, elements))
}

/// Drives the finite elements of `model`, which [`takes`] must allow, with every hit that `exact` was driven with, in `steps` from sample to sample, or as
/// many as the highest mode needs.
///
/// # Errors
/// As [`compare_time_history`], such as for too few steps.
pub fn by_runge_kutta(
    model: &PanelModel,
    exact: &ComparedPair,
    between_samples: ForceBetweenSamples,
    steps: Option<usize>,
) -> Result<(ComparedPair, Integration), IdentifyError> {
    let history = &exact.history;
    let (modes, elements) = of_elements(model, history, &exact.modes)?;
    let highest = modes.modes().iter().map(|mode| mode.angular_frequency).fold(0.0, f64::max);
    let needed = (highest / (history.rate * ANGLE_OF_STEP)).ceil().max(1.0) as usize;
    let steps = steps.unwrap_or(needed);
    let settings = HistorySettings {
        between_samples,
        stepping: Stepping::RungeKutta { steps },
        static_flexibility: exact.static_flexibility,
        band: None,
    };
    let hits = compare_time_history(&modes, history, &settings)?;
    let pair = ComparedPair { history: history.clone(), hits, modes, static_flexibility: exact.static_flexibility };
    Ok((pair, Integration { elements, steps }))
}

/// Greatest difference of two calculated accelerations over the measured peak, hit by hit \[%\].
pub fn apart(one: &ComparedPair, other: &ComparedPair) -> Vec<f64> {
    let hits = one.hits.iter().zip(&other.hits);
    hits.map(|(one, other)| {
        let pairs = one.whole.calculated.iter().zip(&other.whole.calculated);
        100.0 * pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / other.whole.misfit.peak
    })
    .collect()
}
