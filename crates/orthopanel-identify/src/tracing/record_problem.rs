//! The records at one widening as a sum of squares, for any effects that are switched on.

use std::sync::Arc;

use faer::Mat;
use num_complex::Complex64;
use orthopanel_data::Accelerance;
use orthopanel_model::{BEAM_CONSTANTS, Damping, LineBlock, ModelError, ReceptanceModel, ReceptanceSetup};
use rayon::prelude::*;

use super::hypothesis::{CUBIC, Hypothesis, Switched};
use super::known_sums::KnownSums;
use super::made_rows::Made;
use super::reactions::lines::{ReactionLines, Taken};
use super::reactions::motion_doubt::MotionPower;
use super::reactions::{Reactions, cubic};
use super::rough::{RoughScales, add_prior, is_roughness};
use super::row_products::RowProducts;
use super::search_work::SearchWork;
use super::widened_lines::WidenedLines;
use crate::curves::curves;
use crate::least_squares::Quadratic;
use crate::{AcceleranceFit, IdentifyError};

/// What stays the same whichever effects are on.
#[derive(Clone, Copy)]
pub(super) struct RecordProblem<'a> {
    pub setup: &'a ReceptanceSetup,
    pub records: &'a [WidenedLines],
    /// Constants that are held; free ones are `None`.
    pub held: [Option<f64>; 2],
    /// Whether the damping ratios of a state are free, all of them; else they stay.
    pub free_damping: bool,
    /// Where the damping of a mode that no record shows is kept.
    pub usual_log_zeta: f64,
    /// What is known of damping beforehand.
    pub prior: DampingPrior<'a>,
    /// What is known of the test's roughness beforehand, where hypotheses have any.
    pub rough: Option<RoughScales>,
    /// What the search has cost.
    pub work: &'a SearchWork,
    /// Forces that are not linear, where the test can tell them.
    pub reactions: Option<&'a Reactions>,
    /// What was worked out before, and the number of these lines there.
    pub known: Option<(&'a KnownSums, usize)>,
}

/// Each free mode's $\ln\zeta$ before the records speak: about where it is, and the standard deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct DampingPrior<'a> {
    pub about: &'a [f64],
    pub std: f64,
    /// The standard deviation of the last: all modes beyond.
    pub beyond: f64,
}

/// Constants, damping and effects at some values.
#[derive(Clone)]
pub(super) struct State {
    /// Logarithms of all constants.
    pub constants: [f64; 2],
    /// Logarithms of the damping ratios of the first modes, and last that of all modes beyond.
    pub zetas: Vec<f64>,
    pub hypothesis: Hypothesis,
}

impl State {
    pub(super) fn damping(&self) -> Damping {
        let mut ratios: Vec<f64> = self.zetas.iter().map(|log| log.exp()).collect();
        let beyond = ratios.pop().unwrap_or_default();
        Damping { ratios, beyond }
    }

    /// Every record beside the model, up to `band` \[Hz\].
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn curves(
        &self,
        accelerances: &[Accelerance],
        setup: &ReceptanceSetup,
        band: f64,
    ) -> Result<Vec<AcceleranceFit>, IdentifyError> {
        let effects = self.hypothesis.states(accelerances.len())?;
        curves(accelerances, setup, (&self.constants.map(f64::exp), &self.damping(), &effects), band)
    }

    /// Whether the two are the same, number by number.
    pub(super) fn is(&self, other: &Self) -> bool {
        let effects = (&self.hypothesis.effects, &other.hypothesis.effects);
        let alike = |(one, other): (&Switched, &Switched)| {
            one.effect.id() == other.effect.id() && one.values == other.values && one.free == other.free
        };
        self.constants == other.constants
            && self.zetas == other.zetas
            && effects.0.len() == effects.1.len()
            && effects.0.iter().zip(effects.1).all(alike)
    }
}

/// What is left out together when a fit is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Grouping {
    /// All hits of one pair of places.
    Places,
    /// One hit of each pair of places.
    Hits,
}

impl RecordProblem<'_> {
    /// Positions of the free constants.
    fn free_constants(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.held.len()).filter(|&index| self.held[index].is_none())
    }

    /// The logarithms of the free damping ratios.
    fn free_zetas<'s>(&self, state: &'s State) -> &'s [f64] {
        if self.free_damping { &state.zetas } else { &[] }
    }

    /// Number of real data: two a line.
    pub(super) fn data(&self) -> usize {
        self.records.iter().map(|record| 2 * record.s.len()).sum()
    }

    /// What a search moves.
    pub(super) fn parameters(&self, state: &State) -> Vec<f64> {
        let constants = self.free_constants().map(|index| state.constants[index]);
        constants.chain(self.free_zetas(state).iter().copied()).chain(state.hypothesis.coordinates()).collect()
    }

    /// The state that parameters stand for, of the same effects as `like`.
    pub(super) fn state(&self, parameters: &[f64], like: &State) -> State {
        let mut constants = like.constants;
        let mut rest = parameters.iter().copied();
        for index in self.free_constants() {
            constants[index] = rest.next().unwrap_or(constants[index]);
        }
        let free = self.free_zetas(like).len();
        let zetas = rest.by_ref().take(free).chain(like.zetas.iter().skip(free).copied()).collect();
        let coordinates: Vec<f64> = rest.collect();
        State { constants, zetas, hypothesis: like.hypothesis.at(&coordinates) }
    }

    /// Bounds of the parameters.
    pub(super) fn bounds(&self, state: &State) -> Vec<(f64, f64)> {
        let constants = self.free_constants().map(|index| {
            let constant = BEAM_CONSTANTS[index];
            (constant.low.ln(), constant.high.ln())
        });
        let zetas = self.free_zetas(state).iter().map(|_| (1e-6_f64.ln(), 0.9_f64.ln()));
        constants.chain(zetas).chain(state.hypothesis.bounds()).collect()
    }

    /// The sum of squares of each group of data at these parameters, and last that of what is known beforehand.
    pub(super) fn by_group(
        &self,
        parameters: &[f64],
        like: &State,
        grouping: Grouping,
    ) -> Result<Vec<Quadratic>, ModelError> {
        // As it stands: a logarithm and back would move it by its rounding.
        let state = if parameters == self.parameters(like) { like.clone() } else { self.state(parameters, like) };
        let size = parameters.len();
        let known = self.known.and_then(|(known, stage)| known.find((stage, grouping), &state));
        // Counted either way: which of two threads comes first may not matter.
        self.count(&state);
        let data = match known {
            Some(data) => data,
            None => {
                let data = Arc::new(self.data_by_group(&state, size, grouping)?);
                if let Some((known, stage)) = self.known {
                    known.keep((stage, grouping), state.clone(), &data);
                }
                data
            }
        };
        let mut prior = self.prior(&state, size);
        prior.mirror();
        Ok(data.iter().cloned().chain([prior]).collect())
    }

    /// The sum of squares of each group of data.
    fn data_by_group(&self, state: &State, size: usize, grouping: Grouping) -> Result<Vec<Quadratic>, ModelError> {
        let all: Vec<usize> = (0..size).collect();
        let made = self.made(state)?;
        // Records side by side, their sums in order: the same for any number of threads.
        let numbers: Vec<usize> = (0..self.records.len()).collect();
        let products = numbers.par_iter().map(|&index| self.products(&made, index, grouping));
        let products: Vec<Vec<Mat<f64>>> = products.collect();
        let mut sums: Vec<Quadratic> = Vec::new();
        for (index, targets) in products.iter().enumerate() {
            for (target, products) in targets.iter().enumerate() {
                let group = if grouping == Grouping::Hits { target } else { index };
                if sums.len() <= group {
                    sums.resize_with(group + 1, || Quadratic::zero(size));
                }
                sums[group].add_products(products, &all);
            }
        }
        sums.iter_mut().for_each(Quadratic::mirror);
        Ok(sums)
    }

    /// $[J\,r]^T[J\,r]$ of each target of a record.
    fn products(&self, made: &Made, index: usize, grouping: Grouping) -> Vec<Mat<f64>> {
        let record = &self.records[index];
        let Some(mut evaluator) = made.model.evaluator(index) else { return vec![] };
        let targets = made.targets(index, record, grouping);
        let mut products: Vec<RowProducts> = targets.iter().map(|_| RowProducts::new(made.plan.len() + 1)).collect();
        evaluator.blocks(&record.s, |first, block| {
            for (target, products) in targets.iter().zip(&mut products) {
                products.add(2 * block.len(), |column, rows| {
                    let (re, im) = rows.split_at_mut(block.len());
                    target.column((first, block), made.plan.get(column).map(|plan| (column, *plan)), [re, im]);
                });
            }
        });
        products.into_iter().map(RowProducts::lower).collect()
    }

    /// Hands on, record by record, the rows of each of its targets (all hits together, or each by itself): derivatives by all
    /// parameters, then what is missed, all over the noise; real and imaginary part of a line follow each other.
    pub(super) fn rows(
        &self,
        state: &State,
        grouping: Grouping,
        mut take: impl FnMut(usize, usize, &Mat<f64>),
    ) -> Result<(), ModelError> {
        let made = self.made(state)?;
        self.count(state);
        for (index, record) in self.records.iter().enumerate() {
            let Some(mut evaluator) = made.model.evaluator(index) else { continue };
            let targets = made.targets(index, record, grouping);
            let columns = made.plan.len() + 1;
            let mut rows: Vec<Mat<f64>> = targets.iter().map(|_| Mat::zeros(2 * record.s.len(), columns)).collect();
            let mut parts = [[0.0; LineBlock::MOST]; 2];
            evaluator.blocks(&record.s, |first, block| {
                for (target, rows) in targets.iter().zip(&mut rows) {
                    for column in 0..columns {
                        let [re, im] = parts.each_mut().map(|part| &mut part[..block.len()]);
                        target.column((first, block), made.plan.get(column).map(|plan| (column, *plan)), [re, im]);
                        let rows = rows.col_as_slice_mut(column)[2 * first..].chunks_exact_mut(2);
                        rows.zip(re.iter().zip(im)).for_each(|(row, (re, im))| (row[0], row[1]) = (*re, *im));
                    }
                }
            });
            rows.iter().enumerate().for_each(|(target, rows)| take(index, target, rows));
        }
        Ok(())
    }

    /// The sum over all records.
    pub(super) fn linearise(&self, parameters: &[f64], like: &State) -> Result<Quadratic, ModelError> {
        Ok(total(&self.by_group(parameters, like, Grouping::Places)?))
    }

    /// The same where a state stands.
    pub(super) fn at(&self, state: &State) -> Result<Quadratic, ModelError> {
        self.linearise(&self.parameters(state), state)
    }

    /// The accelerance of every record at a state.
    pub(super) fn lines(&self, state: &State) -> Result<Vec<Vec<Complex64>>, ModelError> {
        let (model, reactions) = self.model(state)?;
        let records = self.records.iter().enumerate().map(|(index, record)| {
            let Some(mut evaluator) = model.evaluator(index) else { return vec![] };
            let mut lines = Vec::with_capacity(record.s.len());
            evaluator.lines(&record.s, |_, value, _| lines.push(value));
            let taken = reactions.as_ref().map_or_else(Vec::new, |all| all.taken(index, record, Grouping::Places, &[]));
            for taken in taken {
                lines.iter_mut().zip(taken.value).for_each(|(line, taken)| *line -= taken);
            }
            lines
        });
        Ok(records.collect())
    }

    /// Mean square of the hits' scatter over their variance, each hit with what forces that are not linear took off it; `None`
    /// where no such force is on or single hits tell nothing.
    pub(super) fn scatter_beside_reactions(&self, state: &State) -> Result<Option<f64>, ModelError> {
        if !state.hypothesis.effects.iter().any(|on| on.effect.id() == CUBIC) {
            return Ok(None);
        }
        let (_, Some(reactions)) = self.model(state)? else { return Ok(None) };
        let (mut sum, mut lines) = (0.0, 0_usize);
        for (index, record) in self.records.iter().enumerate().filter(|(_, record)| record.hits.len() > 1) {
            let taken = reactions.taken(index, record, Grouping::Hits, &[]);
            for line in 0..record.s.len() {
                let hits = || {
                    let pairs = record.hits.iter().zip(&taken);
                    pairs.map(|(hit, taken)| (hit.value[line] + taken.value[line], 1.0 / hit.variance[line]))
                };
                let weights: f64 = hits().map(|(_, weight)| weight).sum();
                let mean = hits().map(|(value, weight)| weight * value).sum::<Complex64>() / weights;
                let left: f64 = hits().map(|(value, weight)| weight * (value - mean).norm_sqr()).sum();
                sum += left / (record.hits.len() - 1) as f64;
            }
            lines += record.s.len();
        }
        Ok((lines > 0).then(|| sum / lines as f64))
    }

    /// Derivative of a record's accelerance by the place of its force, at any $s$; the state has roughness. Empty where it has none.
    pub(super) fn by_place(&self, state: &State, index: usize, s: &[Complex64]) -> Result<Vec<Complex64>, ModelError> {
        let effects = &state.hypothesis.effects;
        let Some(rough) = effects.iter().position(is_roughness) else { return Ok(vec![]) };
        let before: usize = effects[..rough].iter().map(|on| on.values.len()).sum();
        let column = state.constants.len() + state.zetas.len() + before + index;
        let (model, _) = self.model(state)?;
        let Some(mut evaluator) = model.evaluator(index) else { return Ok(vec![]) };
        let mut by_place = Vec::with_capacity(s.len());
        evaluator.lines(s, |_, _, by| by_place.push(by.of(column)));
        Ok(by_place)
    }

    /// What forces that are not linear take off each hit of a record, one value for each of `lines`; empty where there are none.
    pub(super) fn taken_off_hits(
        &self,
        state: &State,
        index: usize,
        lines: &WidenedLines,
    ) -> Result<Vec<Vec<Complex64>>, ModelError> {
        let taken = self.taken_from_hits(state, (index, lines), &[])?;
        Ok(taken.into_iter().map(|taken| taken.value).collect())
    }

    /// The same with derivatives by these columns, each times its factor.
    fn taken_from_hits(
        &self,
        state: &State,
        (index, lines): (usize, &WidenedLines),
        columns: &[(usize, f64)],
    ) -> Result<Vec<Taken>, ModelError> {
        let damping = state.damping();
        let effects = state.hypothesis.states(self.records.len())?;
        let found = ReactionLines::of(self.reactions, state, (&damping, &effects), &[(index, lines)])?;
        Ok(found.map_or_else(Vec::new, |found| found.taken(index, lines, Grouping::Hits, columns)))
    }

    /// What cubic forces do on the lines of each hit of a record; empty where no such force is on.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn by_motion(&self, state: &State, index: usize) -> Result<Vec<Vec<MotionPower>>, ModelError> {
        let first = state.constants.len() + state.zetas.len();
        let Some((k3, column)) = cubic(&state.hypothesis, first) else { return Ok(vec![]) };
        let taken = self.taken_from_hits(state, (index, &self.records[index]), &[(column, 2.0 * k3)])?;
        let power = |(value, by): (&Complex64, &Vec<Complex64>)| MotionPower {
            whole: value.norm_sqr(),
            by_part: by[0].norm_sqr(),
        };
        Ok(taken.iter().map(|taken| taken.value.iter().zip(&taken.by).map(power).collect()).collect())
    }

    /// What is linear, and what is not.
    fn model(&self, state: &State) -> Result<(ReceptanceModel, Option<ReactionLines>), ModelError> {
        let damping = state.damping();
        let effects = state.hypothesis.states(self.records.len())?;
        let records: Vec<_> = self.records.iter().enumerate().collect();
        let reactions = ReactionLines::of(self.reactions, state, (&damping, &effects), &records)?;
        Ok((self.setup.model(&state.constants.map(f64::exp), &damping, &effects)?, reactions))
    }

    /// Column of the model and factor of each parameter.
    fn columns(&self, state: &State) -> Vec<(usize, f64)> {
        let first_zeta = state.constants.len();
        let constants = self.free_constants().map(|index| (index, state.constants[index].exp()));
        let zetas = (0..self.free_zetas(state).len()).map(|mode| (first_zeta + mode, 1.0));
        let mut columns: Vec<(usize, f64)> = constants.chain(zetas).collect();
        let mut start = first_zeta + state.zetas.len();
        for switched in &state.hypothesis.effects {
            columns.extend(switched.free.iter().map(|free| (start + free.at, free.slope(switched.values[free.at]))));
            start += switched.values.len();
        }
        columns
    }

    /// What a state makes of the records.
    fn made(&self, state: &State) -> Result<Made, ModelError> {
        let (model, reactions) = self.model(state)?;
        Ok(Made { model, reactions, plan: self.columns(state) })
    }

    fn count(&self, state: &State) {
        self.work.count(&state.hypothesis, self.records.iter().map(|record| record.s.len()).sum());
    }

    fn prior(&self, state: &State, size: usize) -> Quadratic {
        let mut prior = Quadratic::zero(size);
        let first = self.free_constants().count();
        for (mode, log) in self.free_zetas(state).iter().enumerate() {
            let about = self.prior.about.get(mode).unwrap_or(&self.usual_log_zeta);
            let is_last = mode + 1 == state.zetas.len();
            let std = if is_last { self.prior.beyond } else { self.prior.std };
            prior.add_row((log - about) / std, &[(first + mode, 1.0 / std)]);
        }
        if let Some(scales) = &self.rough {
            add_prior(&mut prior, &state.hypothesis, scales, first + self.free_zetas(state).len());
        }
        prior
    }
}

/// The sum of several sums of squares.
pub(super) fn total(sums: &[Quadratic]) -> Quadratic {
    let mut total = Quadratic::zero(sums.first().map_or(0, |sum| sum.gradient.len()));
    for sum in sums {
        total.cost += sum.cost;
        total.gradient.iter_mut().zip(&sum.gradient).for_each(|(total, own)| *total += own);
        total.normal += &sum.normal;
    }
    total
}
