//! A trace as `orthopanel.trace/2`.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use crate::outcome::Tracing;
use crate::traced_effect::{TracedEffect, TracedParameter};

/// The name of the format.
pub const TRACE_SCHEMA: &str = "orthopanel.trace/2";

#[derive(Serialize)]
struct Rows<'a> {
    schema: &'static str,
    verdict: &'static str,
    effects: Vec<EffectRow<'a>>,
    alternatives: &'a [String],
    error: ErrorRow<'a>,
    chi_square: f64,
    model_error: Option<ModelErrorRow>,
    candidates: Vec<CandidateRow<'a>>,
    not_tested: Vec<NotTestedRow<'a>>,
    /// `null` where no disbond is looked for, and where one was found.
    detectable: Option<DetectableRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shared_model_error: Option<SharedErrorRow>,
    removed: Vec<RemovedRow<'a>>,
    next_experiment: &'a str,
    notes: &'a [String],
}

#[derive(Serialize)]
struct EffectRow<'a> {
    id: &'a str,
    owner: &'static str,
    parameters: BTreeMap<&'a str, ParameterRow>,
}

/// One value, or a list where each record has its own.
#[derive(Serialize)]
struct ParameterRow {
    value: OneOrEach,
    std: OneOrEach,
    unit: &'static str,
}

#[derive(Serialize)]
#[serde(untagged)]
enum OneOrEach {
    One(Option<f64>),
    Each(Vec<Option<f64>>),
}

#[derive(Serialize)]
struct ErrorRow<'a> {
    measure: &'a str,
    before: PairRow,
    after: PairRow,
    noise_floor: f64,
}

#[derive(Serialize)]
struct ModelErrorRow {
    frequency: f64,
    /// Only where records were traced.
    #[serde(skip_serializing_if = "Option::is_none")]
    residue: Option<f64>,
}

#[derive(Serialize)]
struct PairRow {
    fitted: f64,
    held_out: f64,
}

/// Sides \[m\], `null` where no disbond of the largest side shows.
#[derive(Serialize)]
struct DetectableRow {
    effect: &'static str,
    loss: f64,
    at_half_of_the_places: Option<f64>,
    anywhere: Option<f64>,
    places: usize,
    largest: f64,
}

#[derive(Serialize)]
struct SharedErrorRow {
    modes: usize,
    reference: f64,
    suspect: f64,
    suspect_less_reference: f64,
}

#[derive(Serialize)]
struct CandidateRow<'a> {
    id: &'a str,
    log_evidence: f64,
    held_out: f64,
    parameters: BTreeMap<String, ParameterRow>,
}

#[derive(Serialize)]
struct NotTestedRow<'a> {
    id: &'a str,
    reason: &'a str,
}

#[derive(Serialize)]
struct RemovedRow<'a> {
    id: &'a str,
    owner: &'static str,
    why: &'a str,
}

/// Writes the object that `orthopanel trace --json` prints.
///
/// A parameter that each record has of its own is a list in the order of the records. A candidate of several effects
/// names its parameters `id.name`.
impl Serialize for Tracing {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let error = &self.error;
        let rows = Rows {
            schema: TRACE_SCHEMA,
            verdict: self.verdict.name(),
            effects: self.effects.iter().map(effect).collect(),
            alternatives: &self.alternatives,
            error: ErrorRow {
                measure: &error.measure,
                before: PairRow { fitted: error.before.fitted, held_out: error.before.held_out },
                after: PairRow { fitted: error.after.fitted, held_out: error.after.held_out },
                noise_floor: error.noise_floor,
            },
            chi_square: self.chi_square,
            model_error: self.model_error.map(|of| ModelErrorRow { frequency: of.frequency, residue: of.residue }),
            candidates: self
                .candidates
                .iter()
                .map(|candidate| CandidateRow {
                    id: &candidate.id,
                    log_evidence: candidate.log_evidence,
                    held_out: candidate.held_out,
                    parameters: of_candidate(&candidate.effects),
                })
                .collect(),
            not_tested: self.not_tested.iter().map(|row| NotTestedRow { id: row.id, reason: &row.reason }).collect(),
            detectable: self.detectable.map(|of| DetectableRow {
                effect: of.effect,
                loss: of.loss,
                at_half_of_the_places: of.at_half_of_the_places,
                anywhere: of.anywhere,
                places: of.places,
                largest: of.most,
            }),
            shared_model_error: self.shared_model_error.map(|of| SharedErrorRow {
                modes: of.modes,
                reference: of.reference,
                suspect: of.suspect,
                suspect_less_reference: of.suspect_less_reference,
            }),
            removed: self
                .removed
                .iter()
                .map(|row| RemovedRow { id: row.id, owner: row.owner.name(), why: &row.why })
                .collect(),
            next_experiment: &self.next_experiment,
            notes: &self.notes,
        };
        rows.serialize(serializer)
    }
}

fn effect(effect: &TracedEffect) -> EffectRow<'_> {
    let parameters = effect.parameters.iter().map(|found| (found.name, parameter(found))).collect();
    EffectRow { id: effect.id, owner: effect.owner.name(), parameters }
}

fn of_candidate(effects: &[TracedEffect]) -> BTreeMap<String, ParameterRow> {
    let name = |id: &str, name: &str| if effects.len() > 1 { format!("{id}.{name}") } else { name.to_owned() };
    let all = effects.iter().flat_map(|effect| effect.parameters.iter().map(move |found| (effect.id, found)));
    all.map(|(id, found)| (name(id, found.name), parameter(found))).collect()
}

fn parameter(found: &TracedParameter) -> ParameterRow {
    let (value, std) = match &found.values[..] {
        [one] => (OneOrEach::One(Some(one.value)), OneOrEach::One(one.std)),
        several => (
            OneOrEach::Each(several.iter().map(|one| Some(one.value)).collect()),
            OneOrEach::Each(several.iter().map(|one| one.std).collect()),
        ),
    };
    ParameterRow { value, std, unit: found.unit }
}
