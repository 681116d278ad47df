//! What a fit says of data that it has not seen.

use faer::prelude::Solve;
use faer::{Mat, Side};

use super::fit::{Fit, by_group};
use super::record_problem::{Grouping, total};
use super::records_of_test::TestRecords;
use super::roughness::free_of;
use crate::IdentifyError;
use crate::least_squares::Quadratic;

/// Places from which leaving one out still leaves a test.
const LEAST_PLACES: usize = 3;

/// What is left out of a test to judge its fits: a pair of places where there are several, else a hit.
pub(super) fn grouping(records: &TestRecords) -> Grouping {
    if records.problem(0).records.len() >= LEAST_PLACES { Grouping::Places } else { Grouping::Hits }
}

/// Misfit of each group predicted from all others, squared, per datum, in units of the noise.
///
/// Without the group $k$ the minimum moves by $(N-N_k)^{-1}g_k$, and $c_k$ becomes $c_k + 2g_k\delta + \delta^TN_k\delta$: exact
/// for what is linear, and fits near their minimum are. A parameter that only the group itself tells, as a
/// record's own gain, goes back to where it has no effect.
///
/// # Errors
/// What the model refuses.
pub(super) fn held_out(records: &TestRecords, fit: &Fit, grouping: Grouping) -> Result<f64, IdentifyError> {
    let sums = by_group(records, fit, grouping)?;
    let whole = total(&sums);
    let Some((_, groups)) = sums.split_last() else { return Ok(f64::NAN) };
    let neutral = neutral_steps(fit);
    let own = |group: usize| if grouping == Grouping::Places { own_roughness(records, fit, group) } else { vec![] };
    let missed = groups.iter().enumerate().map(|(index, group)| {
        let foretold = foretold(&whole, group, &neutral);
        foretold.map_or(f64::INFINITY, |foretold| foretold.beside(&own(index)))
    });
    let missed: f64 = missed.sum();
    let problem = records.problem(usize::MAX);
    let hits = |hits: usize| if grouping == Grouping::Hits { hits } else { 1 };
    let data: usize = problem.records.iter().map(|record| 2 * record.s.len() * hits(record.hits.len())).sum();
    Ok(missed / data.max(1) as f64)
}

/// From each parameter to where its effect vanishes; none for constants and damping.
fn neutral_steps(fit: &Fit) -> Vec<f64> {
    let effects: Vec<f64> = fit
        .state
        .hypothesis
        .each_free()
        .map(|(switched, free)| {
            let value = switched.values[free.at];
            let name = switched.effect.parameters()[free.parameter].name;
            let none = if name == "gain" { 1.0 } else { 0.0 };
            let by = if free.record.is_some() || name == "gain" {
                free.coordinate(none) - free.coordinate(value)
            } else {
                0.0
            };
            if by.is_finite() { by } else { 0.0 }
        })
        .collect();
    let mut steps = vec![0.0; fit.parameters.len().saturating_sub(effects.len())];
    steps.extend(effects);
    steps
}

/// The roughness that is a record's own, by its places among the parameters, with its standard deviation beforehand.
fn own_roughness(records: &TestRecords, fit: &Fit, record: usize) -> Vec<(usize, f64)> {
    let Some(scales) = &records.rough else { return vec![] };
    let hypothesis = &fit.state.hypothesis;
    let first = fit.parameters.len().saturating_sub(hypothesis.size());
    let own = free_of(hypothesis).filter(|(_, free, _)| free.record == Some(record));
    own.map(|(at, free, _)| (first + at, scales.of(free.parameter))).collect()
}

/// A parameter of which the other groups hold less than this part is the group's own.
const OWN: f64 = 1e-6;

/// What a group costs where all others alone settle the parameters, to first order.
pub(super) fn predicted(whole: &Quadratic, group: &Quadratic, neutral: &[f64]) -> f64 {
    foretold(whole, group, neutral).map_or(f64::INFINITY, |foretold| foretold.beside(&[]))
}

/// A group's sum of squares where the others have settled the parameters.
struct Foretold<'a> {
    group: &'a Quadratic,
    cost: f64,
    /// Half of its derivative there.
    gradient: Vec<f64>,
}

impl Foretold<'_> {
    /// The cost where numbers of the group's own, which nothing else tells, have their standard deviations: that under the
    /// covariance $I + JPJ^T$, $c - g^T(N + P^{-1})^{-1}g$ by Woodbury's identity.
    fn beside(&self, own: &[(usize, f64)]) -> f64 {
        let mut cost = self.cost;
        if !own.is_empty() {
            let normal = Mat::from_fn(own.len(), own.len(), |i, j| {
                let beforehand = if i == j { own[i].1.powi(-2) } else { 0.0 };
                self.group.normal[(own[i].0, own[j].0)] + beforehand
            });
            let gradient = Mat::from_fn(own.len(), 1, |i, _| self.gradient[own[i].0]);
            let Ok(factor) = normal.llt(Side::Lower) else { return f64::INFINITY };
            cost -= (gradient.transpose() * factor.solve(&gradient))[(0, 0)];
        }
        cost.max(0.0)
    }
}

fn foretold<'a>(whole: &Quadratic, group: &'a Quadratic, neutral: &[f64]) -> Option<Foretold<'a>> {
    let size = neutral.len();
    let mut normal = &whole.normal - &group.normal;
    let mut gradient = Mat::from_fn(size, 1, |i, _| whole.gradient[i] - group.gradient[i]);
    for i in 0..size {
        if normal[(i, i)] < OWN * whole.normal[(i, i)] {
            for j in 0..size {
                normal[(i, j)] = 0.0;
                normal[(j, i)] = 0.0;
            }
            normal[(i, i)] = 1.0;
            gradient[(i, 0)] = -neutral[i];
        } else {
            // Directions that only the group tells stay where they are.
            normal[(i, i)] *= 1.0 + OWN;
        }
    }
    let step = normal.llt(Side::Lower).ok()?.solve(&gradient);
    let step: Vec<f64> = (0..size).map(|i| -step[(i, 0)]).collect();
    let slope: f64 = step.iter().zip(&group.gradient).map(|(a, b)| a * b).sum();
    let bent: Vec<f64> = (0..size).map(|i| (0..size).map(|j| group.normal[(i, j)] * step[j]).sum()).collect();
    let bend: f64 = step.iter().zip(&bent).map(|(a, b)| a * b).sum();
    let gradient = group.gradient.iter().zip(&bent).map(|(own, bent)| own + bent).collect();
    Some(Foretold { group, cost: group.cost + 2.0 * slope + bend, gradient })
}
