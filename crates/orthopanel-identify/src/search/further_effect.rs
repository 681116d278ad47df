//! One effect more: from a net of starts to the posterior.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use faer::linalg::solvers::Llt;
use faer::prelude::Solve;
use faer::{Mat, Side};
use orthopanel_model::{Effect, Place, StructureKind};
use rayon::prelude::*;

use super::approach::{Approach, Promise, Ranked};
use super::{FOLLOWED, Inquiry, LOOSE, NEAR, SMALL, constants_of_beam, logs, with_one_more};
use crate::effect_places::has_place;
use crate::hypothesis::{Hypothesis, Role};
use crate::judge::{ODDS, most_frequency};
use crate::measured::Pole;
use crate::model_error::{KINDS, Kind};
use crate::posterior::{Following, Judged, Point, Posterior, Problem, Projection};
use crate::predicted::Prediction;
use crate::stacked::Block;
use crate::whitening::Whitening;

/// How far a start may be behind, twice in the logarithm: under wide sizes no hypothesis is far behind that comes out ahead under narrow ones.
fn behind() -> f64 {
    2.0 * NEAR * ODDS.ln()
}

/// Starts on a plate that are followed: it has many places.
const FOLLOWED_ON_PLATES: usize = 5;

/// A base, with what its coordinates make good to first order.
pub(super) struct Score {
    by: Whitening,
    /// $WJ$, and $J^TC^{-1}J + P$.
    derivatives: Mat<f64>,
    curvature: Llt<f64>,
    /// $Wr$.
    missed: Vec<f64>,
}

impl Score {
    /// About a point with these derivatives, under a covariance.
    pub(super) fn about(problem: &Problem, at: &Point, mut derivatives: Mat<f64>, by: Whitening) -> Option<Self> {
        by.whiten(&mut derivatives);
        let mut curvature = derivatives.transpose() * &derivatives;
        problem.hypothesis.precision().iter().enumerate().for_each(|(i, precision)| curvature[(i, i)] += precision);
        let missed = by.whitened(&problem.missed(&at.at));
        Some(Self { curvature: curvature.llt(Side::Lower).ok()?, by, derivatives, missed })
    }

    /// By how much the misfit falls along the way from the base's values to others, as far as it serves best, beside what the base's coordinates
    /// make good, and how far along that is; `None` where there is no way.
    pub(super) fn towards(&self, from: &[f64], to: &[f64]) -> Option<(f64, f64)> {
        let [free, told] = self.along(from, to);
        // It acts one way alone: a mass that is missing is another start.
        (free > 0.0).then(|| (told.max(0.0).powi(2) / free, told / free))
    }

    /// By how much the misfit falls from the base's values to others, beside what the base's coordinates make good.
    pub(super) fn there(&self, from: &[f64], to: &[f64]) -> f64 {
        let [free, told] = self.along(from, to);
        2.0 * told - free
    }

    /// The square of the way from the base's values to others, beside what the base's coordinates follow of it.
    pub(super) fn told_apart(&self, from: &[f64], to: &[f64]) -> f64 {
        self.along(from, to)[0]
    }

    /// The square of that way, and what it has of what is missed.
    fn along(&self, from: &[f64], to: &[f64]) -> [f64; 2] {
        let way: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
        let way = self.by.whitened(&way);
        let along = |values: &[f64]| {
            let of_column = |i: usize, _| self.derivatives.col_as_slice(i).iter().zip(values).map(|(a, b)| a * b).sum();
            Mat::from_fn(self.derivatives.ncols(), 1, of_column)
        };
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let (of_way, of_missed): (Mat<f64>, Mat<f64>) = (along(&way), along(&self.missed));
        let solved = self.curvature.solve(&of_way);
        [(&way, &way, &of_way), (&way, &self.missed, &of_missed)]
            .map(|(a, b, other)| dot(a, b) - dot(other.col_as_slice(0), solved.col_as_slice(0)))
    }
}

/// The same of what the best effect makes good once both are followed.
const HALF: f64 = 0.5;
/// So many times wider where no start is followed yet: a net is coarse.
const NET: f64 = 4.0;
/// Poles at which something that vibrates by itself is looked for,
const MISSED: usize = 4;
/// and how far beside them.
const BESIDE_POLE: [f64; 2] = [0.985, 1.01];
/// Furthest shift of the base's coordinates from which a start is followed.
const SHIFT: f64 = 0.2;
/// Furthest that bending modes of a plate lie from those of a beam, in the logarithm of a frequency.
const PLATE_BESIDE: f64 = 0.5;
/// Numbers of the lowest poles that a plate shares with a beam: below the first that bends across.
const LOWEST_POLES: [usize; 3] = [3, 4, 6];

impl Inquiry<'_> {
    /// Whether a pole lies above all modes that the base has for it: a plate up to there would have modes without number.
    fn reaches_beyond(&self, base: &Judged) -> bool {
        let mut blocks = self.stacked.blocks.iter().zip(&base.posterior.point.at.blocks);
        blocks.any(|(block, at)| {
            let pole = block.comparison().measured.poles.last().map_or(0.0, |pole| pole.angular_frequency);
            pole > at.flexible.last().copied().unwrap_or(0.0)
        })
    }

    /// The poles that the base misses most, those that are none of its modes first.
    fn most_missed(&self, base: &Judged) -> Vec<Pole> {
        let of_block = |(block, at): (&Block, &Prediction)| {
            let comparison = block.comparison();
            let measured = comparison.measured;
            let missed = |pole: usize| {
                let is_alone = measured.records.is_empty() && at.flexible_of_poles[pole].is_none();
                if is_alone || at.partners.iter().any(|record| record[pole].is_none()) {
                    return f64::INFINITY;
                }
                let residue = |record: usize| comparison.residue_place(record, pole);
                let residues = (0..measured.records.len()).map(residue).flat_map(|place| [place, place + 1]);
                // A list has frequencies alone.
                let frequency = measured.records.is_empty().then_some(pole);
                residues.chain(frequency).map(|place| (comparison.values[place] - at.values[place]).powi(2)).sum()
            };
            measured.poles.iter().enumerate().map(|(number, pole)| (missed(number), *pole)).collect::<Vec<_>>()
        };
        let blocks = self.stacked.blocks.iter().zip(&base.posterior.point.at.blocks);
        let mut poles: Vec<(f64, Pole)> = blocks.flat_map(of_block).collect();
        poles.sort_by(|a, b| b.0.total_cmp(&a.0));
        poles.into_iter().take(MISSED).map(|(_, pole)| pole).collect()
    }

    /// Frequencies \[Hz\] of a mass on a spring at a place with which the panel has a mode at each of these poles: with $\alpha$ the receptance
    /// of the panel there, $\omega_r^2 = \omega^2/(1-\omega^2m\,\alpha(\omega))$; and frequencies beside each pole, for the panel is not known well.
    pub(super) fn tuned(&self, base: &Judged, poles: &[Pole], mass: f64, at: Place) -> Vec<f64> {
        let values = self.stacked.first().values(&base.hypothesis, &base.posterior.point.z);
        let seen = values.and_then(|(constants, effects)| self.predictor().seen_at(at, &constants, &effects));
        let Ok(seen) = seen else { return vec![] };
        let tuned = |pole: &Pole| {
            let square = pole.angular_frequency.powi(2);
            let share = |(deflection, omega): (&Vec<f64>, &f64)| deflection[0].powi(2) / (omega.powi(2) - square);
            let receptance: f64 = seen.deflection.iter().zip(&seen.angular_frequency).map(share).sum();
            let left = 1.0 - square * mass * receptance;
            let exact = (left > 0.0).then(|| (square / left).sqrt());
            let beside = BESIDE_POLE.map(|factor| Some(factor * pole.angular_frequency));
            beside.into_iter().chain([exact]).flatten().map(|omega| omega / TAU).collect::<Vec<_>>()
        };
        poles.iter().flat_map(tuned).collect()
    }

    /// Where the coordinates of a base stand as an effect joins it: as they are, and where the base misses more than a real panel does, so that
    /// it may have been led away, at constants that fit the frequencies alone, and declared effects where a search begins; at those of the lowest
    /// poles, where another structure takes the place of the first.
    fn bases(&self, base: &Judged, with: &Hypothesis) -> Vec<Vec<f64>> {
        let own = base.hypothesis.of_parts(&base.posterior.point.z);
        let at = |constants: [f64; 2]| {
            let mut nets = vec![base.hypothesis.of_constants(&constants)];
            for (part, own) in base.hypothesis.parts.iter().zip(&own) {
                let starts = if part.role == Role::Declared { part.starts(|_, _| vec![]) } else { vec![own.to_vec()] };
                nets = nets.iter().flat_map(|net| starts.iter().map(|start| [&net[..], start].concat())).collect();
            }
            nets
        };
        let mut bases = vec![base.posterior.point.z.clone()];
        let is_beam = self.predictor().structure == StructureKind::TimoshenkoBeam;
        if is_beam && base.posterior.log_sizes[Kind::Frequency as usize].exp() > most_frequency(&self.stacked) {
            let replaces = with.parts.last().is_some_and(|part| part.replaces_structure(self.predictor()));
            let lowest = if replaces { &LOWEST_POLES[..] } else { &[usize::MAX] };
            for &lowest in lowest {
                let constants = constants_of_beam(self.stacked.longest(), lowest).unwrap_or_default();
                bases.extend(constants.into_iter().take(2).flat_map(at));
            }
        }
        // With constants held all begin alike.
        bases.dedup();
        bases
    }

    /// Where an effect begins: a net of starts of all its ways, ranked with wide sizes of model error. `None` where it cannot act.
    pub(super) fn ranked(&self, base: &Judged, effect: &'static dyn Effect) -> Option<Ranked> {
        let of_base = self.problem(&base.hypothesis);
        let at_base = &base.posterior.point;
        let coarse = logs(LOOSE.map(|size| NET * size));
        let loose = of_base.whitening(&of_base.errors(&at_base.at).with_every_partner(), &coarse)?;
        let ways: Vec<Hypothesis> = self.ways(effect).into_iter().map(|part| base.hypothesis.with(part)).collect();
        let missed = self.most_missed(base);
        // What the base's own coordinates make good of a start, to first order.
        let projection = Projection::new(&at_base.derivatives, &of_base.hypothesis.precision(), &loose)?;
        let bases = self.bases(base, &ways[0]);
        // Modes of a plate that bend along lie near those of the beam.
        let is_far = base.posterior.log_sizes[Kind::Frequency as usize].exp() > PLATE_BESIDE;
        if self.replaces(&ways) && (is_far || self.reaches_beyond(base)) {
            return None;
        }
        // Places are without number; what has none is predicted from each start.
        let on_plate =
            if self.is_plate() && has_place(effect) { Some(self.net_on_plate(base, &missed)?) } else { None };
        let starts = |(way, hypothesis): (usize, &Hypothesis)| {
            let problem = self.problem(hypothesis);
            if let Some(net) = &on_plate {
                return net.starts(&problem).into_iter().map(|point| (way, point)).collect::<Vec<_>>();
            }
            let starts = match hypothesis.parts.last() {
                Some(part) => part.starts(|mass, at| self.tuned(base, &missed, mass, at)),
                None => vec![],
            };
            let point = |(of_base, start): (&Vec<f64>, &Vec<f64>)| -> Option<Point> {
                let point = problem.point([&of_base[..], start].concat(), &loose)?;
                // Motions of the piece as a whole have errors of their own.
                if !point.at.hangs_as(&at_base.at) {
                    let errors = problem.errors(&point.at).with_every_partner();
                    return problem.judged_by(point, &problem.whitening(&errors, &coarse)?);
                }
                if bases.len() > 1 {
                    return Some(point);
                }
                let (shift, gain) = projection.of(&problem.missed(&point.at), &at_base.z);
                let mut z = point.z.clone();
                z.iter_mut().zip(&shift).for_each(|(z, shift)| *z += shift.clamp(-SHIFT, SHIFT));
                hypothesis.clamp(&mut z);
                Some(Point { z, cost: point.cost - gain, ..point })
            };
            let starts = bases.iter().flat_map(|of_base| starts.iter().map(move |start| (of_base, start)));
            let starts: Vec<(&Vec<f64>, &Vec<f64>)> = starts.collect();
            starts.into_par_iter().filter_map(point).map(|point| (way, point)).collect::<Vec<_>>()
        };
        let kept = if self.is_plate() { FOLLOWED_ON_PLATES } else { FOLLOWED };
        // A score is no likelihood: far behind the best may lie what leads to the end.
        let behind = if self.is_plate() { f64::INFINITY } else { behind() };
        let points = best(ways.par_iter().enumerate().flat_map_iter(starts).collect(), (4 * kept, behind));
        let promising = if bases.len() > 1 { None } else { self.promising(base, &ways, &points, kept) };
        Some(Ranked { ways, points, promising, of_several: bases.len() > 1 })
    }

    pub(super) fn is_plate(&self) -> bool {
        self.stacked.is_of_plates()
    }

    /// Whether another structure takes the place of the first: that is too dear for more than one set of derivatives.
    fn replaces(&self, ways: &[Hypothesis]) -> bool {
        ways[0].parts.last().is_some_and(|part| part.replaces_structure(self.predictor()))
    }

    /// The starts of an effect, the best of them followed with wide sizes of model error.
    pub(super) fn approached(&self, base: &Judged, ranked: Ranked) -> Option<Approach> {
        let Ranked { ways, points, promising, of_several } = ranked;
        let points = match promising {
            Some(promising) if !promising.is_empty() => promising.into_iter().map(|(_, start)| start).collect(),
            // Where it ends is told, and how likely it is there, but it is not looked for further.
            Some(_) if base.names().is_empty() => {
                let (way, point) = points.into_iter().next()?;
                // On plates how much of the effect there is followed from its score, and is not what was predicted.
                let point = if self.is_plate() {
                    let problem = self.problem(&ways[way]);
                    with_derivatives_of(&base.posterior.point, &problem, problem.unjudged(point.z)?)?
                } else {
                    point
                };
                let sizes = base.posterior.log_sizes;
                return Some(Approach { ways, points: vec![(way, point)], sizes, gain: f64::NEG_INFINITY });
            }
            Some(_) => return None,
            None if of_several => {
                let coarse = logs(LOOSE.map(|size| NET * size));
                best(self.each_followed(base, (&ways, points), &coarse, 5), (2 * FOLLOWED, behind()))
            }
            None => points,
        };
        // On a plate starts are scaled to what is missed: under the base's own sizes they are near where they lead.
        let sizes = if self.is_plate() { base.posterior.log_sizes } else { logs(LOOSE) };
        let points = best(self.each_followed(base, (&ways, points), &sizes, 5), (FOLLOWED, behind()));
        let of_base = self.problem(&base.hypothesis);
        let errors = of_base.errors(&base.posterior.point.at).with_every_partner();
        let at_base = of_base.judged_by(base.posterior.point.clone(), &of_base.whitening(&errors, &sizes)?)?;
        let gain = at_base.cost - points.first().map_or(at_base.cost, |(_, best)| best.cost);
        Some(Approach { ways, points, sizes, gain })
    }

    /// An effect more, in the way and from the start that serve best: the best of the starts that were followed with wide sizes of model error are
    /// followed to the posterior, where no other effect's made good more than twice as much, which is `most`. With it whether it may come to the odds that count, as far
    /// as is known.
    pub(super) fn followed(&self, base: &Judged, approach: Approach, most: f64) -> Option<(Judged, bool)> {
        let Approach { ways, points, sizes, gain } = approach;
        let judged =
            |(way, posterior): (usize, Posterior)| with_one_more(base, ways[way].clone(), posterior, ways.len());
        let is_minor = self.is_plate() && gain < HALF * most;
        if gain < -behind() || is_minor {
            let (way, point) = points.into_iter().next()?;
            let rounds = if gain.is_finite() || self.is_plate() { 1 } else { 4 };
            let posterior = self.problem(&ways[way]).posterior(point, sizes, rounds)?;
            return Some((judged((way, posterior)), false));
        }
        let follow = |points: Vec<(usize, Point)>, sizes: &[f64; KINDS], most: usize| {
            self.each_followed(base, (&ways, points), sizes, most)
        };
        let (few, one) = ((FOLLOWED, behind()), (1, behind()));
        let between = std::array::from_fn(|k| 0.5 * (LOOSE[k] * SMALL[k]).ln());
        let points = if self.is_plate() { points } else { best(follow(points, &between, 4), few) };
        // From small sizes, since an effect drowns in those of too poor a hypothesis; and from those, since it need not be all that lacks.
        let from = [logs(SMALL), base.posterior.log_sizes];
        let ends: Vec<(usize, Posterior)> = from
            .into_par_iter()
            .filter_map(|sizes| {
                let all = best(follow(best(follow(points.clone(), &sizes, 4), one), &sizes, 8), one);
                let (way, point) = all.into_iter().next()?;
                let posterior = self.problem(&ways[way]).posterior(point, sizes, 2)?;
                Some((way, posterior))
            })
            .collect();
        let best = ends.into_iter().max_by(|a, b| a.1.log_evidence.total_cmp(&b.1.log_evidence))?;
        Some((judged(best), true))
    }

    /// Points, each of its way, followed under these sizes of model error.
    fn each_followed(
        &self,
        base: &Judged,
        (ways, points): (&[Hypothesis], Vec<(usize, Point)>),
        sizes: &[f64; KINDS],
        most: usize,
    ) -> Vec<(usize, Point)> {
        let of_base = self.problem(&base.hypothesis);
        let at_base = &base.posterior.point;
        // Asked for by starts alone: what was followed before brings derivatives.
        let coarse = LazyLock::new(|| {
            let errors = of_base.errors(&at_base.at).with_every_partner();
            of_base.whitening(&errors, &logs(LOOSE.map(|size| NET * size)))
        });
        let exact_from = if self.replaces(ways) { usize::MAX } else { at_base.z.len() };
        let on = |(way, mut point): (usize, Point)| {
            let problem = self.problem(&ways[way]);
            if point.derivatives.ncols() == 0 {
                // The shift is of first order about the base: where it leads nowhere, it is left out.
                let unshifted = [&at_base.z[..], &point.z[at_base.z.len()..]].concat();
                let coarse = coarse.as_ref()?;
                let both = [point.z, unshifted].into_iter().filter_map(|z| problem.point(z, coarse));
                point = both.min_by(|a, b| a.misfit.total_cmp(&b.misfit))?;
                if self.is_plate() {
                    point = with_derivatives_of(at_base, &problem, point)?;
                }
            }
            let by = problem.whitening(&problem.errors(&point.at).with_every_partner(), sizes)?;
            // On a plate derivatives by the base's coordinates are dear, and the posterior asks for them.
            let how = Following { most, least_gain: 1.0, exact_from, exactly: !self.is_plate() };
            problem.follow(point, &by, how).map(|(point, _)| (way, point))
        };
        points.into_par_iter().filter_map(on).collect()
    }

    /// The covariance about a base by which starts are ranked: of a beam under sizes of model error that are no wider than small ones, of a plate under
    /// its own. Where the base lacks much, a plate's many modes mix, and under small sizes the few that are moved most drown the others.
    fn ranking(&self, base: &Judged) -> Option<Whitening> {
        let of_base = self.problem(&base.hypothesis);
        let own = base.posterior.log_sizes;
        let small = |kind: usize| if self.is_plate() { own[kind] } else { own[kind].min(SMALL[kind].ln()) };
        let sizes: [f64; KINDS] = std::array::from_fn(small);
        of_base.whitening(&of_base.errors(&base.posterior.point.at).with_every_partner(), &sizes)
    }

    /// What ranks starts by their difference from the base.
    pub(super) fn score(&self, base: &Judged) -> Option<Score> {
        let at_base = &base.posterior.point;
        Score::about(&self.problem(&base.hypothesis), at_base, at_base.derivatives.clone(), self.ranking(base)?)
    }

    /// The starts from which an effect may come to the odds that count, the best few; `None` where the base's curvature is singular. By a score test:
    /// what its coordinates and its starts make good of the base's misfit to first order.
    fn promising(
        &self,
        base: &Judged,
        ways: &[Hypothesis],
        starts: &[(usize, Point)],
        kept: usize,
    ) -> Option<Vec<Promise>> {
        let at_base = &base.posterior.point;
        let of_base = self.problem(&base.hypothesis);
        let by = self.ranking(base)?;
        let precision = of_base.hypothesis.precision();
        let missed = of_base.missed(&at_base.at);
        let before = Projection::new(&at_base.derivatives, &precision, &by)?.of(&missed, &at_base.z).1;
        let gain = |way: usize, start: &Point| {
            let problem = self.problem(&ways[way]);
            let z = [&at_base.z[..], &start.z[at_base.z.len()..]].concat();
            let start = problem.point(z, &by)?;
            if !start.at.hangs_as(&at_base.at) {
                return Some(f64::INFINITY);
            }
            let own = problem.derivatives(&start, at_base.z.len()..start.z.len())?;
            let towards = Mat::from_fn(own.nrows(), 1, |row, _| start.at.values[row] - at_base.at.values[row]);
            let columns = faer::concat![[at_base.derivatives, own, towards]];
            let free = vec![0.0; columns.ncols() - precision.len()];
            let here = [&at_base.z[..], &free].concat();
            let precision = [&precision[..], &free].concat();
            Some(Projection::new(&columns, &precision, &by)?.of(&missed, &here).1 - before)
        };
        let gains = starts.iter().filter_map(|(way, start)| Some((gain(*way, start)?, (*way, start.clone()))));
        let mut promising: Vec<_> = gains.filter(|(gain, _)| *gain > 2.0 * ODDS.ln()).collect();
        promising.sort_by(|a, b| b.0.total_cmp(&a.0));
        promising.truncate(kept);
        Some(promising)
    }
}

/// A point near a base with the derivatives by the base's coordinates that are known there: on a plate they are dear, and change little.
fn with_derivatives_of(base: &Point, problem: &Problem, point: Point) -> Option<Point> {
    if base.derivatives.ncols() != base.z.len() {
        return Some(point);
    }
    let own = problem.derivatives(&point, base.z.len()..point.z.len())?;
    let mut derivatives = faer::concat![[base.derivatives, own]];
    // Where nothing stood before, the side of the feet moved nothing: by that derivatives are found anew.
    let foot = problem.hypothesis.foot();
    let by_foot = problem.derivatives(&point, foot..foot + 1)?;
    derivatives.col_as_slice_mut(foot).copy_from_slice(by_foot.col_as_slice(0));
    Some(Point { derivatives, ..point })
}

/// Of starts, each with its way, the best few that lie apart.
fn best(mut points: Vec<(usize, Point)>, (most, behind): (usize, f64)) -> Vec<(usize, Point)> {
    points.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    let mut apart: Vec<(usize, Point)> = Vec::new();
    for (way, point) in points {
        let near = |(other, of): &(usize, Point)| {
            *other == way && of.z.iter().zip(&point.z).all(|(a, b)| (a - b).abs() < 0.05)
        };
        let is_behind = apart.first().is_some_and(|(_, best)| point.cost > best.cost + behind);
        if apart.len() < most && !is_behind && !apart.iter().any(near) {
            apart.push((way, point));
        }
    }
    apart
}
