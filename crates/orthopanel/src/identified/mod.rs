//! What an identification found, as JSON (`orthopanel.identified/1`), as tables, and as one model a piece.

mod answer;
mod measured;
mod mode_rows;
mod models;
mod text;

use orthopanel_data::{ImpactTest, NamedPiece};
use orthopanel_identify::{Identification, IdentifiedConstant, IdentifyError, PieceFit, Settings, identify};
use orthopanel_model::PanelModel;

use crate::error::Error;
use crate::evidence::Evidence;
use crate::notes::note;
use crate::observer::{Observer, Steps};
use crate::provenance::{Provenance, WithProvenance};
use crate::{Model, Test, Traced, interruption, json, report};
pub use answer::{Answer, called};
pub(crate) use measured::MeasuredTable;
pub use mode_rows::{Digits, ModeRows};
use models::model;
pub use models::{ASSUMED_DAMPING, to_digits};
pub use text::shown_correlations;

/// What was identified from a test, and a model of each of its pieces.
pub struct Identified {
    pub(crate) test: Test,
    pub(crate) settings: Settings,
    pub(crate) found: Identification,
    /// In the order of `found.pieces`.
    pub(crate) models: Vec<PanelModel>,
    /// The JSON object, with the modes that the records show by themselves.
    pub(crate) answer: Answer,
}

impl Identified {
    /// Identifies the panel of a test; says what was noted and had to be assumed.
    pub(crate) fn of(test: &Test, settings: Settings, observer: &dyn Observer) -> Result<Self, Error> {
        let content = test.content();
        let found = {
            let _shown = observer.begin("reading the records and identifying", Steps::Unknown);
            let found = interruption::caught(|| identify(content, settings))?;
            found.map_err(|source| Error::Identify { path: test.path().into(), source })?
        };
        note(observer, "", &found.notes);
        let models = models_of(content, &found, settings);
        if let Some(sentence) = assumed_damping(&found) {
            observer.say(&sentence);
        }
        let measured = {
            let _shown = observer.begin("measuring the modes of all records together", Steps::Unknown);
            interruption::caught(|| {
                interruption::heed(observer);
                MeasuredTable::all(content, &found, &models)
            })?
        };
        let answer = Answer::of(&found, measured);
        Ok(Self { test: test.clone(), settings, found, models, answer })
    }

    /// All that was found: constants, correlations, each piece's modes, and the accelerances measured and calculated.
    pub fn found(&self) -> &Identification {
        &self.found
    }

    /// A constant that the pieces have in common, by its name.
    pub fn constant(&self, name: &str) -> Option<&IdentifiedConstant> {
        self.found.constants.iter().find(|constant| constant.name == name && constant.piece.is_none())
    }

    /// The test that it was identified from.
    pub fn test(&self) -> &Test {
        &self.test
    }

    /// The model of each piece.
    pub fn models(&self) -> Vec<Model> {
        self.models.iter().map(|panel| Model::of(panel.clone(), self.test.path())).collect()
    }

    /// As [`Identified::models`], each behind `-NAME` of its piece, safe in file names, where there are several.
    pub fn named_models(&self) -> Vec<(String, Model)> {
        self.found.pieces.iter().map(|fit| self.suffix(fit)).zip(self.models()).collect()
    }

    /// One HTML page of the test, which needs no network and nothing beside it, with what was traced or why nothing was.
    ///
    /// # Errors
    /// [`Error::Data`] where records cannot be read any more, [`Error::Picture`].
    pub fn page(&self, traced: Result<&Traced, &str>, observer: &dyn Observer) -> Result<String, Error> {
        report::page(self, traced, &Evidence::of(self, traced.ok(), observer)?)
    }

    /// The modes that the records of a piece show without a model.
    pub(crate) fn measured_modes<'a>(&'a self, piece: &'a str) -> impl Iterator<Item = &'a MeasuredTable> {
        self.answer.measured_modes.iter().filter(move |measured| measured.piece == piece)
    }

    /// One JSON object (`orthopanel.identified/1`) on one line.
    pub fn to_json(&self) -> String {
        json::line(&self.answer)
    }

    /// As [`Identified::to_json`], with what it is of.
    #[doc(hidden)]
    pub fn to_json_with(&self, provenance: &Provenance) -> String {
        json::line(&WithProvenance { answer: &self.answer, provenance })
    }

    /// `-NAME` where there are several pieces, safe in file names; nothing for a single one.
    pub(crate) fn suffix(&self, piece: &PieceFit) -> String {
        suffix(&piece.name, &self.test.content().pieces)
    }
}

/// The models that [`Identified::of`] makes of a test, without a word.
pub(crate) fn base_models(test: &ImpactTest, settings: Settings) -> Result<Vec<PanelModel>, IdentifyError> {
    Ok(models_of(test, &identify(test, settings)?, settings))
}

fn models_of(test: &ImpactTest, found: &Identification, settings: Settings) -> Vec<PanelModel> {
    let of_piece = |(index, fit)| model(test, found, index, fit, settings.damping_law);
    found.pieces.iter().enumerate().map(of_piece).collect()
}

/// What has to be said where no mode's damping was measured.
fn assumed_damping(found: &Identification) -> Option<String> {
    if found.pieces.iter().any(|fit| fit.measured_damping().next().is_some()) {
        return None;
    }
    let every = format!(
        "the model takes zeta = {ASSUMED_DAMPING} for every mode, an assumption (damping.beyond in the model file)"
    );
    Some(if found.accelerances.is_empty() {
        format!("damping: natural frequencies alone measure none; {every}")
    } else if found.pieces.iter().all(|fit| fit.damping.is_empty()) {
        format!("damping: no mode lies in the band of the records; {every}")
    } else {
        format!(
            "damping: no resonance stands out from the records by itself; the ratios in the model file are those with which \
             the records as a whole fit best, and beyond them zeta = {ASSUMED_DAMPING}, an assumption (damping.beyond)"
        )
    })
}

/// That of every piece of a test.
pub fn suffixes(test: &ImpactTest) -> impl Iterator<Item = String> {
    test.pieces.iter().map(|piece| suffix(&piece.name, &test.pieces))
}

/// `-NAME` of one of several pieces, safe in file names; nothing for a single one.
///
/// A long name is cut. One that was cut, one that differs from another piece's by capitals alone, which are the same to some
/// systems, and one that would be the manifest's, ends in its checksum.
pub fn suffix(name: &str, pieces: &[NamedPiece]) -> String {
    if pieces.len() <= 1 {
        return String::new();
    }
    let part = file_name_part(name);
    let is_alike = |other: &&NamedPiece| file_name_part(&other.name).eq_ignore_ascii_case(&part);
    let is_manifest = part.eq_ignore_ascii_case("manifest");
    if part.len() <= LONGEST_PART && !is_manifest && pieces.iter().filter(is_alike).count() <= 1 {
        return format!("-{part}");
    }
    let cut = part.get(..LONGEST_PART).unwrap_or(&part);
    format!("-{cut}-{:08x}", checksum(name))
}

/// Bytes of a file's name that a piece's name may take: systems allow 255 for the whole.
const LONGEST_PART: usize = 100;

/// FNV-1a (RFC 9923) of 32 bits.
fn checksum(name: &str) -> u32 {
    name.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
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
    use orthopanel_model::Piece;

    use super::*;

    #[test]
    fn file_names_stay_in_their_folder_and_apart() {
        assert_eq!(file_name_part("piece_2-a"), "piece_2-a");
        assert_eq!(file_name_part("../x"), "%2E%2E%2Fx");
        assert_ne!(file_name_part("a/b"), file_name_part("a_b"));
    }

    #[test]
    fn names_of_files_are_short_and_differ_by_more_than_capitals() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let pieces = |names: &[&str]| -> Vec<NamedPiece> {
            let named = |name: &&str| NamedPiece {
                name: (*name).to_owned(),
                piece,
                doubt: Default::default(),
                own_constants: vec![],
            };
            names.iter().map(named).collect()
        };
        assert_eq!(suffix("a", &pieces(&["a"])), "");
        assert_eq!(suffix("a", &pieces(&["a", "b"])), "-a");
        assert_ne!(suffix("manifest", &pieces(&["a", "manifest"])), "-manifest");
        let alike = pieces(&["Piece", "piece"]);
        let [first, second] = ["Piece", "piece"].map(|name| suffix(name, &alike).to_lowercase());
        assert_ne!(first, second);
        let (long, longer) = ("木".repeat(90), "木".repeat(91));
        let both = pieces(&[&long, &longer]);
        let [first, second] = [&long, &longer].map(|name| suffix(name, &both));
        assert!(first != second && first.len() < 120 && second.len() < 120, "{first} {second}");
    }
}
