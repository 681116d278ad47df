//! What an identification found, as JSON (`orthopanel.identified/1`).

use std::collections::BTreeMap;

use orthopanel_identify::{Identification, IdentifiedConstant, ModeFit, PieceFit};
use orthopanel_model::StructureKind;
use serde::Serialize;

/// `identify --json`.
#[derive(Serialize)]
pub struct Answer {
    schema: &'static str,
    structure: StructureKind,
    constants: BTreeMap<&'static str, ConstantEntry>,
    correlations: Vec<CorrelationEntry>,
    modes: Vec<ModeEntry>,
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
struct CorrelationEntry {
    first: &'static str,
    second: &'static str,
    value: f64,
}

#[derive(Serialize)]
struct ModeEntry {
    piece: String,
    mode: usize,
    measured_hz: f64,
    model_hz: f64,
    error_percent: f64,
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

impl Answer {
    pub(super) fn of(found: &Identification) -> Self {
        let constant = |constant: &IdentifiedConstant| {
            let &IdentifiedConstant { name, unit, value, std, held } = constant;
            (name, ConstantEntry { value, std, unit, held })
        };
        let mode = |fit: &PieceFit, mode: &ModeFit| ModeEntry {
            piece: fit.name.clone(),
            mode: mode.mode,
            measured_hz: mode.measured,
            model_hz: mode.model,
            error_percent: mode.error_percent(),
            zeta: mode.damping.map(|ratio| ratio.value),
            zeta_std: mode.damping.and_then(|ratio| ratio.std),
        };
        let correlations = found.correlations.iter();
        Self {
            schema: "orthopanel.identified/1",
            structure: found.structure,
            constants: found.constants.iter().map(constant).collect(),
            correlations: correlations
                .map(|pair| CorrelationEntry { first: pair.first, second: pair.second, value: pair.value })
                .collect(),
            modes: found.pieces.iter().flat_map(|fit| fit.modes.iter().map(move |of| mode(fit, of))).collect(),
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
