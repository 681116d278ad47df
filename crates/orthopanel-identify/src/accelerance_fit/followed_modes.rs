//! The constants of a plate from its resonances alone: which mode each of them is follows from the constants found so far.
//!
//! At the constants of a usual panel a mode may lie a third beside its resonance, as the one across a plate whose $E_y$ is
//! half its $E_x$, and the neighbours lie nearer. So pairs are made far and wide at first, by shape as much as by frequency;
//! all constants move at once, those that no pair moves held near what is usual; and pairs are made anew after each step,
//! nearer and nearer.

use faer::prelude::Solve;
use faer::{Mat, Side};
use orthopanel_model::ModelError;
use rayon::prelude::*;

use super::matching::{Matching, PiecePoles, REACH, likeness, match_within};
use crate::IdentifyError;
use crate::free_constants::{FreeConstant, FreeConstants, Rest};
use crate::frequency_fit::PoleFit;
use crate::least_squares::Quadratic;
use crate::usual_ratios::BesideUsual;

/// Rounds, far to near: a pole further than this from every mode belongs to none, and one that misses by more than the scatter
/// counts for less.
const FAR_ROUNDS: [(f64, f64); 3] = [(0.35, 0.1), (0.2, 0.05), (0.1, 0.02)];
const NEAR_ROUNDS: [(f64, f64); 2] = [(REACH, 5e-3), (REACH, 1e-3)];
/// Steps of a round, at most; one of less than this ends it.
const STEPS: usize = 6;
const SMALL_STEP: f64 = 1e-4;
/// No parameter moves further in one step.
const LONGEST_STEP: f64 = 0.3;
/// How often a step is halved where the law would be indefinite.
const HALVINGS: usize = 6;
/// $E_y/E_x$ and $G_{yz}/G_{zx}$ from which is begun beside the usual ones, in turn.
const BESIDE: [[f64; 2]; 5] = [[1.0, 1.0], [0.5, 1.0], [2.0, 1.0], [1.0, 0.5], [1.0, 2.0]];
/// Relative error of a frequency, at least: that of the basis.
const BASIS_ERROR: f64 = 1e-4;
/// A constant is seen where the resonances leave less than this part of what was open.
const SEEN: f64 = 0.5;

/// The best of what the starts lead to: constants of all pieces, the mode of each pole, and which constants the poles show.
pub(super) fn follow(
    poles: &[PiecePoles],
    constants: &FreeConstants,
    starts: Vec<Matching>,
) -> Result<Option<(Matching, PoleFit)>, IdentifyError> {
    let position = |name: &str| constants.constants.iter().position(|constant| constant.name == name);
    let moved = [position("e_y"), position("g_yz")];
    let begun = |start: &Matching| -> Vec<Vec<f64>> {
        let Some(values) = start.values.first() else { return Vec::new() };
        let beside = |factors: &[f64; 2]| {
            let mut values = values.clone();
            for (constant, factor) in moved.iter().flatten().zip(factors) {
                values[*constant] *= factor;
            }
            let of = |(index, free): (usize, &FreeConstant)| constants.parameter(index, values[free.constant]);
            constants.free.iter().enumerate().map(of).collect()
        };
        BESIDE.iter().map(beside).collect()
    };
    let begun: Vec<Vec<f64>> = starts.iter().flat_map(begun).collect();
    let far = begun.into_par_iter().map(|start| {
        let end = Following::from(poles, constants, &start).far(start.clone());
        (start, end)
    });
    let (likely, mut refused) = likely(far.collect());
    let ends = likely.into_par_iter().map(|(start, from)| Following::from(poles, constants, &start).near(from));
    let mut best: Option<(Matching, Vec<f64>)> = None;
    for end in ends.collect::<Vec<_>>() {
        match end {
            Ok(end) if best.as_ref().is_none_or(|(least, _)| end.0.charge < least.charge) => best = Some(end),
            Ok(_) => {}
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    let Some((matching, parameters)) = best else { return refused.map_or(Ok(None), |error| Err(error.into())) };
    let fit = Following::from(poles, constants, &parameters).what_is_seen(&matching, parameters);
    Ok(Some((matching, fit)))
}

/// Ends of far rounds that are followed near, and how far apart in any parameter two of them lie at least.
const LIKELY: usize = 4;
const APART: f64 = 0.01;

/// The likeliest ends of the far rounds, each with its start, and the first refusal.
#[expect(clippy::type_complexity, reason = "starts and ends, taken apart at once")]
fn likely(
    far: Vec<(Vec<f64>, Result<(Matching, Vec<f64>), ModelError>)>,
) -> (Vec<(Vec<f64>, Vec<f64>)>, Option<ModelError>) {
    let mut refused = None;
    let mut ends = Vec::new();
    for (start, end) in far {
        match end {
            Ok((matching, parameters)) => ends.push((matching.charge, start, parameters)),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut likely: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for (_, start, parameters) in ends {
        let alike = |(_, other): &(Vec<f64>, Vec<f64>)| {
            other.iter().zip(&parameters).all(|(one, other)| (one - other).abs() < APART)
        };
        if likely.len() < LIKELY && !likely.iter().any(alike) {
            likely.push((start, parameters));
        }
    }
    (likely, refused)
}

/// A search from one start.
struct Following<'a> {
    poles: &'a [PiecePoles],
    constants: &'a FreeConstants,
    usual: BesideUsual<'a>,
}

impl<'a> Following<'a> {
    fn from(poles: &'a [PiecePoles], constants: &'a FreeConstants, start: &[f64]) -> Self {
        let pieces = poles.iter().map(|own| own.piece).collect();
        Self { poles, constants, usual: BesideUsual { constants, start: start.to_vec(), pieces } }
    }

    fn matched(&self, parameters: &[f64], reach: f64) -> Result<Matching, ModelError> {
        let values = self.poles.iter().map(|own| self.constants.values(parameters, own.piece)).collect();
        match_within(self.poles, values, reach)
    }

    fn far(&self, parameters: Vec<f64>) -> Result<(Matching, Vec<f64>), ModelError> {
        self.through(&FAR_ROUNDS, parameters)
    }

    fn near(&self, parameters: Vec<f64>) -> Result<(Matching, Vec<f64>), ModelError> {
        self.through(&NEAR_ROUNDS, parameters)
    }

    /// Where these rounds lead, with the mode of each pole within [`REACH`].
    fn through(&self, rounds: &[(f64, f64)], mut parameters: Vec<f64>) -> Result<(Matching, Vec<f64>), ModelError> {
        let bounds = self.constants.bounds();
        let first = rounds.first().map_or(REACH, |(reach, _)| *reach);
        let mut matching = self.matched(&parameters, first)?;
        for &(reach, scatter) in rounds {
            for _ in 0..STEPS {
                let mut sum =
                    self.of_poles(&matching, |residual, like| like * like / (scatter * scatter + residual * residual));
                self.usual.add_to(&mut sum, &parameters);
                sum.mirror();
                let Ok(factor) = sum.normal.llt(Side::Lower) else { break };
                let step = factor.solve(Mat::from_fn(parameters.len(), 1, |i, _| -sum.gradient[i]));
                let longest = (0..parameters.len()).map(|i| step[(i, 0)].abs()).fold(0.0, f64::max);
                let mut part = (LONGEST_STEP / longest).min(1.0);
                let next = (0..HALVINGS).find_map(|_| {
                    let moved = |(i, (at, (low, high))): (usize, (&f64, &(f64, f64)))| {
                        (at + part * step[(i, 0)]).clamp(*low, *high)
                    };
                    let trial: Vec<f64> = parameters.iter().zip(&bounds).enumerate().map(moved).collect();
                    part *= 0.5;
                    Some((self.matched(&trial, reach).ok()?, trial))
                });
                let Some((there, trial)) = next else { break };
                (matching, parameters) = (there, trial);
                if longest < SMALL_STEP {
                    break;
                }
            }
        }
        Ok((self.matched(&parameters, REACH)?, parameters))
    }

    /// Relative residuals of the poles that have a mode, each with its weight by residual and likeness; the lower triangle.
    fn of_poles(&self, matching: &Matching, weight: impl Fn(f64, f64) -> f64) -> Quadratic {
        let mut sum = Quadratic::zero(self.constants.count());
        let pieces = self.poles.iter().zip(&matching.seen).zip(&matching.modes).zip(&matching.values);
        for (((own, seen), modes), values) in pieces {
            let of_constant = self.constants.parameters_of(own.piece);
            for ((pole, amplitudes), mode) in own.frequencies.iter().zip(&own.amplitudes).zip(modes) {
                let Some(mode) = mode.and_then(|mode| seen.get(mode)) else { continue };
                let ratio = mode.frequency / pole;
                let root = weight(ratio - 1.0, likeness(&mode.products, amplitudes)).sqrt();
                let mut row = vec![0.0; self.constants.count()];
                for (constant, parameter) in of_constant.iter().enumerate() {
                    if let Some(parameter) = parameter {
                        let slope = self.constants.slope(constant, values[constant]);
                        row[*parameter] += root * ratio * mode.by_constant[constant] * slope;
                    }
                }
                let row: Vec<(usize, f64)> = row.into_iter().enumerate().collect();
                sum.add_row(root * (ratio - 1.0), &row);
            }
        }
        sum
    }

    /// Lets those constants rest where they were found of which the poles tell little more than what is usual.
    fn what_is_seen(&self, matching: &Matching, parameters: Vec<f64>) -> PoleFit {
        let plain = self.of_poles(matching, |_, _| 1.0);
        let beyond = matching.count().saturating_sub(parameters.len()).max(1) as f64;
        let variance = (plain.cost / beyond).max(BASIS_ERROR * BASIS_ERROR);
        let mut whole = self.of_poles(matching, |_, _| variance.recip());
        self.usual.add_to(&mut whole, &parameters);
        whole.mirror();
        let covariance = whole.covariance();
        let mut constants = self.constants.clone();
        let mut not_identified = Vec::new();
        for (index, free) in self.constants.free.iter().enumerate() {
            let std = covariance.as_ref().map_or(f64::INFINITY, |matrix| matrix[(index, index)].sqrt());
            let open = self.usual.open(index);
            if std < SEEN * open {
                continue;
            }
            let unseen = self.constants.not_identified(index, parameters[index], std.min(open), covariance.as_ref());
            if constants.free.iter().any(|other| other.constant == free.constant) {
                constants.rest(free.constant, Rest::Held(unseen.held_at));
            }
            not_identified.push(unseen);
        }
        let kept = |index: &usize| constants.free.contains(&self.constants.free[*index]);
        let kept: Vec<usize> = (0..parameters.len()).filter(kept).collect();
        let mut plain = plain;
        plain.mirror();
        let at = Quadratic {
            cost: plain.cost,
            gradient: kept.iter().map(|&i| plain.gradient[i]).collect(),
            normal: Mat::from_fn(kept.len(), kept.len(), |i, j| plain.normal[(kept[i], kept[j])]),
        };
        PoleFit { parameters: kept.iter().map(|&i| parameters[i]).collect(), constants, at, not_identified }
    }
}
