//! The paper's section 3.5 on measured hits: finite elements, modal damping, Runge-Kutta.

use orthopanel_data::TimeHistory;
use orthopanel_identify::{ForceBetweenSamples, HistorySettings, IdentifyError, Stepping, compare_time_history};
use orthopanel_model::{BeamElements, ModalModel, ModelError, PanelModel, Place, Ports, StructureKind};
use serde::Serialize;

use crate::measured_pairs::{ComparedPair, place_text};

/// Greatest $\omega h$ of a step unless said: a mode's frequency is then off by $0.2^4/120$, 1.3e-5, at most, and by the
/// fourth power less for lower ones.
const ANGLE_OF_STEP: f64 = 0.2;

/// Elements a flexible mode, and at least: frequencies err by the fourth power of their length.
const ELEMENTS_OF_MODE: usize = 4;
const LEAST_ELEMENTS: usize = 32;

/// Greatest difference from the exact stepper on the same elements, over the peak, that counts as agreement.
const CONVERGED: f64 = 1e-8;
/// The error of a step falls with this power of its size.
const ORDER: f64 = 4.0;

/// What was integrated between a pair of places, and in which steps.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Integration {
    force: Place,
    response: Place,
    /// Beam elements along the piece.
    elements: usize,
    /// Steps of Runge-Kutta from one sample to the next.
    steps: usize,
    /// Steps asked for, where these could not be taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    steps_asked: Option<usize>,
    /// Greatest difference from the exact stepper on the same elements, over the measured peak, of all hits.
    step_error_of_peak: f64,
    /// Steps at which that difference is 1e-8, by the method's fourth order.
    steps_to_1e_8: usize,
}

impl Integration {
    /// What was done, and how far the steps are from none.
    pub fn said(&self) -> String {
        let Self { force, response, elements, steps, steps_asked, step_error_of_peak, steps_to_1e_8 } = self;
        let asked = steps_asked.map_or(String::new(), |asked| {
            format!(" ({asked} asked: a band-limited force takes a multiple of its straight lines between samples)")
        });
        let onwards = if *step_error_of_peak > CONVERGED {
            format!("; --steps {steps_to_1e_8} brings 1e-8")
        } else {
            String::new()
        };
        format!(
            "{} to {}: {elements} beam elements, {steps} steps{asked} of Runge-Kutta from one sample to the next; they err by \
             {step_error_of_peak:.1e} of the peak, beside the exact stepper on the same elements{onwards}",
            place_text(*force),
            place_text(*response)
        )
    }
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
    let count = exact.flexible().count();
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
    // A band-limited force runs in straight lines between finer instants, each of which takes a whole number of steps.
    let (_, finer) = between_samples.straight_lines(&[0.0; 2]);
    let asked = steps;
    let whole = |steps: usize| steps.div_ceil(finer) * finer;
    let steps = whole(asked.unwrap_or(needed));
    let steps_asked = asked.filter(|asked| *asked != steps);
    let stepped = |stepping: Stepping| {
        let static_flexibility = exact.static_flexibility;
        let settings =
            HistorySettings { between_samples, stepping, static_flexibility: Some(static_flexibility), band: None };
        let hits = compare_time_history(&modes, history, &settings)?;
        Ok::<_, IdentifyError>(ComparedPair {
            history: history.clone(),
            verdicts: exact.verdicts.clone(),
            hits,
            modes: modes.clone(),
            static_flexibility,
        })
    };
    let pair = stepped(Stepping::RungeKutta { steps })?;
    let of_steps = apart(&pair, &stepped(Stepping::Exact)?);
    let step_error_of_peak = of_steps.into_iter().fold(0.0, f64::max) / 100.0;
    let growth = (step_error_of_peak / CONVERGED).powf(1.0 / ORDER).max(1.0);
    let steps_to_1e_8 = whole((steps as f64 * growth * SURELY).ceil() as usize);
    let (force, response) = (history.force_at, history.response_at);
    Ok((pair, Integration { force, response, elements, steps, steps_asked, step_error_of_peak, steps_to_1e_8 }))
}

/// Beyond what the order says, since the fourth power holds for short steps only.
const SURELY: f64 = 1.05;

/// Greatest difference of two calculated accelerations over the measured peak, hit by hit \[%\].
pub fn apart(one: &ComparedPair, other: &ComparedPair) -> Vec<f64> {
    let hits = one.hits.iter().zip(&other.hits);
    hits.map(|(one, other)| {
        let pairs = one.whole.calculated.iter().zip(&other.whole.calculated);
        100.0 * pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / other.whole.misfit.peak
    })
    .collect()
}
