//! What an identification found, as JSON (`orthopanel.identified/1`), as tables, and as one model a piece.

mod answer;
mod mode_rows;
mod models;
mod report;

use std::path::Path;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Identification, IdentifyError, PieceFit, Settings, identify};
use orthopanel_model::PanelModel;

use crate::error::CommandError;
use crate::record_options::IdentifyOptions;
use crate::{console, notes, progress};
pub use answer::{Answer, called};
pub use mode_rows::{Digits, ModeRows};
use models::model;
pub use models::{ASSUMED_DAMPING, to_digits};

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
    /// Identifies the panel of a test, read at `path`; says on standard error what was noted and had to be assumed.
    pub fn from_test(test: &ImpactTest, path: &Path, options: &IdentifyOptions) -> Result<Self, CommandError> {
        let settings = options.settings()?;
        options.say_if_idle(test);
        let found = {
            let _shown = progress::spinner("reading the records and identifying");
            identify(test, settings).map_err(|source| CommandError::Identify { path: path.into(), source })?
        };
        notes::say("", &found.notes);
        let models = models_of(test, &found, settings);
        if let Some(sentence) = assumed_damping(&found) {
            console::say(sentence);
        }
        let answer = Answer::of(&found);
        Ok(Self { test: test.clone(), found, models, answer })
    }

    /// `-NAME` where there are several pieces, safe in file names; nothing for a single one.
    pub fn suffix(&self, piece: &PieceFit) -> String {
        suffix(&piece.name, self.found.pieces.len())
    }
}

/// The models that [`Identified::from_test`] makes of a test, without a word on standard error.
pub fn base_models(test: &ImpactTest, settings: Settings) -> Result<Vec<PanelModel>, IdentifyError> {
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
    test.pieces.iter().map(|piece| suffix(&piece.name, test.pieces.len()))
}

/// `-NAME` of one of so many pieces, safe in file names; nothing for a single one.
pub fn suffix(name: &str, pieces: usize) -> String {
    if pieces == 1 { String::new() } else { format!("-{}", file_name_part(name)) }
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
