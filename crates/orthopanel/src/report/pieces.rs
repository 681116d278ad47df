//! One piece of the test: its records, the fit, and what the model leaves.

use orthopanel_data::NamedPiece;
use orthopanel_identify::PieceFit;
use orthopanel_model::{Piece, Readable};

use super::figure::Figure;
use super::measured_modes::MeasuredModesSection;
use super::table::Table;
use crate::error::Error;
use crate::evidence::{PairResidual, PieceEvidence, RecordRow, ResidualUnit};
use crate::identified::{Digits, ModeRows};
use crate::measured_pairs::place_text;
use crate::pictures;

pub struct PieceSection {
    pub name: String,
    pub sizes: String,
    /// Behind the headings of what shows the base model alone, where effects were found.
    pub of_base: &'static str,
    /// Behind those of what shows the model with the effects beside it.
    pub of_both: &'static str,
    pub records: Option<Table>,
    pub coherence: Option<Figure>,
    /// What the records show before any model.
    pub measured: Vec<MeasuredModesSection>,
    pub modes: Option<Table>,
    pub frequencies: Option<Figure>,
    pub galleries: Vec<Gallery>,
    pub residual: Vec<Figure>,
}

/// Pictures of one kind, of which the first are shown and the others folded away.
pub struct Gallery {
    pub heading: &'static str,
    pub shown: Vec<Figure>,
    pub folded: Vec<Figure>,
}

/// Pictures of a gallery that are shown at once.
const SHOWN: usize = 2;

impl Gallery {
    pub fn new(heading: &'static str, caption: &str, pictures: &[String]) -> Option<Self> {
        let mut shown: Vec<Figure> = pictures.iter().map(|picture| Figure::new(picture, caption)).collect();
        let folded = shown.split_off(SHOWN.min(shown.len()));
        (!shown.is_empty()).then_some(Self { heading, shown, folded })
    }
}

impl PieceSection {
    /// `has_effects`: whether a trace found any, so that the base model is not the last word.
    pub fn of(fit: &PieceFit, shown: &PieceEvidence, has_effects: bool) -> Result<Self, Error> {
        let accelerance_caption = match shown.residuals.is_empty() {
            true => "Accelerance of the model; the vertical lines are the measured natural frequencies.",
            false => MEASURED_CAPTION,
        };
        let galleries = [
            Gallery::new("Continuous records", CUT_CAPTION, &shown.cuts),
            Gallery::new("Accelerances", accelerance_caption, &shown.accelerances),
            Gallery::new("Time histories", HIT_CAPTION, &shown.time_histories),
        ];
        let of_base = if has_effects { BASE } else { "" };
        Ok(Self {
            name: fit.name.clone(),
            sizes: sizes(&fit.piece),
            of_base,
            of_both: if shown.with_effects.is_some() { ", before and with the effects" } else { of_base },
            records: (!shown.records.is_empty()).then(|| records(&shown.records)),
            coherence: shown.coherence.as_ref().map(|picture| Figure::new(picture, COHERENCE_CAPTION)),
            measured: vec![],
            modes: (!fit.modes.is_empty() || !fit.hidden.is_empty()).then(|| modes(fit, shown.with_effects.as_deref())),
            frequencies: shown.frequencies.as_ref().map(|picture| Figure::new(picture, FREQUENCIES_CAPTION)),
            galleries: galleries.into_iter().flatten().collect(),
            residual: residual(&shown.residuals, &shown.levels, &measured_modes(fit))?,
        })
    }

    /// Of a trace alone: what is calculated is the base model of the trace.
    pub fn of_trace(named: &NamedPiece, shown: &PieceEvidence) -> Result<Self, Error> {
        Ok(Self {
            name: named.name.clone(),
            sizes: sizes(&named.piece),
            of_base: BASE,
            of_both: BASE,
            records: (!shown.records.is_empty()).then(|| records(&shown.records)),
            coherence: shown.coherence.as_ref().map(|picture| Figure::new(picture, COHERENCE_CAPTION)),
            measured: vec![],
            modes: None,
            frequencies: None,
            galleries: [
                Gallery::new("Continuous records", CUT_CAPTION, &shown.cuts),
                Gallery::new("Accelerances", MEASURED_CAPTION, &shown.accelerances),
            ]
            .into_iter()
            .flatten()
            .collect(),
            residual: residual(&shown.residuals, &shown.levels, &[])?,
        })
    }
}

const BASE: &str = ": the base model, before effects";
const MEASURED_CAPTION: &str = "Measured in orange, calculated in blue.";
const CUT_CAPTION: &str =
    "The force of the whole record, the level that a blow passes, and the stretch that each hit was cut to.";
const HIT_CAPTION: &str =
    "A measured hit, the accelerations measured and calculated under it, and their difference over the whole record.";
const COHERENCE_CAPTION: &str = "How much of the acceleration answers the force: 1 where all of it does; it falls at valleys and where the hammer has no force.";
const FREQUENCIES_CAPTION: &str = "Natural frequencies, measured and calculated, and the error of each.";

fn sizes(piece: &Piece) -> String {
    format!("{} x {} x {} m, {:.4} kg/m².", piece.length, piece.width, piece.thickness, piece.mass_per_area)
}

fn records(rows: &[RecordRow]) -> Table {
    let row = |record: &RecordRow| {
        let faults = if record.faults.is_empty() { "none".into() } else { record.faults.join("; ") };
        vec![
            format!("{} to {}", place_text(record.force), place_text(record.response)),
            record.holds.clone(),
            record.band.clone(),
            record.kept.map_or("not told".into(), |kept| kept.to_string()),
            faults,
        ]
    };
    let headings = ["force to response [m]", "record", "band", "hits kept", "\"faults"];
    Table::new(&headings, rows.iter().map(row).collect())
}

/// With the model with the effects behind the base model, where there is one.
fn modes(fit: &PieceFit, with_effects: Option<&[f64]>) -> Table {
    let rows = ModeRows::of(fit, &Digits { frequency: 2, error: 4 });
    let model = if with_effects.is_some() { "base model [Hz]" } else { "model [Hz]" };
    let (mut headings, mut rows) = rows.shown([
        "mode",
        "nodes along x, y",
        "measured [Hz]",
        "std [Hz]",
        model,
        "error [%]",
        "zeta",
        "std of zeta",
    ]);
    if let Some(with_effects) = with_effects {
        headings.extend(["with effects [Hz]", "error [%]"]);
        // Rows rise, and lists hide no mode.
        let mut found: Vec<_> = fit.modes.iter().zip(with_effects).collect();
        found.sort_by_key(|(mode, _)| mode.mode);
        for (row, (mode, model)) in rows.iter_mut().zip(found) {
            row.push(format!("{model:.2}"));
            row.push(format!("{:+.4}", Readable(100.0 * (model / mode.measured - 1.0))));
        }
    }
    Table::new(&headings, rows)
}

/// Their frequencies \[Hz\], rising.
pub(super) fn measured_modes(fit: &PieceFit) -> Vec<f64> {
    let mut modes: Vec<f64> = fit.modes.iter().map(|mode| mode.measured).collect();
    modes.sort_by(f64::total_cmp);
    modes
}

fn residual(residuals: &[PairResidual], levels: &[(f64, f64)], modes: &[f64]) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    if !residuals.is_empty() {
        let unit = match residuals.iter().all(|pair| pair.unit == ResidualUnit::Noise) {
            true => {
                "Root mean square of measured less calculated, over the noise of each line: 1, the grey line, where only noise is left."
            }
            false => {
                "Root mean square of measured less calculated, in percent of the rms measured: these records do not tell their noise."
            }
        };
        figures.push(Figure::new(&pictures::residual_by_frequency(residuals)?, unit));
        figures.push(Figure::new(
            &pictures::residual_by_place(residuals)?,
            "A place that stands out points to something at that place, or to its record.",
        ));
    }
    if residuals.len() > 1 && modes.len() > 1 {
        figures.push(Figure::new(
            &pictures::residual_by_place_and_mode(residuals, modes)?,
            "A row that is dark in all modes is a record by itself; what sits at a place shows in the modes that move there.",
        ));
    }
    if levels.len() > 1 {
        figures.push(Figure::new(
            &pictures::residual_by_level(levels)?,
            "A misfit that grows with the force points to something that is not linear.",
        ));
    }
    Ok(figures)
}
