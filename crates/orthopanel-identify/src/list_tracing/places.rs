//! What a list tells of an effect that may sit elsewhere as well.
//!
//! A resonator near one mode is told by how far it drives that mode and its own apart, which goes as $m\phi_n^2(x)$: a small mass at an
//! antinode does what a larger one does near a node, and the other modes tell the two apart weakly. The curvature at one minimum does
//! not know of the others. So the fit is made anew with the place held at points along the piece, and each parameter's interval reaches
//! over all places where the criterion stands no more than $1.96^2$ above its least (the profile likelihood: Venzon and Moolgavkar,
//! Applied Statistics 37 (1988) 87).

use rayon::prelude::*;

use super::bounds;
use super::hypothesis::FreeParameter;
use super::list_fit::{INTERVAL, ListFit, fit};
use super::list_problem::ListProblem;
use super::start_grid::along;

/// Difference of what two minima miss that are one.
const SAME: f64 = 1e-3;
/// Places along each hump of the highest listed mode.
const ON_A_HUMP: usize = 3;

/// The last effect's place, which a search moves.
#[derive(Clone, Copy)]
pub(super) struct PlaceOf {
    /// The effect among those of the hypothesis.
    pub effect: usize,
    pub place: FreeParameter,
}

/// The fit with intervals over every place where the effect does as well. Where another parameter lies on its bound, and none does at
/// another minimum that is as good, that one is taken: a bound tells nothing.
pub(super) fn over_places(problem: &ListProblem, found: ListFit, of: PlaceOf) -> ListFit {
    let as_good = |fit: &&ListFit| fit.missed() < found.most();
    let mut minima: Vec<&ListFit> = [&found].into_iter().chain(&found.other_minima).filter(as_good).collect();
    minima.dedup_by(|later, kept| later.missed() - kept.missed() < SAME);
    let mut held: Vec<ListFit> = minima.par_iter().flat_map(|from| of.held_at_each(problem, from)).collect();
    held.extend(minima.into_iter().skip(1).cloned());
    let is_on_bound = |fit: &ListFit| bounds::on_bound(&fit.hypothesis, of.effect, &problem.largest_piece()).is_some();
    let mut best = found;
    if let Some(lower) = least(&held, |fit| fit.missed() < best.missed()) {
        best = of.freed(problem, lower).unwrap_or(best);
    }
    let most = best.most();
    let alike: Vec<ListFit> = held.into_iter().filter(|fit| fit.missed() < most).collect();
    if is_on_bound(&best) {
        // A further search from there may slide to the bound again.
        let inside = least(&alike, |fit| !is_on_bound(fit) && of.is_free(fit)).cloned();
        best = inside.unwrap_or(best);
    }
    if !alike.is_empty() && !of.is_free(&best) {
        best = of.freed(problem, &best).unwrap_or(best);
    }
    for other in &alike {
        of.reach(problem, &mut best, other, most);
    }
    if !alike.is_empty() {
        end_at_bounds(&mut best, problem.constants.count());
        let places = || alike.iter().chain([&best]).map(|fit| of.at(fit));
        best.reaches = Some((places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max)));
    }
    best
}

/// No interval reaches further than both ends of what a number may be.
fn end_at_bounds(fit: &mut ListFit, constants: usize) {
    let each = fit.hypothesis.each_free().zip(fit.std.iter_mut().skip(constants));
    for ((on, free), std) in each {
        let (value, (low, high)) = (on.values[free.at], free.range);
        *std = std.min((value - low).max(high - value) / INTERVAL / free.slope(value));
    }
}

/// The one of these that misses the least.
fn least(fits: &[ListFit], of_these: impl Fn(&ListFit) -> bool) -> Option<&ListFit> {
    fits.iter().filter(|fit| of_these(fit)).min_by(|a, b| a.missed().total_cmp(&b.missed()))
}

impl PlaceOf {
    fn at(self, fit: &ListFit) -> f64 {
        fit.hypothesis.effects[self.effect].values[self.place.at]
    }

    /// The fits with the place held at points all along the piece but where `from` has it, each from where the one before ended; without
    /// those that the model refuses.
    fn held_at_each(self, problem: &ListProblem, from: &ListFit) -> Vec<ListFit> {
        let here = self.at(from);
        let (low, high) = self.place.range;
        let elsewhere = |x: &f64| *x != here && (!from.mirrored || *x * here >= 0.0);
        let places = along((low, high), ON_A_HUMP * problem.longest().max(1) + 1).into_iter().filter(elsewhere);
        let (mut left, right): (Vec<f64>, Vec<f64>) = places.partition(|&x| x < here);
        left.reverse();
        let outward = |places: Vec<f64>| {
            let (mut from, mut fits) = (from.clone(), Vec::new());
            for x in places {
                let mut hypothesis = from.hypothesis.clone();
                let on = &mut hypothesis.effects[self.effect];
                on.free.retain(|free| free.at != self.place.at);
                on.values[self.place.at] = x;
                if let Ok(found) = fit(problem, &hypothesis, from.constants(problem)) {
                    from = found.clone();
                    fits.push(found);
                }
            }
            fits
        };
        let (mut fits, right) = rayon::join(|| outward(left), || outward(right));
        fits.extend(right);
        fits
    }

    fn is_free(self, fit: &ListFit) -> bool {
        fit.hypothesis.effects[self.effect].free.iter().any(|free| free.at == self.place.at)
    }

    /// The same with the place free too, unless the model refuses it.
    fn freed(self, problem: &ListProblem, from: &ListFit) -> Option<ListFit> {
        let mut hypothesis = from.hypothesis.clone();
        if !self.is_free(from) {
            let free = &mut hypothesis.effects[self.effect].free;
            free.push(self.place);
            free.sort_by_key(|free| free.at);
        }
        let found = fit(problem, &hypothesis, from.constants(problem)).ok()?;
        Some(ListFit { mirrored: from.mirrored, ..found })
    }

    /// Widens the deviations of `best` until its intervals hold what `other` may be, up to where that one misses as much as `most`.
    fn reach(self, problem: &ListProblem, best: &mut ListFit, other: &ListFit, most: f64) {
        let room = ((most - other.missed()).max(0.0) / other.excess()).sqrt();
        let of_constants = problem.constants.count();
        let own = |fit: &ListFit, free: &FreeParameter, effect: usize| {
            let column = fit
                .hypothesis
                .each_free()
                .position(|(on, own)| std::ptr::eq(on, &fit.hypothesis.effects[effect]) && own.at == free.at);
            column.and_then(|column| fit.std.get(of_constants + column).copied()).filter(|std| std.is_finite())
        };
        let mut reached = Vec::new();
        for column in 0..of_constants {
            let apart = (other.parameters[column] - best.parameters[column]).abs();
            reached.push(apart + room * other.std.get(column).copied().filter(|std| std.is_finite()).unwrap_or(0.0));
        }
        for (effect, on) in best.hypothesis.effects.iter().enumerate() {
            for free in &on.free {
                let (here, there) = (on.values[free.at], other.hypothesis.effects[effect].values[free.at]);
                let std = own(other, free, effect).map_or(0.0, |std| std * free.slope(there));
                reached.push(((here - there).abs() + room * std) / free.slope(here));
            }
        }
        for (std, reach) in best.std.iter_mut().zip(reached) {
            *std = std.max(reach / INTERVAL);
        }
    }
}
