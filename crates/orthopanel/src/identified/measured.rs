//! The modes that the records show before any model, beside those of the model that was identified.

use std::f64::consts::TAU;

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_identify::{Identification, MeasuredModes, ModalAssurance, ModeMatch, measured_modes};
use orthopanel_model::{PanelModel, Readable};
use serde::Serialize;

use crate::tables;

/// The measured modes of one piece's records.
#[derive(Serialize)]
pub struct MeasuredTable {
    pub(crate) piece: String,
    /// Misfit of the modal fit per datum, over the noise of the records.
    chi_square: Option<f64>,
    modes: Vec<MeasuredMode>,
    /// Of each mode the modal assurance criterion with every mode of the model; `None` of a single record. For pictures.
    #[serde(skip)]
    pub(crate) assurance: Option<ModalAssurance>,
}

/// A pole of all records, and the flexible mode of the model that it is.
#[derive(Serialize)]
struct MeasuredMode {
    frequency_hz: f64,
    std_hz: f64,
    zeta: Option<f64>,
    zeta_std: Option<f64>,
    /// `null` where no mode of the model is near: a mode of the suspension, or of what the model lacks.
    mode: Option<usize>,
    model_hz: Option<f64>,
    error_percent: Option<f64>,
    /// Modal assurance criterion over the records; `null` of a single record.
    mac: Option<f64>,
}

impl MeasuredTable {
    /// One a piece with records; none where records show no resonance.
    pub(super) fn all(test: &ImpactTest, found: &Identification, models: &[PanelModel]) -> Vec<Self> {
        let is_list = |data: &MeasurementData| matches!(data, MeasurementData::NaturalFrequencies(_));
        let has_records = test.measurements.iter().any(|measurement| !is_list(&measurement.data));
        // Whatever keeps the modes from being measured has been said by the identification, or is no fault.
        let measured = if has_records { measured_modes(test).unwrap_or_default() } else { vec![] };
        let table = |measured: &MeasuredModes| {
            let piece = &test.pieces.get(measured.piece)?.name;
            let index = found.pieces.iter().position(|fit| fit.name == *piece)?;
            Some(Self::of(piece, measured, models.get(index)?))
        };
        measured.iter().filter(|measured| !measured.records.is_empty()).filter_map(table).collect()
    }

    fn of(piece: &str, measured: &MeasuredModes, model: &PanelModel) -> Self {
        let count = measured.poles.len();
        let matches = measured.matched_with(model).unwrap_or_else(|_| vec![None; count]);
        // The logarithms of the frequencies, then those of the ratios.
        let deviation = |row: usize| measured.covariance[(row, row)].sqrt();
        let mode = |(index, partner): (usize, &Option<ModeMatch>)| {
            let pole = measured.poles[index];
            let frequency_hz = pole.angular_frequency / TAU;
            MeasuredMode {
                frequency_hz,
                std_hz: frequency_hz * deviation(index),
                zeta: pole.damping_ratio,
                zeta_std: pole.damping_ratio.map(|zeta| zeta * deviation(count + index)),
                mode: partner.map(|partner| partner.mode),
                model_hz: partner.map(|partner| partner.frequency),
                error_percent: partner.map(|partner| 100.0 * (partner.frequency / frequency_hz - 1.0)),
                mac: partner.and_then(|partner| partner.assurance),
            }
        };
        Self {
            piece: piece.to_owned(),
            chi_square: measured.chi_square,
            modes: matches.iter().enumerate().map(mode).collect(),
            assurance: measured.assurance_with(model).ok().flatten(),
        }
    }

    /// Measured frequencies \[Hz\].
    pub(crate) fn frequencies(&self) -> Vec<f64> {
        self.modes.iter().map(|mode| mode.frequency_hz).collect()
    }

    /// The mode of the model that each is.
    pub(crate) fn partners(&self) -> Vec<Option<usize>> {
        self.modes.iter().map(|mode| mode.mode).collect()
    }

    /// Headings and a row a mode.
    pub(crate) fn rows(&self) -> ([&'static str; 8], Vec<Vec<String>>) {
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".into());
        let row = |mode: &MeasuredMode| {
            let digits = digits_of(mode.std_hz);
            vec![
                format!("{:.digits$}", Readable(mode.frequency_hz)),
                format!("{:.1e}", mode.std_hz),
                or_dash(mode.zeta.map(|zeta| format!("{zeta:.3e}"))),
                or_dash(mode.zeta_std.map(|std| format!("{std:.1e}"))),
                or_dash(mode.mode.map(|mode| mode.to_string())),
                or_dash(mode.model_hz.map(|model| format!("{:.digits$}", Readable(model)))),
                or_dash(mode.error_percent.map(|error| format!("{:+.4}", Readable(error)))),
                or_dash(mode.mac.map(|mac| format!("{mac:.4}"))),
            ]
        };
        let headings =
            ["measured [Hz]", "std [Hz]", "zeta", "std of zeta", "model mode", "model [Hz]", "error [%]", "MAC"];
        (headings, self.modes.iter().map(row).collect())
    }

    /// What is to be said of the table.
    pub(crate) fn remarks(&self) -> Vec<&'static str> {
        let mut remarks = Vec::new();
        if self.modes.iter().any(|mode| mode.mac.is_some()) {
            remarks.push(
                "MAC: modal assurance criterion between the residues and the model's mode shape at the measured places",
            );
        }
        if self.modes.iter().any(|mode| mode.mode.is_none()) {
            remarks.push(
                "a mode without a partner is none of the free panel's: the suspension's, or what the model lacks",
            );
        }
        remarks
    }

    /// For people.
    pub(super) fn text(&self) -> String {
        let misfit = self.chi_square.map_or(String::new(), |chi_square| {
            format!("; chi-square per datum {:.2} (1: all that is left is noise)", Readable(chi_square))
        });
        let (headings, rows) = self.rows();
        let mut text = format!(
            "piece {}: experimental modal analysis of all records together, without a model{misfit}\n{}",
            self.piece,
            tables::aligned(&headings, &rows)
        );
        self.remarks().iter().for_each(|remark| text += &format!("{remark}\n"));
        text
    }
}

/// Digits behind the point with which a number shows its deviation, no fewer than two.
fn digits_of(std: f64) -> usize {
    if std > 0.0 { (-std.log10()).ceil().clamp(2.0, 6.0) as usize } else { 2 }
}
