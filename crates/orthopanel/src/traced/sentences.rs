//! What a trace found, in sentences.

use orthopanel_identify::{Detectable, SharedModelError, TracedEffect, Verdict};

use super::Traced;
use crate::identified::to_digits;

/// How a next experiment begins that is none: the test file is likelier wrong than the model.
const CHECK_FIRST: &str = "before another measurement check";

impl Traced {
    /// The verdict in one plain sentence.
    pub fn verdict(&self) -> String {
        let tracing = &self.tracing;
        let named = names(&tracing.effects);
        match tracing.verdict {
            Verdict::NothingMissing => {
                "Nothing is missing: no effect of the catalogue makes up for the parameters it brings.".into()
            }
            Verdict::Explained => format!("The model lacked {named}, clearly ahead of every other effect."),
            Verdict::Ambiguous if tracing.effects.is_empty() => {
                let possible = match tracing.alternatives.is_empty() {
                    true => String::new(),
                    false => format!("; possible are {}", self.alternatives()),
                };
                format!("These data cannot tell whether something is missing{possible}. Next: {}.", tracing.next_experiment)
            }
            Verdict::Ambiguous if tracing.alternatives.is_empty() => {
                format!("The model lacked something: {named}; no other effect fits alike, but see the notes for what leaves a doubt.")
            }
            Verdict::Ambiguous => {
                format!("The model lacked something: {named}, but these fit alike: {}.", self.alternatives())
            }
            Verdict::Unexplained if tracing.next_experiment.starts_with(CHECK_FIRST) => {
                "The base model misses these data in a way that wrong sizes, places, mass or boundary make: check these before an \
                 effect is blamed."
                    .into()
            }
            Verdict::Unexplained if tracing.effects.is_empty() => {
                "Something is missing that no effect of the catalogue explains.".into()
            }
            Verdict::Unexplained => {
                format!("Something is missing that no effect of the catalogue explains; the nearest is {named}.")
            }
        }
    }

    /// By how much the model misses beside noise, where that was estimated.
    pub(crate) fn model_error(&self) -> Option<String> {
        let of = self.tracing.model_error?;
        let percent = |part: f64| format!("{} %", to_digits(100.0 * part, 2));
        let residues = of.residue.map_or(String::new(), |residue| format!(" and residues by {}", percent(residue)));
        Some(format!("Beside noise the model misses frequencies by {}{residues}.", percent(of.frequency)))
    }

    /// What a reference took off the model's error.
    pub(crate) fn shared_model_error(&self) -> Option<String> {
        let SharedModelError { modes, reference, suspect, suspect_less_reference } = self.tracing.shared_model_error?;
        let percent = |part: f64| format!("{} %", to_digits(100.0 * part, 2));
        let verdict = if suspect_less_reference < suspect {
            "the two panels share this error"
        } else {
            "the two panels do not share this error: trace without the reference"
        };
        Some(format!(
            "Against the reference: the model misses {modes} frequencies that both show by {} rms in the reference, by {} in the suspect, and by {} \
             once the former is removed from the latter: {verdict}.",
            percent(reference),
            percent(suspect),
            percent(suspect_less_reference)
        ))
    }

    /// From which size on a disbond would have been named.
    pub(crate) fn detectable(&self) -> Option<String> {
        let Detectable { loss, at_half_of_the_places, anywhere, places, most, .. } = self.tracing.detectable?;
        let whole = format!("A disbond that loses {:.0} % of the shear stiffness", 100.0 * loss);
        let millimetres = |side: f64| format!("{:.0} mm", 1e3 * side);
        Some(match (at_half_of_the_places, anywhere) {
            (None, _) => format!(
                "{whole} would show at fewer than half of {places} places looked at, up to {} wide.",
                millimetres(most)
            ),
            (Some(half), None) => format!(
                "{whole} would be named from {} on at half of {places} places looked at, and at some not even where it is {} wide.",
                millimetres(half),
                millimetres(most)
            ),
            (Some(half), Some(all)) => format!(
                "{whole} would be named from {} on at half of {places} places looked at, from {} on at all of them.",
                millimetres(half),
                millimetres(all)
            ),
        })
    }

    fn alternatives(&self) -> String {
        if self.tracing.alternatives.is_empty() { "none".into() } else { self.tracing.alternatives.join(", ") }
    }

    /// What the panel's model keeps of the effects found, and what was taken out and why.
    pub(crate) fn ownership(&self) -> Vec<String> {
        // Pieces have their effects in common.
        let mut kept: Vec<&str> = Vec::new();
        for effect in self.panels().unwrap_or_default().iter().flat_map(|panel| &panel.effects) {
            if !kept.contains(&&*effect.id) {
                kept.push(&effect.id);
            }
        }
        let kept = kept.into_iter().map(|id| format!("{id} stays in the model: it belongs to the panel."));
        let removed = self.taken_out().map(|of| format!("{} is taken out of the model: {}.", of.id, of.why));
        let found = &self.tracing.effects;
        let unfit = (!self.explains() && !found.is_empty())
            .then(|| format!("What was found goes into no model, for it does not explain the data: {}.", names(found)));
        kept.chain(removed).chain(unfit).collect()
    }
}

fn names(effects: &[TracedEffect]) -> String {
    effects.iter().map(|effect| effect.id).collect::<Vec<_>>().join(" and ")
}
