//! What is said of a declared number that may be wrong, and of a declared effect that may not be there.

use crate::error::spaced;
use crate::judge::ODDS;
use crate::posterior::Judged;
use crate::search::Inquiry;

use super::estimates::Estimates;

/// A declared effect with other numbers than the file's that the measured modes ask for.
pub(super) struct Doubt {
    pub id: &'static str,
    /// The numbers that they ask for, with those of the file.
    pub sentence: String,
    /// Whether it is not clearly behind the likeliest hypothesis.
    pub is_rival: bool,
}

/// Each declared effect whose numbers, once free, are clearly ahead of the file's.
pub(super) fn doubts(inquiry: &Inquiry, base: &Judged, best: &Judged) -> Vec<Doubt> {
    let clearly = ODDS.ln();
    let doubted = inquiry.doubted(base).into_iter().filter(|(_, freed)| freed.log_odds > base.log_odds + clearly);
    let doubt = |(index, freed): (usize, Judged)| {
        let (declared, found) = (Estimates::of(base).effects, Estimates::of(&freed).effects);
        let pairs = declared[index].0.parameters.iter().zip(&found[index].0.parameters);
        let changed = pairs.filter_map(|(was, now)| {
            let (was, found) = (was.values.first()?.value, now.values.first()?);
            let (name, value, std, unit) = (now.name, found.value, found.std?, spaced(now.unit));
            Some(format!("{name} = {value:.4e} +- {std:.1e}{unit} in place of {was:.4e}"))
        });
        let (id, changed) = (declared[index].0.id, changed.collect::<Vec<_>>());
        Doubt {
            id,
            sentence: format!(
                "the declared {id} may have a wrong number: the logarithm of the odds is {:.1} better with {}",
                freed.log_odds - base.log_odds,
                changed.join(", ")
            ),
            is_rival: freed.log_odds > best.log_odds - clearly,
        }
    };
    doubted.map(doubt).collect()
}

/// A sentence on each declared effect without numbers that the measured modes are clearly likelier without: the numbers found are what a sound model's
/// error is taken for.
pub(super) fn notes_on_not_shown(inquiry: &Inquiry, base: &Judged) -> Vec<String> {
    let gain = |without: &Judged| without.log_odds - base.log_odds;
    let clearly = inquiry.left_out(base).into_iter().filter(|(_, without)| gain(without) > ODDS.ln());
    let note = |(index, without): (usize, Judged)| {
        let id = base.hypothesis.parts[index].effect.id();
        format!(
            "the data do not show the declared {id}: the logarithm of the odds is {:.1} better without it, whatever the numbers that are found for \
             it. Leave the effect out, or give its numbers",
            gain(&without)
        )
    };
    clearly.map(note).collect()
}

/// Weighing what is declared costs less than any hit, and no hit parts it from an effect of the panel that undoes it.
pub(super) fn check_first(doubt: &Doubt) -> String {
    format!("weigh or measure what the test file declares, before any further measurement: {}", doubt.sentence)
}
