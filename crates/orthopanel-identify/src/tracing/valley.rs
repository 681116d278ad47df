//! Along a valley that bends: a search there comes down to its floor in a few steps and creeps on along it in thousands.

use super::fit::{LAST, polish};
use super::record_problem::State;
use super::records_of_test::TestRecords;
use super::starts::Costed;
use crate::least_squares::Ending;

/// Evaluations that bring a search from beside the floor down to it.
const DOWN: Ending = Ending::far(10, 0.2);
/// How much further than the last way each move goes, how much shorter it becomes where it fails, and how often that may be.
const FURTHER: f64 = 4.0;
const SHORTER: f64 = 0.25;
const MOST_FAILED: usize = 3;
/// Moves at most.
const MOST_MOVES: usize = 24;

/// Goes on from `end` the way that a search has come from `from`, each move several times as long as the last and down to the floor
/// from there, after Hooke and Jeeves (J. ACM 8, 1961): as far as the sum of squares falls, or to `enough`.
pub(super) fn along_the_valley(records: &TestRecords, from: &State, end: Costed, enough: f64) -> Costed {
    let problem = records.problem(LAST);
    let bounds = problem.bounds(&end.0);
    let (mut before, mut best) = (problem.parameters(from), end);
    let (mut further, mut failed) = (FURTHER, 0);
    for _ in 0..MOST_MOVES {
        if failed > MOST_FAILED || best.1 <= enough {
            break;
        }
        let here = problem.parameters(&best.0);
        let ahead: Vec<f64> = here
            .iter()
            .zip(&before)
            .zip(&bounds)
            .map(|((here, before), (low, high))| (here + further * (here - before)).clamp(*low, *high))
            .collect();
        match polish(records, &problem.state(&ahead, &best.0), LAST, DOWN) {
            Ok((state, cost)) if cost < best.1 => {
                (before, best, failed) = (here, (state, cost), 0);
                further = (2.0 * further).clamp(1.0, FURTHER);
            }
            _ => {
                further *= SHORTER;
                failed += 1;
            }
        }
    }
    best
}
