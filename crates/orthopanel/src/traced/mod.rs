//! What a trace found, as text for people and as the panel's model; its JSON (`orthopanel.trace/1`) is the layer's own.

mod sentences;
mod tables;

use std::path::Path;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{IdentifyError, Tracing, Verdict, trace_with};
use orthopanel_model::PanelModel;
use serde_json::Value;

use crate::{notes, progress};
pub use tables::{comparison_rows, effect_rows, ranking_rows};

/// What a mode's entry in a model's provenance tells of the test alone.
const AS_MEASURED: [&str; 4] = ["mode", "nodes", "measured_hz", "measured_std_hz"];

/// A trace of a test.
pub struct Traced {
    pub tracing: Tracing,
}

impl Traced {
    /// Traces; shows on standard error how far it is, and says what was noted.
    pub fn from_test(test: &ImpactTest) -> Result<Self, IdentifyError> {
        let tracing = {
            let shown = progress::counted("tracing what the model lacks");
            trace_with(test, &|at| shown.at(at.done, at.of, at.effect))?
        };
        notes::say("", &tracing.notes);
        Ok(Self { tracing })
    }

    /// As [`Traced::from_test`] where tracing is not all that was asked for: of a test that it refuses the sentence that
    /// says so, which goes to standard error too.
    pub fn where_possible(test: &ImpactTest, path: &Path) -> Result<Self, String> {
        Self::from_test(test).map_err(|error| {
            eprintln!("not traced: {}: {error}", path.display());
            format!("Not traced: {error}.")
        })
    }

    /// The panels with the effects that were found and are theirs; `None` where no effect was found, or none that explains
    /// the data.
    fn panels(&self) -> Option<&[PanelModel]> {
        let found = matches!(self.tracing.verdict, Verdict::Explained | Verdict::Ambiguous);
        (found && !self.tracing.effects.is_empty()).then_some(&self.tracing.panels)
    }

    /// Whether effects were found that explain the data.
    pub fn explains(&self) -> bool {
        self.panels().is_some()
    }

    /// The identified models with what the trace found: its constants, its damping and the panel's own effects. Effects
    /// of rig and measuring chain are in none of them.
    pub fn applied_to(&self, models: &[PanelModel]) -> Vec<PanelModel> {
        let mut models = models.to_vec();
        for (model, panel) in models.iter_mut().zip(self.panels().unwrap_or_default()) {
            model.structure = panel.structure;
            model.constants.clone_from(&panel.constants);
            model.damping.clone_from(&panel.damping);
            model.effects.clone_from(&panel.effects);
            if let Some(modes) = model.provenance.get_mut("modes").and_then(Value::as_array_mut) {
                // The rest is that of the model without the effects.
                modes.iter_mut().filter_map(Value::as_object_mut).for_each(|mode| {
                    mode.retain(|key, _| AS_MEASURED.contains(&key.as_str()));
                });
            }
            model.provenance.insert("trace".into(), self.tracing.verdict.name().into());
            let removed: Vec<&str> = self.tracing.removed.iter().map(|removed| removed.id).collect();
            if !removed.is_empty() {
                model.provenance.insert("removed".into(), removed.into());
            }
        }
        models
    }
}
