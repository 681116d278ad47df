//! What a fit says of data that it has not seen.

use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::prelude::Solve;
use faer::{Mat, Side};

use super::fit::{Fit, LAST, by_group};
use super::record_problem::{Grouping, total};
use super::records_of_test::TestRecords;
use super::rough::free_of;
use crate::IdentifyError;
use crate::least_squares::Quadratic;

/// Places from which leaving one out still leaves a test.
pub(super) const LEAST_PLACES: usize = 3;

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
    let by_places = grouping == Grouping::Places;
    let own = |group: usize| if by_places { own_roughness(records, fit, group) } else { vec![] };
    let above = if by_places { above_band(records, fit)? } else { vec![] };
    let missed = groups.iter().enumerate().map(|(index, group)| {
        let foretold = foretold(&whole, group, &neutral);
        foretold.and_then(|foretold| foretold.beside(&own(index), &above)).unwrap_or(f64::INFINITY)
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

/// The damping of modes above the band, by its places among the parameters. Other places tell it poorly, for it shows at a driving point
/// and hardly elsewhere, and it says nothing of the model: it stays free within what they tell.
fn above_band(records: &TestRecords, fit: &Fit) -> Result<Vec<usize>, IdentifyError> {
    let hypothesis = &fit.state.hypothesis;
    let in_band = if hypothesis.holds_plate() {
        let effects = hypothesis.states(records.problem(LAST).records.len())?;
        let modes = records.setup.summed_frequencies(&fit.state.constants.map(f64::exp), &effects)?;
        modes.iter().filter(|frequency| **frequency < records.band).count()
    } else {
        records.in_band
    };
    let first = fit.parameters.len().saturating_sub(hypothesis.size() + fit.state.zetas.len());
    Ok((in_band..fit.state.zetas.len()).map(|mode| first + mode).collect())
}

/// A parameter of which the other groups hold less than this part is the group's own.
const OWN: f64 = 1e-6;

/// What a group costs where all others alone settle the parameters, to first order.
pub(super) fn predicted(whole: &Quadratic, group: &Quadratic, neutral: &[f64]) -> f64 {
    foretold(whole, group, neutral).map_or(f64::INFINITY, |foretold| foretold.cost.max(0.0))
}

/// A group's sum of squares where the others have settled the parameters.
struct Foretold<'a> {
    group: &'a Quadratic,
    cost: f64,
    /// Half of its derivative there.
    gradient: Vec<f64>,
    /// How sure the others are of the parameters.
    others: Llt<f64>,
}

impl Foretold<'_> {
    /// The cost under the covariance $I + JPJ^T$, $c - g^T(N + P^{-1})^{-1}g$ by Woodbury's identity, where some numbers have the
    /// covariance $P$: those of the group's own, which nothing else tells, their standard deviations beforehand, and
    /// others what all other groups leave them. `None` where these tell nothing.
    fn beside(&self, own: &[(usize, f64)], left: &[usize]) -> Option<f64> {
        let size = own.len() + left.len();
        if size == 0 {
            return Some(self.cost.max(0.0));
        }
        let at = |i: usize| own.get(i).map_or_else(|| left[i - own.len()], |(at, _)| *at);
        let mut normal = Mat::from_fn(size, size, |i, j| self.group.normal[(at(i), at(j))]);
        for (i, (_, deviation)) in own.iter().enumerate() {
            normal[(i, i)] += deviation.powi(-2);
        }
        let covariance = self.others.inverse();
        let of_left = Mat::from_fn(left.len(), left.len(), |i, j| covariance[(left[i], left[j])]);
        let sure = of_left.llt(Side::Lower).ok()?.inverse();
        for i in 0..left.len() {
            for j in 0..left.len() {
                normal[(own.len() + i, own.len() + j)] += sure[(i, j)];
            }
        }
        let gradient = Mat::from_fn(size, 1, |i, _| self.gradient[at(i)]);
        let taken = gradient.transpose() * normal.llt(Side::Lower).ok()?.solve(&gradient);
        Some((self.cost - taken[(0, 0)]).max(0.0))
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
    let others = normal.llt(Side::Lower).ok()?;
    let step = others.solve(&gradient);
    let step: Vec<f64> = (0..size).map(|i| -step[(i, 0)]).collect();
    let slope: f64 = step.iter().zip(&group.gradient).map(|(a, b)| a * b).sum();
    let bent: Vec<f64> = (0..size).map(|i| (0..size).map(|j| group.normal[(i, j)] * step[j]).sum()).collect();
    let bend: f64 = step.iter().zip(&bent).map(|(a, b)| a * b).sum();
    let gradient = group.gradient.iter().zip(&bent).map(|(own, bent)| own + bent).collect();
    Some(Foretold { group, cost: group.cost + 2.0 * slope + bend, gradient, others })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// $\sum_i(a_ix + b_iy - c_i)^2$ about $x = y = 0$.
    fn sum(rows: &[[f64; 3]]) -> Quadratic {
        let mut sum = Quadratic::zero(2);
        rows.iter().for_each(|[a, b, c]| sum.add_row(-c, &[(0, *a), (1, *b)]));
        sum.mirror();
        sum
    }

    /// Where all that others leave open may follow the group, it costs what the group adds to the minimum of all.
    #[test]
    fn val_what_others_leave_open_is_left_to_the_group() {
        let group = sum(&[[1.0, 0.2, 0.5], [0.3, 2.0, -0.7], [0.1, 1.0, 0.4]]);
        let others = sum(&[[2.0, 0.1, 1.0], [1.0, -0.1, 0.2], [0.5, 0.05, 0.9]]);
        let whole = total(&[group.clone(), others.clone()]);
        let least = |of: &Quadratic| {
            let gradient = Mat::from_fn(2, 1, |i, _| of.gradient[i]);
            let step = of.normal.llt(Side::Lower).unwrap().solve(&gradient);
            of.cost - (gradient.transpose() * step)[(0, 0)]
        };
        let foretold = foretold(&whole, &group, &[0.0; 2]).unwrap();
        let added = least(&whole) - least(&others);
        let found = foretold.beside(&[], &[0, 1]).unwrap();
        assert!((found / added - 1.0).abs() < 1e-5, "{found} {added}");
        // With one of the two held to what others say it costs more, and with both the most.
        let one = foretold.beside(&[], &[1]).unwrap();
        let none = foretold.beside(&[], &[]).unwrap();
        assert!(added < one && one < none, "{added} {one} {none}");
    }
}
