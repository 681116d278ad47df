//! Hits of another strength: what is linear answers to them alike.

use num_complex::Complex64;

use super::Further;
use crate::tracing::fit::Fit;
use crate::tracing::hypothesis::CUBIC;
use crate::tracing::ranking::Search;

/// How much harder.
const HARDER: f64 = 2.0;

/// Hits [`HARDER`] times as hard at the places of this test; none where a model refuses them.
///
/// The motion under hits c times as hard on springs $k_3w^3$ is that under these hits on springs $c^2k_3$, times c.
pub(super) fn harder(search: &Search, chosen: &Fit, rivals: &[&Fit]) -> Vec<Further> {
    let problem = search.records.problem(1);
    let lines = |fit: &Fit| {
        let mut state = fit.state.clone();
        let springs = state.hypothesis.effects.iter_mut().filter(|on| on.effect.id() == CUBIC);
        springs.flat_map(|on| on.values.first_mut()).for_each(|k3| *k3 *= HARDER * HARDER);
        problem.lines(&state).ok()
    };
    let apart = |one: &[Vec<Complex64>], other: &[Vec<Complex64>]| {
        let (mut apart, mut count) = (0.0, 0_usize);
        for ((one, other), record) in one.iter().zip(other).zip(problem.records) {
            let pairs = one.iter().zip(other).zip(&record.variance);
            apart += pairs.map(|((a, b), variance)| HARDER * HARDER * (a - b).norm_sqr() / variance).sum::<f64>();
            count += record.s.len();
        }
        (apart / count.max(1) as f64).sqrt()
    };
    let Some(one) = lines(chosen) else { return vec![] };
    let each = rivals.iter().map(|rival| lines(rival).map_or(f64::NAN, |other| apart(&one, &other)));
    vec![Further { words: format!("hit {HARDER:.0} times as hard, at the same places"), apart: each.collect() }]
}
