//! Natural frequencies that a hypothesis foretells for a further measurement.

use orthopanel_model::{EffectSetting, EffectState, ModelError, Place, effect, natural_frequencies};

use super::hypothesis::Hypothesis;

/// A sensor elsewhere, or with a mass beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Further {
    pub sensor: Option<Place>,
    /// \[kg\].
    pub added: f64,
}

/// The first `count` natural frequencies \[Hz\] at constants `values`.
///
/// # Errors
/// What the model refuses.
pub(super) fn further_frequencies(
    setting: &EffectSetting,
    hypothesis: &Hypothesis,
    values: &[f64],
    further: Further,
    count: usize,
) -> Result<Vec<f64>, ModelError> {
    let mut setting = setting.clone();
    setting.record.response_at = further.sensor;
    let mut hypothesis = hypothesis.clone();
    let carried = hypothesis.effects.iter_mut().find(|on| on.effect.id() == "sensor-mass");
    let is_carried = carried.is_some();
    if let Some(mass) = carried.and_then(|on| on.values.first_mut()) {
        *mass += further.added;
    }
    let mut states = hypothesis.states()?;
    if further.added > 0.0 && !is_carried {
        states.push(EffectState::new(effect("sensor-mass")?, vec![further.added, 0.0], 1)?);
    }
    natural_frequencies(&setting, values, &states, count)
}
