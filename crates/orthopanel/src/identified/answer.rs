//! What an identification found, as JSON (`orthopanel.identified/1`).

use std::collections::BTreeMap;

use orthopanel_identify::{
    HiddenMode, Identification, IdentifiedConstant, ModeFit, NotIdentified, PieceFit, TracedEffect, TracedParameter,
};
use orthopanel_model::StructureKind;
use serde::Serialize;

use super::measured::MeasuredTable;

/// `identify --json`.
#[derive(Serialize)]
pub struct Answer {
    schema: &'static str,
    structure: StructureKind,
    constants: BTreeMap<&'static str, ConstantEntry>,
    /// Constants that a piece has of its own, by the piece's name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    own_constants: BTreeMap<String, BTreeMap<&'static str, ConstantEntry>>,
    /// Constants that the data do not show, the least seen first.
    not_identified: Vec<NotIdentifiedEntry>,
    correlations: Vec<CorrelationEntry>,
    /// Effects that the test file declares, with what was identified of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<EffectEntry>,
    modes: Vec<ModeEntry>,
    /// Modes in the band of the records of which no resonance stands out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    modes_without_resonance: Vec<HiddenEntry>,
    /// Modes of a joint fit of a piece's records, before any model.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) measured_modes: Vec<MeasuredTable>,
    error: ErrorEntry,
    /// What was left out, cut or found wanting.
    notes: Vec<String>,
}

#[derive(Serialize)]
struct ConstantEntry {
    value: f64,
    /// `null` where the constant was held, or where the data cannot tell.
    std: Option<f64>,
    unit: &'static str,
    held: bool,
}

#[derive(Serialize)]
struct NotIdentifiedEntry {
    name: &'static str,
    held_at: f64,
    unit: &'static str,
    /// What the data leave open: the 95 % interval, cut at the bounds.
    interval: [f64; 2],
    /// Where the constants go when this one moves and the others make up for it, such as `ln g_yz +0.98, nu_xy -0.17`.
    direction: String,
}

#[derive(Serialize)]
struct CorrelationEntry {
    first: &'static str,
    /// Name of the piece that has it of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    first_piece: Option<String>,
    second: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    second_piece: Option<String>,
    value: f64,
}

#[derive(Serialize)]
struct EffectEntry {
    id: &'static str,
    owner: &'static str,
    /// One value a parameter; one a record where each has its own.
    parameters: BTreeMap<&'static str, Vec<ParameterEntry>>,
}

#[derive(Serialize)]
struct ParameterEntry {
    value: f64,
    /// `null` where the test file or the catalogue holds it.
    std: Option<f64>,
    unit: &'static str,
}

#[derive(Serialize)]
struct ModeEntry {
    piece: String,
    mode: usize,
    /// Nodal lines crossed along x and along y.
    nodes: [usize; 2],
    measured_hz: f64,
    /// `null` where neither records nor bins tell it.
    measured_std_hz: Option<f64>,
    model_hz: f64,
    error_percent: f64,
    zeta: Option<f64>,
    zeta_std: Option<f64>,
}

#[derive(Serialize)]
struct HiddenEntry {
    piece: String,
    mode: usize,
    /// Nodal lines crossed along x and along y.
    nodes: [usize; 2],
    model_hz: f64,
    /// `null` where no line tells it either; the model file then has a usual one.
    zeta: Option<f64>,
    zeta_std: Option<f64>,
}

#[derive(Serialize)]
struct ErrorEntry {
    frequency_rms_percent: f64,
    left_one_out_percent: Option<f64>,
    /// `null` where no accelerance was measured.
    accelerance_rms_percent: Option<f64>,
    /// Misfit per datum over the records' noise; `null` where these do not tell it.
    chi_square: Option<f64>,
}

fn effect(found: &TracedEffect) -> EffectEntry {
    let values = |parameter: &TracedParameter| {
        let unit = parameter.unit;
        parameter.values.iter().map(|one| ParameterEntry { value: one.value, std: one.std, unit }).collect()
    };
    let parameters = found.parameters.iter().map(|parameter| (parameter.name, values(parameter)));
    EffectEntry { id: found.id, owner: found.owner.name(), parameters: parameters.collect() }
}

/// The name of the piece that has a constant of its own.
pub(super) fn piece_name(found: &Identification, piece: Option<usize>) -> Option<&str> {
    Some(found.pieces.get(piece?)?.name.as_str())
}

/// A constant as people call it: `g_zx`, or `g_zx of NAME` where piece NAME has it of its own.
pub fn called(found: &Identification, name: &str, piece: Option<usize>) -> String {
    piece_name(found, piece).map_or(name.to_owned(), |piece| format!("{name} of {piece}"))
}

impl Answer {
    pub(super) fn of(found: &Identification, measured_modes: Vec<MeasuredTable>) -> Self {
        let constant = |constant: &IdentifiedConstant| {
            let &IdentifiedConstant { name, unit, value, std, held, .. } = constant;
            (name, ConstantEntry { value, std, unit, held })
        };
        let mut own_constants: BTreeMap<String, BTreeMap<&'static str, ConstantEntry>> = BTreeMap::new();
        for own in &found.constants {
            if let Some(piece) = &own.piece {
                own_constants.entry(piece.clone()).or_default().extend([constant(own)]);
            }
        }
        let unseen = |unseen: &NotIdentified| NotIdentifiedEntry {
            name: unseen.name,
            held_at: unseen.held_at,
            unit: unseen.unit,
            interval: unseen.interval,
            direction: unseen.direction_text(),
        };
        let mode = |fit: &PieceFit, mode: &ModeFit| ModeEntry {
            piece: fit.name.clone(),
            mode: mode.mode,
            nodes: mode.nodes,
            measured_hz: mode.measured,
            measured_std_hz: mode.measured_std,
            model_hz: mode.model,
            error_percent: mode.error_percent(),
            zeta: mode.damping.map(|ratio| ratio.value),
            zeta_std: mode.damping.and_then(|ratio| ratio.std),
        };
        let hidden = |fit: &PieceFit, mode: &HiddenMode| HiddenEntry {
            piece: fit.name.clone(),
            mode: mode.mode,
            nodes: mode.nodes,
            model_hz: mode.model,
            zeta: mode.damping.map(|ratio| ratio.value),
            zeta_std: mode.damping.and_then(|ratio| ratio.std),
        };
        let correlations = found.correlations.iter();
        Self {
            schema: "orthopanel.identified/1",
            structure: found.structure,
            constants: found.constants.iter().filter(|shared| shared.piece.is_none()).map(constant).collect(),
            own_constants,
            not_identified: found.not_identified.iter().map(unseen).collect(),
            correlations: correlations
                .map(|pair| CorrelationEntry {
                    first: pair.first,
                    first_piece: piece_name(found, pair.first_piece).map(str::to_owned),
                    second: pair.second,
                    second_piece: piece_name(found, pair.second_piece).map(str::to_owned),
                    value: pair.value,
                })
                .collect(),
            effects: found.effects.iter().map(effect).collect(),
            modes: found.pieces.iter().flat_map(|fit| fit.modes.iter().map(move |of| mode(fit, of))).collect(),
            modes_without_resonance: found
                .pieces
                .iter()
                .flat_map(|fit| fit.hidden.iter().map(move |of| hidden(fit, of)))
                .collect(),
            measured_modes,
            error: ErrorEntry {
                frequency_rms_percent: found.frequency_rms_percent,
                left_one_out_percent: found.left_one_out_percent,
                accelerance_rms_percent: found.accelerance_rms_percent,
                chi_square: found.chi_square,
            },
            notes: found.notes.clone(),
        }
    }
}
