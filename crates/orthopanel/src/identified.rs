//! What an identification found, as JSON (`orthopanel.identified/1`), as tables, and as one model a piece.

use std::collections::BTreeMap;
use std::path::Path;

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_identify::{DampingLaw, Identification, IdentifiedConstant, ModeFit, PieceFit, Settings, identify};
use orthopanel_model::{PanelModel, Piece, Place, Ports, StructureKind};
use serde::Serialize;

use crate::error::CommandError;
use crate::{notes, progress, tables};

/// Modal damping ratio assumed where a test measures none: typical of the paper's table 9.
const ASSUMED_DAMPING: f64 = 0.003;

/// A test, what was identified from it, and a model of each of its pieces.
pub struct Identified {
    pub test: ImpactTest,
    pub found: Identification,
    /// In the order of `found.pieces`.
    pub models: Vec<PanelModel>,
    /// The JSON object.
    pub answer: Answer,
}

impl Identified {
    /// Reads the test at `path` and identifies its panel; says on standard error what was noted and had to be assumed.
    pub fn from_test(path: &Path, settings: Settings) -> Result<Self, CommandError> {
        let test = ImpactTest::read(path)?;
        let found = {
            let _shown = progress::spinner("reading the records and identifying");
            identify(&test, settings).map_err(|source| CommandError::Identify { path: path.into(), source })?
        };
        notes::say("", &found.notes);
        let law = settings.damping_law;
        let models =
            found.pieces.iter().enumerate().map(|(index, fit)| model(&test, &found, index, fit, law)).collect();
        if found.pieces.iter().flat_map(|fit| &fit.modes).all(|mode| mode.damping.is_none()) {
            eprintln!(
                "damping: natural frequencies alone measure none; the model takes zeta = {ASSUMED_DAMPING} for every \
                 mode, an assumption (damping.beyond in the model file)"
            );
        }
        let answer = Answer::of(&found);
        Ok(Self { test, found, models, answer })
    }

    /// `-NAME` where there are several pieces, safe in file names; nothing for a single one.
    pub fn suffix(&self, piece: &PieceFit) -> String {
        if self.found.pieces.len() == 1 { String::new() } else { format!("-{}", file_name_part(&piece.name)) }
    }

    /// Measured against model, mode by mode, then the constants.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        for fit in self.found.pieces.iter().filter(|fit| !fit.modes.is_empty()) {
            let Piece { length, width, thickness, mass_per_area } = fit.piece;
            text += &format!("piece {}: {length} x {width} x {thickness} m, {mass_per_area:.4} kg/m2\n", fit.name);
            text += &(mode_table(fit) + "\n");
        }
        let row = |constant: &IdentifiedConstant| {
            let std = match constant.std {
                Some(std) => format!("{std:.1e}"),
                None if constant.held => "held".into(),
                None => "unknown".into(),
            };
            vec![constant.name.into(), format!("{:.3e}", constant.value), std, constant.unit.into()]
        };
        let rows: Vec<_> = self.found.constants.iter().map(row).collect();
        text += &tables::aligned(&["constant", "value", "std", "unit"], &rows);
        for pair in &self.found.correlations {
            text += &format!("correlation of {} and {}: {:+.3}\n", pair.first, pair.second, pair.value);
        }
        text += &format!("error of the frequencies: {:.3} % rms", self.found.frequency_rms_percent);
        if let Some(error) = self.found.left_one_out_percent {
            text += &format!("; of each predicted from the others: {error:.3} % rms");
        }
        text += "\n";
        if let Some(error) = self.found.accelerance_rms_percent {
            text += &format!("error of the accelerances: {error:.2} % rms");
            if let Some(chi_square) = self.found.chi_square {
                text += &format!("; chi-square per datum {chi_square:.2} (1: all that is left is noise)");
            }
            text += "\n";
        }
        text
    }
}

/// A row a mode; with the damping where the test measures it.
fn mode_table(fit: &PieceFit) -> String {
    let with_damping = fit.modes.iter().any(|mode| mode.damping.is_some());
    let row = |mode: &ModeFit| {
        let mut row = vec![
            mode.mode.to_string(),
            format!("{:.1}", mode.measured),
            format!("{:.1}", mode.model),
            format!("{:+.2}", mode.error_percent()),
        ];
        if with_damping {
            let std = mode.damping.and_then(|zeta| zeta.std);
            row.push(mode.damping.map_or("not seen".into(), |zeta| format!("{:.3e}", zeta.value)));
            row.push(std.map_or("unknown".into(), |std| format!("{std:.1e}")));
        }
        row
    };
    let heading = ["mode", "measured [Hz]", "model [Hz]", "error [%]", "zeta", "std"];
    let columns = if with_damping { heading.len() } else { heading.len() - 2 };
    tables::aligned(&heading[..columns], &fit.modes.iter().map(row).collect::<Vec<_>>())
}

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
    fn of(found: &Identification) -> Self {
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

fn model(
    test: &ImpactTest,
    found: &Identification,
    index: usize,
    fit: &PieceFit,
    damping_law: DampingLaw,
) -> PanelModel {
    let mut model = found.panel_model(fit, test.boundary, ports(test, index, &fit.piece));
    let (beyond, origin) = match usual_damping(fit) {
        None => (ASSUMED_DAMPING, "assumed, not measured".to_owned()),
        Some(usual) => (usual, "measured inside the band; beyond it assumed, the median of the measured".to_owned()),
    };
    model.damping.beyond = beyond;
    model.provenance.insert("damping".into(), origin.into());
    if damping_law == DampingLaw::Hysteretic && !model.damping.ratios.is_empty() {
        let text = "identified as hysteretic, loss factor 2 zeta; the model is viscous, which is the same at resonance";
        model.provenance.insert("damping_law".into(), text.into());
    }
    model.provenance.insert("piece".into(), fit.name.clone().into());
    model.provenance.insert("program".into(), concat!("orthopanel ", env!("CARGO_PKG_VERSION")).into());
    model
}

/// Median of the damping ratios that the piece's records show.
///
/// Ratios scatter by factors of five from mode to mode (the paper's table 9), and the median is not carried away by one
/// of them as the last one or the mean would be.
fn usual_damping(fit: &PieceFit) -> Option<f64> {
    let mut ratios: Vec<f64> = fit.modes.iter().filter_map(|mode| Some(mode.damping?.value)).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied()
}

/// The places of the piece's records; without records the paper's, -3/8 and 3/8 of the length.
fn ports(test: &ImpactTest, index: usize, piece: &Piece) -> Ports {
    let mut ports = Ports::default();
    for measurement in test.measurements.iter().filter(|measurement| measurement.piece == index) {
        if let MeasurementData::TimeHistory(record) | MeasurementData::Accelerance(record) = &measurement.data {
            for (places, place) in [(&mut ports.forces, record.force_at), (&mut ports.responses, record.response_at)] {
                if !places.contains(&place) {
                    places.push(place);
                }
            }
        }
    }
    if ports.forces.is_empty() {
        // To the micrometre, so that it reads as a round number in the files.
        let place = (375e3 * piece.length).round() / 1e6;
        ports.forces.push(Place { x: -place, y: 0.0 });
        ports.responses.push(Place { x: place, y: 0.0 });
    }
    ports
}

/// A name as part of a file name: letters, digits, `-` and `_` stay, every other byte becomes `%XX`.
fn file_name_part(name: &str) -> String {
    let part = |byte: u8| match byte {
        b'-' | b'_' => char::from(byte).to_string(),
        _ if byte.is_ascii_alphanumeric() => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    name.bytes().map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_stay_in_their_folder_and_apart() {
        assert_eq!(file_name_part("piece_2-a"), "piece_2-a");
        assert_eq!(file_name_part("../x"), "%2E%2E%2Fx");
        assert_ne!(file_name_part("a/b"), file_name_part("a_b"));
    }
}
