//! Effects of the catalogue that a test does not show, and why.

use orthopanel_model::{Action, Effect, catalogue};

use crate::outcome::NotTested;
use crate::posterior::Judged;
use crate::search::Inquiry;

const OTHER_MODES: &str = "it changes the modes in a way that measured modes are not asked for yet";
const BY_LEVEL: &str = "it shows between hits of unequal strength: hit each place softly and hard";
const NO_START: &str = "no start led anywhere";

/// Every effect that is in no hypothesis.
pub(super) fn not_tested(inquiry: &Inquiry, all: &[Judged]) -> Vec<NotTested> {
    let tried = |id: &str| all.iter().any(|judged| judged.hypothesis.parts.iter().any(|part| part.effect.id() == id));
    let missing = catalogue().iter().filter(|effect| !tried(effect.id()));
    let told = |effect: &&'static dyn Effect| NotTested { id: effect.id(), reason: reason(inquiry, *effect) };
    missing.map(told).collect()
}

fn reason(inquiry: &Inquiry, effect: &dyn Effect) -> String {
    if let Some(hidden) = inquiry.hidden(effect) {
        return hidden;
    }
    match inquiry.acts(effect) {
        _ if inquiry.is_of_lists() => NO_START.to_owned(),
        Err(error) => error.to_string(),
        Ok(actions) if actions.is_empty() => BY_LEVEL.to_owned(),
        Ok(actions) if actions.iter().any(|action| matches!(action, Action::Core(_) | Action::Plate(_))) => {
            OTHER_MODES.to_owned()
        }
        Ok(_) => NO_START.to_owned(),
    }
}
