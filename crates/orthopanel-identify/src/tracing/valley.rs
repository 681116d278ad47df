//! Along a valley that bends: a search there comes down to its floor in a few steps and creeps on along it in thousands.

use super::fit::{LAST, PATIENCE, polish};
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

/// Rounds on the narrowest lines that the best hypothesis may take beyond the first, and the gain that is worth another.
const MORE_ROUNDS: usize = 3;
const SETTLED: f64 = 1.0;
/// Rounds of a search that still goes down by this part: a core's valley beside a delay's is long.
const MOST_ROUNDS: usize = 8;
const STILL_FALLING: f64 = 0.05;
/// A round that falls by less than that and by more than this has crept along a valley's floor.
const CREEPING: f64 = 1e-4;

/// Follows one to its minimum: what others are held against must be what it can be.
pub(super) fn lead_on(records: &TestRecords, best: &mut Costed) {
    let enough = records.problem(LAST).data() as f64;
    for round in 0..MOST_ROUNDS {
        let worth = if round < MORE_ROUNDS { SETTLED } else { STILL_FALLING * best.1 };
        let Ok(next) = polish(records, &best.0, LAST, PATIENCE[LAST]) else { break };
        if next.1 >= best.1 - worth {
            break;
        }
        let (before, cost) = std::mem::replace(best, next);
        let fallen = 1.0 - best.1 / cost;
        if best.1 > enough && (CREEPING..STILL_FALLING).contains(&fallen) {
            *best = along_the_valley(records, &before, best.clone(), enough);
        }
    }
}

/// Goes on from `end` the way that a search has come from `from`, each move several times as long as the last and down to the floor
/// from there, after Hooke and Jeeves (J. ACM 8, 1961): as far as the sum of squares falls, or to `enough`.
fn along_the_valley(records: &TestRecords, from: &State, end: Costed, enough: f64) -> Costed {
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
            // What falls by less has left no way to go: the floor lies flat there, as where another effect is missing.
            Ok((state, cost)) if cost < best.1 * (1.0 - CREEPING) => {
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
