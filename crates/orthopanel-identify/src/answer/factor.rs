//! A factor on all records, far outside of what calibrated chains leave.

use orthopanel_data::ImpactTest;
use orthopanel_model::{Estimate, GAIN, Owner};

use super::estimates::Estimates;
use super::weighed::Weighed;
use crate::AcceleranceFit;
use crate::accelerance_fit::{common_gain, said_of_gain};
use crate::outcome::Verdict;
use crate::search::Inquiry;
use crate::traced_effect::{TracedEffect, TracedParameter};

/// What is said of it.
pub(super) struct Factor {
    pub sentence: String,
    /// What is to be done next, where that is clear.
    pub next: Option<String>,
    /// The effect where the judge did not name it: one record does not part it from an oblique hit, and a calibrated chain does.
    pub effect: Option<TracedEffect>,
}

impl Factor {
    /// Of the chosen hypothesis and its `curves`; beside a declared factor, that one is doubted. The verdict goes with it.
    pub(super) fn of(
        test: &ImpactTest,
        inquiry: &Inquiry,
        weighed: &mut Weighed,
        curves: &[AcceleranceFit],
    ) -> Option<Self> {
        let only_sentence = |sentence: String| Self { sentence, next: None, effect: None };
        if !weighed.chosen.names().is_empty() {
            let gain = Estimates::of(weighed.chosen).undeclared().into_iter().find(|effect| effect.id == GAIN)?;
            return Some(only_sentence(said_of_gain(*gain.parameters.first()?.values.first()?, test)));
        }
        let modes = inquiry.stacked.hit().map(|(_, hit)| hit.comparison().measured.poles.len()).sum();
        let gain = common_gain(curves, modes)?;
        if let Some(declared) = test.effects.iter().find(|effect| effect.id == GAIN) {
            let declared = declared.parameters.get("gain")?;
            let sentence = format!(
                "the declared gain may have a wrong number: gain = {:.4e} in place of {declared:.4e}",
                gain.value * declared
            );
            weighed.verdict = Verdict::Unexplained;
            let next = Some(format!("check the numbers of what is declared ({GAIN}): {sentence}"));
            return Some(Self { next, ..only_sentence(sentence) });
        }
        let sentence = only_sentence(said_of_gain(gain, test));
        let is_near = weighed.alternatives().iter().any(|id| id == GAIN);
        if weighed.verdict != Verdict::NothingMissing && !is_near {
            return Some(sentence);
        }
        weighed.near.retain(|judged| judged.names() != [GAIN]);
        weighed.verdict = if weighed.near.is_empty() { Verdict::Explained } else { Verdict::Ambiguous };
        let is_clear = weighed.verdict == Verdict::Explained;
        let next = is_clear.then(|| "none: the factor on all records is known".to_owned());
        Some(Self { next, effect: Some(effect(gain)), ..sentence })
    }
}

fn effect(gain: Estimate) -> TracedEffect {
    let parameters = vec![TracedParameter { name: "gain", unit: "1", values: vec![gain] }];
    TracedEffect { id: GAIN, owner: Owner::Channel, parameters }
}
