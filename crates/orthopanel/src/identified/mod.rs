//! What an identification found, as JSON (`orthopanel.identified/1`), as tables, and as one model a piece.

mod answer;
mod measured;
mod mode_rows;
mod models;
mod text;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Identification, IdentifiedConstant, IdentifyError, PieceFit, Settings, identify};
use orthopanel_model::PanelModel;

use crate::error::Error;
use crate::notes::note;
use crate::observer::{Observer, Steps};
use crate::provenance::{Provenance, WithProvenance};
use crate::suffixes::suffix;
use crate::{Model, Silent, Test, interruption, json};
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

impl Test {
    /// The constants of the panel, and its damping where there are records.
    ///
    /// # Errors
    /// [`Error::Identify`]; [`Error::says_no`] tells data that contradict the model from a test that is not as it should be.
    pub fn identify(&self) -> Result<Identified, Error> {
        self.identify_with(Settings::default(), &Silent)
    }

    /// As [`Test::identify`], with other settings, and told to an observer.
    ///
    /// # Errors
    /// As [`Test::identify`], and [`Error::Interrupted`] where the observer asks for it.
    pub fn identify_with(&self, settings: Settings, observer: &dyn Observer) -> Result<Identified, Error> {
        Identified::of(self, settings, observer)
    }
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
