//! Identification by natural frequencies (eqs 22 and 24).

mod all_at_once;
mod changed_pairs;
mod doubtful_names;
mod far_from_list;
mod first_constants;
mod hidden_constants;
mod hidden_in_beams;
mod impossible_names;
mod likeliest_reading;
mod lone_lines;
mod minimum;
mod noise;
mod of_poles;
mod other_readings;
mod other_starts;
mod own_constants;
mod problem;
mod reading_evidence;
mod report;
mod seen_constants;
mod starting_values;
mod uncertainty;
mod unseen_constants;

#[cfg(test)]
mod tests;

use orthopanel_data::ImpactTest;

use crate::structures::Shown;
use crate::{Identification, IdentifyError, Search};
use minimum::minimise;
use problem::FrequencyProblem;

pub(crate) use likeliest_reading::{Reread, likeliest_reading};
pub(crate) use of_poles::{PoleFit, PoleSet, fit_poles};
pub(crate) use report::identified_constants;

/// Finds the elastic constants that minimise eq. 22,
/// $$Error(c) = \frac1M\sum_{m=1}^M\frac{(f_{exp}^{(m)}-f_{cal}^{(m)}(c))^2}{(f_{exp}^{(m)})^2},$$
/// over all natural-frequency measurements of the test; pieces share the constants, but for those that the test file
/// gives a piece of its own.
///
/// Starting values are found here. Both searches work on the logarithms of the moduli, so eq. 24's bounds hold.
/// Standard deviations come from $s^2(J^TJ)^{-1}$, where $s^2$ is the scatter of the residuals or the rounding to the
/// analyser's bins, whichever is larger; those of a plate, which may have many constants beside few frequencies, by Student's
/// factor more, so that 1.96 of them make a 95 % interval.
///
/// A plate has constants that bending modes alone do not show. Such a one rests at its usual value and is reported as not
/// identified.
///
/// # Errors
/// [`IdentifyError`]: too few frequencies, an unknown constant, no convergence, a constant on its bound, or a test that
/// this version cannot evaluate.
pub(crate) fn identify_frequencies(test: &ImpactTest, search: Search) -> Result<Identification, IdentifyError> {
    let mut problem = FrequencyProblem::of(test)?;
    let start = starting_values::starting_values(&problem)?;
    let mut doubts = Vec::new();
    let (found, not_identified) = match problem.structure.shown() {
        Shown::Wholly => {
            let found = minimise(&problem, &start, search)?;
            hidden_in_beams::minimum_where_shown(test, &mut problem, found, search)?
        }
        Shown::InPart => {
            let all = problem.constants.clone();
            let seen =
                seen_constants::minimise_what_is_seen(&mut problem, &start).map_err(|error| named(test, error))?;
            far_from_list::refuse_other_than_bending(test, &problem, &seen)?;
            // A list that all constants together meet is named rightly.
            let seen = match all_at_once::meets_at_once(&mut problem, &all, &seen) {
                Some(met) => met,
                None => {
                    doubts.extend(own_constants::met_with_an_own_constant(test, &problem, &seen));
                    if doubts.is_empty() {
                        let at = problem.linearised(&seen.predictions, &problem.constants);
                        doubts = doubtful_names::doubtful_names(test, &problem, &seen.parameters, &at)?;
                    }
                    if doubts.is_empty() { other_starts::from_other_starts(&mut problem, &all, seen) } else { seen }
                }
            };
            far_from_list::refuse_far_from_list(test, &problem, &seen, &doubts)?;
            let not_identified = unseen_constants::reports(&problem, &all, &seen);
            if search == Search::LeastSquares {
                problem.constants.refuse_bounds(&seen.parameters)?;
                return report::report(test, &problem, &seen.parameters, &seen.predictions, (not_identified, doubts));
            }
            (minimise(&problem, &seen.parameters, search)?, not_identified)
        }
    };
    problem.constants.refuse_bounds(&found)?;
    report::report(test, &problem, &found, &problem.predictions(&found)?, (not_identified, doubts))
}

/// A search without end, with the names of the lines that would have one.
fn named(test: &ImpactTest, error: IdentifyError) -> IdentifyError {
    let IdentifyError::NotConverged { iterations, error_percent } = error else { return error };
    if let Some(read) = far_from_list::read_as_bending(test) {
        return IdentifyError::FarFromList { error_percent, names: read };
    }
    match doubtful_names::names_with_a_minimum(test, error_percent) {
        Ok(names) if !names.is_empty() => {
            IdentifyError::DoubtfulNames { iterations, error_percent, names: names.join("; ") }
        }
        _ => error,
    }
}
