//! Effects of the catalogue that a test does not show, and why.

use orthopanel_model::{Action, Effect, catalogue};

use crate::outcome::NotTested;
use crate::posterior::Judged;
use crate::search::Inquiry;

const ONE_RECORD: &str = "one record has no other to differ from";
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
    if inquiry.is_of_lists() {
        return inquiry.hidden_in_lists(effect).unwrap_or_else(|| NO_START.to_owned());
    }
    if !inquiry.can_show(effect) {
        return ONE_RECORD.to_owned();
    }
    match inquiry.acts(effect) {
        Err(error) => error.to_string(),
        Ok(actions) if actions.is_empty() => BY_LEVEL.to_owned(),
        Ok(actions) if actions.iter().any(|action| matches!(action, Action::Core(_) | Action::Plate(_))) => {
            OTHER_MODES.to_owned()
        }
        Ok(_) => NO_START.to_owned(),
    }
}
