//! The other law of damping beside the one asked for: where it meets the records clearly better, that is said.

use orthopanel_model::Readable;

use super::recorded::Recorded;
use super::start::usual_log_zeta;
use crate::{DampingLaw, Identification, IdentifyError};

/// Misfit per datum above which the law asked for may be the wrong one.
const SUSPECT: f64 = 1.2;
/// The other law is clearly better where it leaves less than this part of the misfit,
const HALF: f64 = 0.5;
/// or little beside noise and less than this part.
const NEAR_NOISE: (f64, f64) = (1.2, 0.8);
/// Misfit per datum at which records that the law asked for contradicts are explained.
const EXPLAINED: f64 = 4.0;
/// The laws part between the peaks by the order of the damping ratio: records with less than this contradict a test file
/// for other reasons.
const MUCH_DAMPING: f64 = 0.005;

/// What was found under `law`, held beside what `under` finds with the other one.
///
/// # Errors
/// [`IdentifyError::OtherDamping`] in place of a refusal that the other law mends; else the refusal itself.
pub(super) fn beside_other_law(
    recorded: &Recorded,
    law: DampingLaw,
    under: impl Fn(DampingLaw) -> Result<Identification, IdentifyError>,
) -> Result<Identification, IdentifyError> {
    let other = law.other();
    match under(law) {
        Ok(mut found) => {
            let own = found.chi_square.filter(|own| *own > SUSPECT);
            let beside = own.and_then(|own| Some((own, under(other).ok()?.chi_square?)));
            if let Some((own, chi_square)) = beside.filter(|&(own, other)| is_clearly_less(other, own)) {
                found.notes.push(format!(
                    "{} damping meets the records better: chi-square per datum {:.2}, {:.2} with {} damping: \
                     give --damping {}",
                    other.name(),
                    Readable(chi_square),
                    Readable(own),
                    law.name(),
                    other.name()
                ));
            }
            Ok(found)
        }
        Err(refused) if refused.may_be_of_damping() && is_much_damped(recorded) => {
            let chi_square = under(other).ok().and_then(|found| found.chi_square).filter(|left| *left < EXPLAINED);
            Err(match chi_square {
                Some(chi_square) => IdentifyError::OtherDamping { asked: law.name(), other: other.name(), chi_square },
                None => refused,
            })
        }
        refused => refused,
    }
}

/// Whether one misfit per datum is so much less than another that it is another model's.
pub(super) fn is_clearly_less(other: f64, own: f64) -> bool {
    let (near, part) = NEAR_NOISE;
    other < HALF * own || (other < near && other < part * own)
}

fn is_much_damped(recorded: &Recorded) -> bool {
    let poles = || recorded.pieces.iter().flat_map(|piece| &piece.poles);
    poles().next().is_none() || usual_log_zeta(poles()).exp() > MUCH_DAMPING
}
