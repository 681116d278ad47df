//! What lists of natural frequencies can show.

use orthopanel_model::{Action, Effect, Owner, Place};

use super::Inquiry;
use crate::effect_places::{OF_PIECE, has_place};

impl Inquiry<'_> {
    /// Whether frequencies are all that was measured.
    pub(crate) fn is_of_lists(&self) -> bool {
        self.stacked.blocks.iter().all(|block| block.comparison().measured.records.is_empty())
    }

    /// Frequencies of all lists.
    pub(crate) fn frequencies(&self) -> usize {
        self.stacked.blocks.iter().map(|block| block.comparison().measured.poles.len()).sum()
    }

    /// Why lists of natural frequencies cannot show an effect; `None` where they can.
    pub(crate) fn hidden_in_lists(&self, effect: &dyn Effect) -> Option<String> {
        let said = |reason: &str| Some(reason.to_owned());
        if effect.owner() == Owner::Channel {
            return said(
                "no natural frequency moves with what the measuring chain adds or with where hammer and sensor stand",
            );
        }
        let acts = match self.acts(effect) {
            Ok(acts) => acts,
            Err(error) => return Some(error.to_string()),
        };
        if acts.iter().any(|action| matches!(action, Action::Core(_))) {
            return said(
                "a core whose stiffness rises with frequency looks in frequencies alone like other constants; its losses show it, \
                 in how damping goes from mode to mode: record hits (kind = \"time-history\" or \"accelerance\")",
            );
        }
        if acts.is_empty() {
            let mut with_sensor = self.predictor().setting(0);
            with_sensor.record.response_at = Some(Place { x: 0.0, y: 0.0 });
            return said(if self.acts_in(effect, &with_sensor).is_ok_and(|acts| !acts.is_empty()) {
                "a sensor loads the panel where it sits: give its place, response_at = [x, y], in the measurement"
            } else {
                "what depends on the strength of a hit shows in records of hits of several strengths (kind = \"time-history\")"
            });
        }
        let first = self.stacked.first().piece;
        if has_place(effect) && self.stacked.blocks.iter().any(|block| block.piece != first) {
            return said(OF_PIECE);
        }
        None
    }
}
