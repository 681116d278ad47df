//! The effects that a test file declares.

use orthopanel_data::{ImpactTest, Measurement, MeasurementData};
use orthopanel_model::{
    Action, Effect, EffectSetting, ModelError, Piece, Place, RecordSetting, Scale, StructureKind, effect,
};

use crate::IdentifyError;
use crate::effect_places::has_place;
use crate::hypothesis::Part;
use crate::structures;

/// An effect with the values that the file tells, one a parameter.
pub(crate) struct Declared {
    pub effect: &'static dyn Effect,
    pub values: Vec<Option<f64>>,
}

/// Every effect of the file, its names and numbers checked; `records` is how many the test has.
///
/// # Errors
/// [`ModelError::UnknownEffect`] for an id that the catalogue does not have, [`ModelError::EffectParameter`] for a number that may not be, and
/// [`IdentifyError::Unsupported`] for what no file can declare.
pub(crate) fn declared(test: &ImpactTest, piece: &Piece, records: usize) -> Result<Vec<Declared>, IdentifyError> {
    // A list of frequencies has no records that could differ.
    let is_list = |measurement: &Measurement| matches!(measurement.data, MeasurementData::NaturalFrequencies(_));
    let lists = test.measurements.iter().all(is_list);
    let setting = first_setting(test, piece);
    let mut all: Vec<Declared> = Vec::new();
    for told in &test.effects {
        let effect = effect(&told.id)?;
        let refused = |why: &str| Err(IdentifyError::Unsupported(format!("effect {:?}: {why}", told.id)));
        if !has_place(effect) && all.iter().any(|other| other.effect.id() == effect.id()) {
            return refused("declared twice, once is enough");
        }
        if replaces_structure(effect, piece, &setting) {
            return refused(
                "the plate in place of the beam is no effect to declare: say structure = \"mindlin-plate\"",
            );
        }
        let parameters = effect.parameters();
        if let Some(name) = told.parameters.keys().find(|name| parameters.iter().all(|known| known.name != *name)) {
            let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name).collect();
            return refused(&format!("no parameter {name:?}, it has {}", names.join(", ")));
        }
        let values: Vec<Option<f64>> =
            parameters.iter().map(|parameter| told.parameters.get(parameter.name).copied()).collect();
        for (parameter, value) in parameters.iter().zip(&values).filter_map(|(known, value)| Some((known, (*value)?))) {
            let (low, high) = parameter.range(piece);
            if !(low..=high).contains(&value) {
                let (effect, name, unit) = (effect.id(), parameter.name, parameter.unit);
                return Err(ModelError::EffectParameter { effect, name, value, unit, low, high }.into());
            }
            if parameter.across && structures::of_test(test).kind() == StructureKind::TimoshenkoBeam && value != 0.0 {
                let name = parameter.name;
                return refused(&format!("{name} = {value}: a beam has its effects on its centre line, leave it out"));
            }
            let is_in_test = value.round() >= 1.0 && value.round() <= records as f64;
            if parameter.scale == Scale::Index && !lists && !is_in_test {
                let name = parameter.name;
                return refused(&format!(
                    "{name} = {value}, and the test has {records} of them: give the number of one, from 1 to {records} in the \
                     order of the file's measurements"
                ));
            }
        }
        all.push(Declared { effect, values });
    }
    Ok(all)
}

/// The same as parts of every hypothesis: what the file tells is held, the rest is free.
///
/// # Errors
/// As [`declared`], and [`ModelError::EffectNeeds`] with what the test lacks for one: a search would pass over starts that fail.
pub(crate) fn declared_parts(test: &ImpactTest, piece: &Piece, records: usize) -> Result<Vec<Part>, IdentifyError> {
    let structure = structures::of_test(test).kind();
    let setting = first_setting(test, piece);
    let mut parts = Vec::new();
    for Declared { effect, values } in declared(test, piece, records)? {
        let held: Vec<Option<f64>> = values
            .iter()
            .zip(effect.parameters())
            .map(|(value, of)| value.or(of.held_at.filter(|_| !of.across)))
            .collect();
        let Some(part) = Part::declared(effect, &held, (piece, structure), records) else { continue };
        let usual = part.values(&vec![0.0; part.free()]);
        // With a value in each record these are no values of one.
        if usual.len() == effect.parameters().len() {
            effect.act(&usual, &setting)?;
        }
        parts.push(part);
    }
    Ok(parts)
}

fn replaces_structure(effect: &dyn Effect, piece: &Piece, setting: &EffectSetting) -> bool {
    let first = |starts: Vec<f64>| starts.first().copied().unwrap_or_default();
    let usual: Vec<f64> = effect.parameters().iter().map(|parameter| first(parameter.starts(piece))).collect();
    effect.act(&usual, setting).is_ok_and(|acts| acts.iter().any(|action| matches!(action, Action::Plate(_))))
}

/// The setting of the first record.
pub(crate) fn first_setting(test: &ImpactTest, piece: &Piece) -> EffectSetting {
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

/// Records of a test: files of the same places are hits of one.
pub(crate) fn pairs_of_places(test: &ImpactTest) -> usize {
    let mut pairs: Vec<[Place; 2]> = Vec::new();
    for measurement in &test.measurements {
        if let MeasurementData::TimeHistory(record) | MeasurementData::Accelerance(record) = &measurement.data {
            let pair = [record.force_at, record.response_at];
            if !pairs.contains(&pair) {
                pairs.push(pair);
            }
        }
    }
    pairs.len()
}
