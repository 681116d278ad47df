//! Effects of the catalogue that a test does not show, and why.

use orthopanel_model::{Action, Effect, EffectParameter, SuspensionMotion, catalogue};

use crate::outcome::NotTested;
use crate::posterior::Judged;
use crate::predicted::Predictor;
use crate::search::Inquiry;

const ONE_RECORD: &str = "one record has no other to differ from";
const OTHER_MODES: &str = "it changes the modes in a way that measured modes are not asked for yet";
const BY_LEVEL: &str =
    "it shows between hits of unequal strength, which measured modes put together: hit softly and hard, and compare";
const NO_START: &str = "no start led anywhere";

/// Every effect that is in no hypothesis.
pub(super) fn not_tested(inquiry: &Inquiry, all: &[Judged]) -> Vec<NotTested> {
    let Some(base) = all.first() else { return vec![] };
    let predictor = inquiry.problem(&base.hypothesis).predictor;
    let tried = |id: &str| all.iter().any(|judged| judged.hypothesis.parts.iter().any(|part| part.effect.id() == id));
    let missing = catalogue().iter().filter(|effect| !tried(effect.id()));
    let told =
        |effect: &&'static dyn Effect| NotTested { id: effect.id(), reason: reason(inquiry, predictor, *effect) };
    missing.map(told).collect()
}

fn reason(inquiry: &Inquiry, predictor: &Predictor, effect: &dyn Effect) -> String {
    if !inquiry.can_show(effect) {
        return ONE_RECORD.to_owned();
    }
    let piece = predictor.piece();
    let value = |parameter: &EffectParameter| {
        parameter.held_at.or_else(|| parameter.starts(piece).first().copied()).unwrap_or_default()
    };
    let values: Vec<f64> = effect.parameters().iter().map(value).collect();
    let mut setting = predictor.setting(0);
    setting.record.suspension_motion = SuspensionMotion::InTime;
    match effect.act(&values, &setting) {
        Err(error) => error.to_string(),
        Ok(actions) if actions.is_empty() => BY_LEVEL.to_owned(),
        Ok(actions) if actions.iter().any(|action| matches!(action, Action::Core(_) | Action::Plate(_))) => {
            OTHER_MODES.to_owned()
        }
        Ok(_) => NO_START.to_owned(),
    }
}
