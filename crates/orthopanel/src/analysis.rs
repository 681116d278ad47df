//! All that a test says: its base model, what that lacks, and the page that shows both.

use orthopanel_identify::{IdentifyError, Settings};
use orthopanel_model::{PanelModel, StructureKind};

use crate::evidence::Evidence;
use crate::{Error, Identified, Observer, Test, Traced, report};

/// An identification and a trace of one test.
pub struct Analysis {
    pub(crate) test: Test,
    pub(crate) found: Found,
}

pub(crate) enum Found {
    /// The base model, and its trace or the sentence that says why there is none.
    Identified { identified: Box<Identified>, traced: Result<Traced, String> },
    /// Records that no beam could give: they may be a plate's, or a large effect's, and their trace tells.
    Contradicted { traced: Traced, settings: Settings, refused: Error },
}

impl Analysis {
    /// Identifies and traces, the latter against a sound panel of the same make where there is one.
    ///
    /// # Errors
    /// [`Error::Identify`] for a test that is refused; records that contradict a beam are none such yet, their trace may explain
    /// them: [`Analysis::end`] tells. [`Error::Interrupted`].
    pub fn of(
        test: &Test,
        reference: Option<&Test>,
        settings: Settings,
        observer: &dyn Observer,
    ) -> Result<Self, Error> {
        let found = match test.identify_with(settings, observer) {
            Ok(identified) => {
                let traced = Traced::where_possible(test, reference, observer)?;
                Found::Identified { identified: Box::new(identified), traced }
            }
            Err(refused @ Error::Identify { source: IdentifyError::Contradiction { .. }, .. })
                if test.content().structure != Some(StructureKind::MindlinPlate) =>
            {
                observer.say(&format!("not identified: {refused}"));
                Found::Contradicted { traced: Traced::of(test, reference, observer)?, settings, refused }
            }
            Err(refused) => return Err(refused),
        };
        Ok(Self { test: test.clone(), found })
    }

    /// The base model; `None` where the records contradict it.
    pub fn identified(&self) -> Option<&Identified> {
        match &self.found {
            Found::Identified { identified, .. } => Some(identified),
            Found::Contradicted { .. } => None,
        }
    }

    /// What the base model lacks.
    ///
    /// # Errors
    /// The sentence that says why the test cannot be traced.
    pub fn traced(&self) -> Result<&Traced, &str> {
        match &self.found {
            Found::Identified { traced, .. } => traced.as_ref().map_err(String::as_str),
            Found::Contradicted { traced, .. } => Ok(traced),
        }
    }

    /// The models after tracing, one a piece: those of the base where it was not traced, none where nothing explains the records.
    pub(crate) fn panels(&self) -> Vec<PanelModel> {
        match &self.found {
            Found::Identified { identified, traced } => traced
                .as_ref()
                .map_or_else(|_| identified.models.clone(), |traced| traced.applied_to(&identified.models)),
            Found::Contradicted { traced, .. } if traced.explains() => traced.applied_to(&traced.tracing.panels),
            Found::Contradicted { .. } => vec![],
        }
    }

    pub(crate) fn evidence(&self, observer: &dyn Observer) -> Result<Evidence, Error> {
        match &self.found {
            Found::Identified { identified, traced } => Evidence::of(identified, traced.as_ref().ok(), observer),
            Found::Contradicted { traced, settings, .. } => {
                Evidence::of_trace(&self.test, traced, settings.estimation, observer)
            }
        }
    }

    pub(crate) fn page_of(&self, evidence: &Evidence) -> Result<String, Error> {
        match &self.found {
            Found::Identified { identified, traced } => {
                report::page(identified, traced.as_ref().map_err(String::as_str), evidence)
            }
            Found::Contradicted { traced, refused, .. } => {
                let refused = match refused {
                    Error::Identify { source, .. } => source.to_string(),
                    other => other.to_string(),
                };
                report::page_of_trace(&self.test, &refused, traced, evidence)
            }
        }
    }

    /// One HTML page, which needs no network and nothing beside it.
    ///
    /// # Errors
    /// [`Error::Data`] where records cannot be read any more, [`Error::Picture`].
    pub fn page(&self, observer: &dyn Observer) -> Result<String, Error> {
        self.page_of(&self.evidence(observer)?)
    }

    /// Where the base model was refused and the trace explains nothing, the refusal stands.
    ///
    /// # Errors
    /// That refusal.
    pub fn end(self) -> Result<(), Error> {
        match self.found {
            Found::Contradicted { traced, refused, .. } if !traced.explains() => Err(refused),
            _ => Ok(()),
        }
    }
}
