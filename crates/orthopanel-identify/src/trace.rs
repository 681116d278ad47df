//! Closing the loop: the effect that the base model lacks, by name.

use orthopanel_data::{ImpactTest, Measurement};
use orthopanel_model::EXPONENTIAL_WINDOW;

use crate::accelerance_fit::{has_record_apart, question_of_window, refuse_missed, refuse_records};
use crate::answer::{answer, answer_of_lists, without_repeats};
use crate::entry::{identify_without_contradicting, records_alone};
use crate::inference::{Correct, refuse_several};
use crate::measured::is_record;
use crate::outcome::{Progress, Tracing, Verdict};
use crate::reference::without_shared_error;
use crate::to_check::{times_the_noise, to_check};
use crate::{IdentifyError, Settings};

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
/// Lists of natural frequencies are measured modes without residues: their numbers match them with the modes of a beam, their shapes or their
/// frequencies with those of a plate. Records and lists of one piece or of several
/// are judged together: pieces share effects and the constants that are not their own; beside lists of other pieces an effect at a place is on the piece
/// that was hit; and what the model misses of a mode of a piece is the same in all that was measured of it.
///
/// # Limits
/// Records are those of beams, which may turn out plates, hit and seen on the centre line, or of declared plates, hit and seen anywhere. Where several pieces were hit, effects at a place and those
/// of one record are not looked for. Standard deviations hold the sizes of model
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
/// What [`identify`](crate::identify()) refuses of the records themselves, such as too few resonances or [`IdentifyError::OtherUnits`]; lists of a plate that no
/// plate meets; and tests that this version cannot trace.
pub fn trace(test: &ImpactTest) -> Result<Tracing, IdentifyError> {
    trace_with(test, &|_| {})
}

/// [`trace`], telling how far it is. The callback is called from several threads.
///
/// # Errors
/// As [`trace`].
pub fn trace_with(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    trace_corrected(test, None, progress)
}

/// What a suspect panel has that a sound one of the same make has not: [`trace_with`], with what the model misses of the natural frequencies of the
/// `reference` removed from those of the suspect, mode by mode.
///
/// With $y$ the logarithms of the measured frequencies, $f$ the model, $\theta$ its constants and $\delta$ what the suspect alone has,
/// $$y - \big(y_\text{ref} - f(\hat\theta_\text{ref}, 0)\big) = f(\theta, \delta) + e'$$
/// holds the error $e'$ alone that the two do not share, whose size is estimated as ever. [`Tracing::shared_model_error`] tells how much that took off.
/// Poles are matched by frequency and shape, so that the places of the two tests may differ; those of lists by their number.
///
/// # Errors
/// As [`trace`]; [`IdentifyError::OfReference`] for what the reference's own test refuses, [`IdentifyError::OtherPanel`] for a reference of another
/// structure or boundary, of several pieces, or with fewer than three of the suspect's modes.
pub fn trace_against(
    test: &ImpactTest,
    reference: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Tracing, IdentifyError> {
    trace_corrected(test, Some(&|comparison| without_shared_error(reference, test, comparison)), progress)
}

fn trace_corrected(
    test: &ImpactTest,
    correct: Option<Correct>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Tracing, IdentifyError> {
    if !test.measurements.iter().any(is_record) {
        return answer_of_lists(test, correct, progress)?.finite();
    }
    refuse_several(test)?;
    let records = records_alone(test);
    refuse_records(&records)?;
    let (once, repeated) = without_repeats(test);
    let traced = answer(&once, correct, progress).and_then(Tracing::finite);
    let mut found = match beside_identify(test, &records, traced)? {
        Beside::Traced(found) => *found,
        Beside::Contradicting { rest, said } => {
            let mut found = trace_corrected(&rest, correct, progress)?;
            found.notes.insert(0, said);
            return Ok(found);
        }
    };
    found.notes.extend(repeated);
    Ok(match question_of_window(&records) {
        Some(question) => asked_of_window(found, question),
        None => found,
    })
}

/// Before records say what lacks, the window is asked about that they may have been averaged under: free damping takes up most of it.
fn asked_of_window(mut found: Tracing, question: String) -> Tracing {
    if found.effects.iter().all(|effect| effect.id != EXPONENTIAL_WINDOW) {
        // What explained nothing stands beside a window that may explain it.
        if found.verdict == Verdict::Unexplained {
            found.effects.clear();
        }
        found.verdict = Verdict::Ambiguous;
        found.alternatives.retain(|id| id != EXPONENTIAL_WINDOW);
        found.alternatives.insert(0, EXPONENTIAL_WINDOW.to_owned());
        found.next_experiment = question.clone();
    }
    found.notes.insert(0, question);
    found
}

/// What a trace is beside `identify`.
enum Beside {
    Traced(Box<Tracing>),
    /// One record contradicts the others: the test without it, and what is said of it.
    Contradicting {
        rest: Box<ImpactTest>,
        said: String,
    },
}

/// A trace that leaves much of the records without an explanation, beside what `identify` says of them: records that it refuses have no effect, but a
/// line of the test file that is wrong. Where most of the motion is missed, whatever the effect, nothing is named, though the modes that the records
/// show may be explained: `unexplained` stands beside the refusal.
fn beside_identify(
    test: &ImpactTest,
    records: &ImpactTest,
    traced: Result<Tracing, IdentifyError>,
) -> Result<Beside, IdentifyError> {
    let missed = |found: &Tracing| refuse_missed(test, &found.accelerances).err();
    let is_clear =
        |found: &Tracing| found.verdict != Verdict::Unexplained && !has_record_apart(&found.base_accelerances);
    let missed = match &traced {
        Ok(found) => match missed(found) {
            None if is_clear(found) => return traced.map(|found| Beside::Traced(Box::new(found))),
            Some(factor @ IdentifyError::OtherUnits { .. }) => return Err(factor),
            missed => missed,
        },
        Err(_) => None,
    };
    let refused = match identify_without_contradicting(records, Settings::default()) {
        Err(refused) if refused.is_of_records() => return Err(refused),
        Ok((found, Some(left))) => {
            let is_left =
                |of: &Measurement| !is_record(of) || left.measurements.iter().any(|other| other.data == of.data);
            let mut rest = test.clone();
            rest.measurements.retain(is_left);
            return Ok(Beside::Contradicting {
                rest: Box::new(rest),
                said: found.notes.into_iter().next().unwrap_or_default(),
            });
        }
        identified => identified.err(),
    };
    let mut found = traced?;
    if let Some(missed) = missed {
        let refused = refused.unwrap_or(missed);
        if found.verdict != Verdict::Unexplained {
            found.verdict = Verdict::Unexplained;
            found.error.after = found.error.before;
            found.chi_square = found.error.after.fitted.powi(2);
            found.accelerances.clone_from(&found.base_accelerances);
            found.next_experiment = to_check(test, &times_the_noise(found.error.after.fitted));
        }
        found.effects.clear();
        found.removed.clear();
        found.alternatives.clear();
        found.notes.insert(0, format!("identify refuses these records: {refused}"));
    }
    Ok(Beside::Traced(Box::new(found)))
}
