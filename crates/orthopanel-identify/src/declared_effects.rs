//! The effects that a test file declares, as parts of every hypothesis.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::{Action, EffectSetting, ModelError, Piece, RecordSetting, Scale, effect};

use crate::IdentifyError;
use crate::hypothesis::Part;

/// What the file tells of each is held, the rest is free; `records` is how many the test has, none where lists alone stand in it.
///
/// # Errors
/// [`ModelError::UnknownEffect`] and [`ModelError::EffectParameter`], [`ModelError::EffectNeeds`] with what the test lacks for it, and
/// [`IdentifyError::Unsupported`] for what no file can declare.
pub(crate) fn declared_parts(test: &ImpactTest, piece: &Piece, records: usize) -> Result<Vec<Part>, IdentifyError> {
    let mut parts: Vec<Part> = Vec::new();
    for told in &test.effects {
        let effect = effect(&told.id)?;
        let refused = |why: &str| Err(IdentifyError::Unsupported(format!("effect {:?}: {why}", told.id)));
        let parameters = effect.parameters();
        if let Some(name) = told.parameters.keys().find(|name| parameters.iter().all(|known| known.name != *name)) {
            let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name).collect();
            return refused(&format!("no parameter {name:?}, it has {}", names.join(", ")));
        }
        let value = |name: &str| told.parameters.get(name).copied();
        for (parameter, value) in parameters.iter().filter_map(|known| Some((known, value(known.name)?))) {
            let (low, high) = parameter.range(piece);
            if !(low..=high).contains(&value) {
                let (effect, name, unit) = (effect.id(), parameter.name, parameter.unit);
                return Err(ModelError::EffectParameter { effect, name, value, unit, low, high }.into());
            }
            let is_in_test = value.round() >= 1.0 && value.round() <= records as f64;
            if parameter.scale == Scale::Index && records > 0 && !is_in_test {
                let name = parameter.name;
                return refused(&format!(
                    "{name} = {value}, and the test has {records} of them: give the number of one, from 1 to {records} in the \
                     order of the file's measurements"
                ));
            }
        }
        let values: Vec<Option<f64>> =
            parameters.iter().map(|parameter| value(parameter.name).or(parameter.held_at)).collect();
        let Some(part) = Part::declared(effect, &values, piece, records) else { continue };
        if !part.has_place() && parts.iter().any(|other| other.effect.id() == effect.id()) {
            return refused("declared twice, once is enough");
        }
        check(&part, &setting(test, piece))?;
        parts.push(part);
    }
    Ok(parts)
}

/// The setting of the first record.
fn setting(test: &ImpactTest, piece: &Piece) -> EffectSetting {
    let record = test.measurements.iter().find_map(|measurement| match &measurement.data {
        MeasurementData::TimeHistory(record) | MeasurementData::Accelerance(record) => Some(record),
        MeasurementData::NaturalFrequencies(_) => None,
    });
    let record = RecordSetting {
        number: 1,
        force_at: record.map(|record| record.force_at),
        response_at: record.map(|record| record.response_at),
        ..RecordSetting::default()
    };
    EffectSetting { piece: *piece, boundary: test.boundary, suspension: test.suspension.clone(), record }
}

/// Whether an effect can act in this test at all, as where its clamp is: a search would pass over starts that fail.
fn check(part: &Part, setting: &EffectSetting) -> Result<(), IdentifyError> {
    let values = part.values(&vec![0.0; part.free()]);
    // With a value in each record these are no values of one.
    if values.len() != part.effect.parameters().len() {
        return Ok(());
    }
    let acts = part.effect.act(&values, setting)?;
    if acts.iter().any(|action| matches!(action, Action::Plate(_))) {
        let why = "the plate in place of the beam is no effect to declare: say structure = \"mindlin-plate\"";
        return Err(IdentifyError::Unsupported(format!("effect {:?}: {why}", part.effect.id())));
    }
    Ok(())
}
