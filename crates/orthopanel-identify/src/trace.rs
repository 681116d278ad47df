//! Closing the loop: the effect that the base model lacks, by name.

use orthopanel_data::ImpactTest;
use orthopanel_model::{Estimate, Owner, StructureKind};

use crate::accelerance_fit::{WINDOW_EFFECT, question_of_window, refuse_missed};
use crate::answer::{answer, answer_of_lists, without_repeats};
use crate::entry::records_alone;
use crate::inference::{is_record, refuse_several};
use crate::outcome::{Progress, Removed, TracedEffect, TracedParameter, Tracing, Verdict};
use crate::to_check::to_check;
use crate::{IdentifyError, Settings, identify};

/// Names the effect that the base model of a test lacks, from its records or its natural frequencies. Effects that the test
/// file declares are part of the base model.
///
/// Records are brought to [`MeasuredModes`](crate::MeasuredModes) first, which know no physics. Every hypothesis, nothing missing, each effect of
/// the catalogue, and more of them while the evidence grows, predicts the same modes. What is measured less what is predicted has the covariance
/// $$C = C_\text{noise} + \sum_k\tau_k^2F_kF_k^T$$
/// of noise and of the model errors that every real panel has: of each frequency and residue, of places and gains, of core, faces and mass
/// along the panel. The sizes $\tau_k$ are estimated with the parameters $\theta$. Hypotheses are compared by the marginal likelihood
/// $$p(d) = \int p(d\mid\theta,\tau)\,p(\theta)\,p(\tau)\,d\theta\,d\tau$$
/// in Laplace's approximation (MacKay, Neural Computation 4, 1992), each effect lacking by itself with the prior odds of one to the size of the
/// catalogue. What shows between hits alone, `cubic-stiffness`, is held against the best of the other hypotheses.
///
/// Lists of natural frequencies are measured modes without residues: their numbers match them with the modes. Lists of several pieces, and lists beside
/// the records of one piece, are judged together: pieces share effects and the constants that are not their own; an effect at a place is on the piece
/// that was hit; and what the model misses of a mode of a piece is the same in all that was measured of it.
///
/// # Limits
/// Records are those of one piece, as a beam that may turn out a plate, hit and seen on its centre line. Standard deviations hold the sizes of model
/// error as they are estimated, not their own uncertainty, which makes them small where modes are few.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use orthopanel_identify::{Verdict, trace};
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/made-hits");
/// let found = trace(&orthopanel_data::ImpactTest::read(folder)?)?;
/// assert_eq!(found.verdict, Verdict::NothingMissing);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`IdentifyError::PlateNotTraced`] for a declared plate; what [`identify`] refuses of the records themselves, such as too few
/// resonances or [`IdentifyError::OtherUnits`]; and tests that this version cannot trace.
pub fn trace(test: &ImpactTest) -> Result<Tracing, IdentifyError> {
    trace_with(test, &|_| {})
}

/// [`trace`], telling how far it is. The callback is called from several threads.
///
/// # Errors
/// As [`trace`].
pub fn trace_with(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    beside_identify(test, |identified| {
        let found = of_data(test, progress)?.finite()?;
        Ok(match &identified.question {
            Some(question) => asked_of_window(found, question.clone()),
            None => found,
        })
    })
}

fn of_data(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    if !test.measurements.iter().any(is_record) {
        return answer_of_lists(test, progress);
    }
    let (once, repeated) = without_repeats(test);
    let mut found = answer(&once, progress)?;
    found.notes.extend(repeated);
    Ok(found)
}

/// Before records say what lacks, the window is asked about that they may have been averaged under: free damping takes up most of it.
fn asked_of_window(mut found: Tracing, question: String) -> Tracing {
    if found.effects.iter().all(|effect| effect.id != WINDOW_EFFECT) {
        // What explained nothing stands beside a window that may explain it.
        if found.verdict == Verdict::Unexplained {
            found.effects.clear();
        }
        found.verdict = Verdict::Ambiguous;
        found.alternatives.retain(|id| id != WINDOW_EFFECT);
        found.alternatives.insert(0, WINDOW_EFFECT.to_owned());
        found.next_experiment = question.clone();
    }
    found.notes.insert(0, question);
    found
}

/// What `identify` says of a test before its trace.
#[derive(Default)]
struct Identified {
    /// Why the model without what it may lack is refused.
    refused: Option<IdentifyError>,
    question: Option<String>,
    /// On all records, with the sentence on it.
    gain: Option<(Estimate, String)>,
}

/// A trace beside what `identify` says: records that it refuses have no effect, but a line of the test file that is wrong. Where most of the
/// motion is missed, whatever the effect, nothing is named, though the modes that the records show may be explained: `unexplained` stands beside
/// the refusal.
fn beside_identify(
    test: &ImpactTest,
    traced: impl FnOnce(&Identified) -> Result<Tracing, IdentifyError>,
) -> Result<Tracing, IdentifyError> {
    let identified = identified(test)?;
    let mut found = traced(&identified)?;
    match refuse_missed(test, &found.accelerances) {
        Ok(()) => Ok(match identified.gain {
            Some((gain, said)) => with_gain(found, declared_gain(test), (gain, said)),
            None => found,
        }),
        Err(factor @ IdentifyError::OtherUnits { .. }) => Err(factor),
        Err(missed) => {
            let refused = identified.refused.unwrap_or(missed);
            if found.verdict != Verdict::Unexplained {
                found.verdict = Verdict::Unexplained;
                found.error.after = found.error.before;
                found.chi_square = found.error.after.fitted.powi(2);
                found.accelerances.clone_from(&found.base_accelerances);
                found.next_experiment = to_check(test, found.error.after.fitted);
            }
            found.effects.clear();
            found.removed.clear();
            found.alternatives.clear();
            found.notes.insert(0, format!("identify refuses these records: {refused}"));
            Ok(found)
        }
    }
}

fn identified(test: &ImpactTest) -> Result<Identified, IdentifyError> {
    // The base is a beam: of a plate it would judge another model than the one that the file declares.
    if test.structure == Some(StructureKind::MindlinPlate) {
        return Err(IdentifyError::PlateNotTraced);
    }
    if !test.measurements.iter().any(is_record) {
        return Ok(Identified::default());
    }
    refuse_several(test)?;
    let records = records_alone(test);
    match identify(&records, Settings::default()) {
        Ok(found) => {
            let said = found.notes.first().cloned().unwrap_or_default();
            Ok(Identified { refused: None, question: found.question, gain: found.common_gain.map(|gain| (gain, said)) })
        }
        Err(refused) if refused.is_of_records() => Err(refused),
        Err(refused) => Ok(Identified { refused: Some(refused), question: question_of_window(&records), gain: None }),
    }
}

/// The number of a gain that the test file declares.
fn declared_gain(test: &ImpactTest) -> Option<f64> {
    let declared = test.effects.iter().find(|effect| effect.id == GAIN)?;
    declared.parameters.get("gain").copied()
}

/// A factor on all records is said first, and named where nothing else lacks clearly; beside a declared one, that one is doubted.
fn with_gain(mut found: Tracing, declared: Option<f64>, (gain, said): (Estimate, String)) -> Tracing {
    if let Some(declared) = declared {
        let sentence = format!(
            "the declared gain may have a wrong number: gain = {:.4e} in place of {declared:.4e}",
            gain.value * declared
        );
        found.verdict = Verdict::Unexplained;
        found.effects.clear();
        found.next_experiment = format!("check the numbers of what is declared ({GAIN}): {sentence}");
        found.notes.insert(0, sentence);
        return found;
    }
    found.notes.insert(0, said);
    let is_likely = found.verdict == Verdict::NothingMissing || found.alternatives.iter().any(|id| id == GAIN);
    if found.effects.is_empty() && is_likely {
        let parameters = vec![TracedParameter { name: "gain", unit: "1", values: vec![gain] }];
        let effect = TracedEffect { id: GAIN, owner: Owner::Channel, parameters };
        found.alternatives.retain(|id| id != GAIN);
        found.verdict = if found.alternatives.is_empty() { Verdict::Explained } else { Verdict::Ambiguous };
        if found.verdict == Verdict::Explained {
            // What was in doubt is not any more.
            found.notes.retain(|note| !note.starts_with(&format!("{GAIN} is ahead of ")));
            found.next_experiment = "none: the factor on all records is known".to_owned();
        }
        found.removed.push(Removed::of(&effect, false));
        found.effects.push(effect);
    }
    found
}

const GAIN: &str = "gain";
