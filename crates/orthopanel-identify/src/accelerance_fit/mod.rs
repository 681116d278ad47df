//! Identification by accelerance: maximum likelihood over the whole complex band, or the paper's eq. 23.

mod band;
mod common_gain;
mod contradiction;
mod followed_modes;
mod force_window;
mod line_block;
mod line_group;
mod line_noise;
mod matching;
mod misfit;
mod mode_group;
mod other_law;
mod other_units;
mod outcome;
mod paper_deviations;
mod paper_error;
mod pole;
mod poles;
mod problem;
mod record_apart;
mod record_name;
mod recorded;
mod records;
mod resonance_fit;
mod resonance_point;
mod scale;
mod sharpening;
mod smeared;
mod smooth_part;
mod start;
mod starting_problem;
mod synthesis;
mod tied_noise;
mod told_damping;
mod undeclared_window;
mod weighted_rows;
mod whole_covariance;
mod wide_scan;

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::{EXPONENTIAL_WINDOW, Readable};

use crate::least_squares::Minimum;
use crate::structures::Shown;
use crate::{Identification, IdentifyError, Search, Settings};
use other_units::refuse_read_in_other_units;
use problem::is_far_from_noise;
use recorded::Recorded;
use records::PlaceRecord;
use sharpening::{Rough, line_by_line_with_noise, sharpened_lines};
use start::{Start, recorded_of, start};
use starting_problem::{assemble, starting_parameters};
use wide_scan::rough_starts;

pub(crate) use common_gain::{common_gain, refuse_missed, said_of_gain};
pub(crate) use contradiction::without_contradicting;
pub(crate) use line_noise::told_variance;
pub(crate) use other_units::refuse_other_units;
pub(crate) use record_apart::has_record_apart;
pub use synthesis::DampingLaw;

/// The question whether frequency responses were averaged under an exponential window that the test file does not declare, as
/// [`identify_records`] asks it of the panel without any effect; `None` where nothing looks like one, and of hits, which say themselves
/// how they were windowed.
pub(crate) fn question_of_window(test: &ImpactTest) -> Option<String> {
    let are_lines = |data: &MeasurementData| matches!(data, MeasurementData::Accelerance(_));
    let is_asked = test.measurements.iter().all(|measurement| are_lines(&measurement.data))
        && test.effects.iter().all(|on| on.id != EXPONENTIAL_WINDOW);
    if !is_asked {
        return None;
    }
    let bare = ImpactTest { effects: Vec::new(), ..test.clone() };
    identify_records(&bare, Settings::default()).ok()?.question
}

/// Refuses records that cannot be read, that a factor explains, or whose piece has sizes in another unit.
///
/// # Errors
/// [`IdentifyError::Data`], [`IdentifyError::OtherUnits`] and [`IdentifyError::PieceTooLarge`].
pub(crate) fn refuse_records(test: &ImpactTest) -> Result<(), IdentifyError> {
    recorded(test, Settings::default()).map(|_| ())
}

/// Reads the records of a test, and their poles off them.
fn recorded(test: &ImpactTest, settings: Settings) -> Result<Recorded, IdentifyError> {
    let accelerances = test.accelerances(settings.estimation)?;
    let recorded = recorded_of(test, &accelerances)?;
    refuse_read_in_other_units(test, &accelerances, &recorded)?;
    Ok(recorded)
}

/// Finds constants and damping from the records of a test.
///
/// 1. Poles are read off the resonances without a model, all places together.
/// 2. The constants whose modes meet the poles best are the start, with the poles' damping.
/// 3. Levenberg-Marquardt on the complex misfit of every line, over its noise:
///    $\min \sum |H_{cal}-H_{exp}|^2/\mathrm{var}$ over $\ln E_x$, $\ln G_{zx}$ and every $\ln\zeta_m$. Modes beyond
///    the band enter through their static part.
///
/// Where poles lead nowhere, a beam's constants are scanned over records made wide, and sharpened from there.
///
/// Standard deviations are $(J^TJ)^{-1}$, widened by the misfit per datum where that is above one. Where the model
/// misses the records by far more than their noise, a line by line fit would bend damping to make up for a wrong
/// frequency; then the constants come from the poles' frequencies, the damping from the poles, and a note says so.
/// Where the other law of damping meets the records clearly better, a note or the refusal names it.
pub(crate) fn identify_records(test: &ImpactTest, settings: Settings) -> Result<Identification, IdentifyError> {
    let recorded = recorded(test, settings)?;
    if settings.search == Search::Simplex {
        return by_papers_error(test, settings, &recorded);
    }
    other_law::beside_other_law(&recorded, settings.damping_law, |damping_law| {
        by_likelihood(test, Settings { damping_law, ..settings }, &recorded)
    })
}

fn by_likelihood(test: &ImpactTest, settings: Settings, recorded: &Recorded) -> Result<Identification, IdentifyError> {
    match start(recorded).and_then(|start| by_poles(test, settings, start)) {
        Err(refused)
            if recorded.structure.shown() == Shown::Wholly && !refused.is_of_model() && !refused.knows_the_place() =>
        {
            by_wide_records(test, settings, recorded).map_err(|wide| if wide.knows_the_band() { wide } else { refused })
        }
        other => other,
    }
}

/// Width, as a part of the frequency, from which records are sharpened where poles have told the constants.
const NEAR: f64 = 0.005;
/// What was reached that way is taken where it leaves no more than this beside the noise, per datum: the resonances did not
/// meet at first, and damping must not make up for it.
const EXPLAINED: f64 = 4.0;

/// Poles lead to constants, and these to a fit line by line, or to none.
fn by_poles(test: &ImpactTest, settings: Settings, start: Start) -> Result<Identification, IdentifyError> {
    let mut problem = assemble(&start, settings)?;
    let parameters = starting_parameters(&problem, &start);
    let mut fallback = parameters.clone();
    if start.resonances_meet() {
        // Lines tell far more than poles: what these do not show, lines may.
        let seen = problem.constants.clone();
        let all = problem.free_resting(&parameters);
        match line_by_line_with_noise(&mut problem, &all) {
            Some(minimum) if !is_far_from_noise(&problem, &minimum) => {
                return outcome::outcome(test, start, &mut problem, minimum);
            }
            Some(Minimum { parameters: found, .. }) => {
                let zetas = found.into_iter().skip(all.len() - parameters.len() + seen.count());
                fallback = parameters[..seen.count()].iter().copied().chain(zetas).collect();
            }
            None => {}
        }
        (problem.constants, problem.usual) = (seen, Vec::new());
    }
    if start.recorded.structure.shown() == Shown::Wholly {
        let rough = Rough::of(&problem, &parameters);
        let sharpened = sharpened_lines(start.recorded, settings.damping_law, rough, NEAR);
        if let Ok(Some((mut problem, minimum))) = sharpened
            && problem.noise_is_known()
            && problem.chi_square(minimum.at.cost) < EXPLAINED
        {
            let start = Start::at(start.recorded, &problem.constants, &minimum.parameters)?;
            return outcome::outcome(test, start, &mut problem, minimum);
        }
    }
    // What cannot be fitted line by line is judged by its resonances, and refused there if need be.
    outcome::from_poles(test, start, &mut problem, &fallback)
}

/// Constants scanned over records made wide, sharpened from there.
fn by_wide_records(
    test: &ImpactTest,
    settings: Settings,
    recorded: &Recorded,
) -> Result<Identification, IdentifyError> {
    let too_few = || IdentifyError::TooFewResonances {
        found: 0,
        needed: recorded.constants.count(),
        noise_percent: misfit::noise_percent(recorded.records()),
    };
    if recorded.records().all(PlaceRecord::is_mere_noise) {
        return Err(too_few());
    }
    let mut refused = None;
    for rough in rough_starts(recorded, settings.damping_law)? {
        let Some((mut problem, minimum)) = sharpened_lines(recorded, settings.damping_law, rough, wide_scan::WIDTH)?
        else {
            continue;
        };
        let start = Start::at(recorded, &problem.constants, &minimum.parameters)?;
        match outcome::outcome(test, start, &mut problem, minimum) {
            Ok(found) => return Ok(found),
            Err(error) if error.knows_the_band() => return Err(error),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    Err(refused.unwrap_or_else(too_few))
}

fn by_papers_error(
    test: &ImpactTest,
    settings: Settings,
    recorded: &Recorded,
) -> Result<Identification, IdentifyError> {
    if recorded.structure.shown() == Shown::InPart {
        let message = "the paper's search on records is for beams: leave out --search simplex";
        return Err(IdentifyError::Unsupported(message.to_owned()));
    }
    let start = start(recorded)?;
    let mut problem = assemble(&start, settings)?;
    let parameters = starting_parameters(&problem, &start);
    let (parameters, covariance) =
        paper_error::minimise(&problem, &start, test.boundary, &parameters, settings.paper_weights)?;
    let minimum = Minimum { at: problem.linearise(&parameters)?, parameters };
    let mut found = outcome::outcome_of_papers_error(test, start, &mut problem, minimum, covariance)?;
    if let Some(left) = found.chi_square.filter(|left| *left > PAPERS_MISFIT) {
        found.notes.push(format!(
            "the minimum of eq. 23 leaves {:.1} times the noise: it takes one frequency and one magnitude of each resonance, and \
             magnitudes, which it weighs most, tell little of the constants; leave out --search simplex, or give \
             --magnitude-weight 0",
            Readable(left)
        ));
    }
    Ok(found)
}

/// Misfit per datum from which another search would have found the records' own minimum elsewhere.
const PAPERS_MISFIT: f64 = 2.0;
