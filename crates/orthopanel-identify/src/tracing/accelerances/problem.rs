//! Resonances and the lines between them as one sum of squares, each weighed by what it is good for.

use std::sync::OnceLock;

use num_complex::Complex64;
use orthopanel_data::ImpactTest;
use orthopanel_model::{EffectSetting, ModelError, NaturalFrequencies, Owner, Place, ReceptanceSetup, RecordSetting};

use super::between_peaks::BetweenPeaks;
use super::resonances::Resonance;
use crate::IdentifyError;
use crate::least_squares::{Ending, Quadratic, descend};
use crate::tracing::model_error::TUNED;
use crate::tracing::record_problem::{DampingPrior, Grouping, RecordProblem, State, total};
use crate::tracing::search_work::SearchWork;
use crate::tracing::whiteness::independent_part;
use crate::tracing::widened_lines::WidenedLines;

/// What a trace of accelerances holds on to.
pub(super) struct AccelerancesProblem {
    pub setup: ReceptanceSetup,
    pub between: BetweenPeaks,
    pub resonances: Vec<Resonance>,
    /// What finds the natural frequencies with the sensor at each of its places, and the resonances that it is for.
    places: Vec<(NaturalFrequencies, Vec<usize>)>,
    pub held: [Option<f64>; 2],
    pub usual_log_zeta: f64,
    /// The lines with their variance, and how they are weighed.
    lines: Vec<WidenedLines>,
    pub weighing: Weighing,
    work: SearchWork,
}

/// How the lines between the resonances count.
///
/// What a model misses there (uneven hits, places, sections) is no noise: it is the same part of the motion in every
/// record, $\mathrm{var} = c^2\overline{|H|^2} + N$, and neighbouring lines err alike. The fit that explains most so far
/// tells $c$, and how many of the lines count as independent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weighing {
    /// $c$.
    pub relative: f64,
    /// Part of the lines that counts.
    pub independent: f64,
}

/// A hypothesis at its minimum.
#[derive(Clone)]
pub(super) struct AccelerancesFit {
    pub state: State,
    pub parameters: Vec<f64>,
    /// $\sum((f_{cal}-f_{exp})/s)^2$ over the resonances.
    pub resonances: f64,
    /// Mean $|H_{cal}-H_{exp}|^2/\overline{|H|^2}$ of the lines between them.
    pub missed: f64,
    pub size: usize,
}

const FIRST: Weighing = Weighing { relative: 0.1, independent: 0.1 };
/// The least that is ever missed: models of panels are no better.
pub(super) const LEAST: f64 = 1e-4;
/// Part of each frequency by which the resonances are blunted on the way from a start.
pub(super) const BLUNT: [f64; 3] = [1e-2, 1e-3, TUNED];
/// Modes that resonators bring, at most.
const MOST_OWN: usize = 2;
/// Step of the differences of natural frequencies, in logarithms or parts of a range.
const STEP: f64 = 1e-4;

impl AccelerancesProblem {
    /// # Errors
    /// What the model refuses.
    pub(super) fn new(
        test: &ImpactTest,
        setup: ReceptanceSetup,
        resonances: Vec<Resonance>,
        between: BetweenPeaks,
        (held, usual_log_zeta): ([Option<f64>; 2], f64),
    ) -> Result<Self, ModelError> {
        let mut places: Vec<(Place, Vec<usize>)> = Vec::new();
        for (index, resonance) in resonances.iter().enumerate() {
            match places.iter_mut().find(|(place, _)| *place == resonance.response_at) {
                Some((_, own)) => own.push(index),
                None => places.push((resonance.response_at, vec![index])),
            }
        }
        let places = places.into_iter().map(|(place, own)| {
            let setting = EffectSetting {
                piece: test.pieces[0].piece,
                boundary: test.boundary,
                suspension: test.suspension.clone(),
                record: RecordSetting { number: 1, response_at: Some(place), ..RecordSetting::default() },
            };
            let count = own.iter().map(|&index| resonances[index].mode + 1).max().unwrap_or(1) + MOST_OWN;
            Ok((NaturalFrequencies::new(&setting, count)?, own))
        });
        let places = places.collect::<Result<_, ModelError>>()?;
        let (lines, weighing, work) = (vec![], FIRST, SearchWork::default());
        let mut problem = Self { setup, between, resonances, places, held, usual_log_zeta, lines, weighing, work };
        problem.weigh(FIRST);
        Ok(problem)
    }

    /// Weighs the lines by what a fit leaves of them.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn weigh_by(&mut self, fit: &AccelerancesFit) -> Result<(), ModelError> {
        let relative = fit.missed.sqrt().max(LEAST);
        let independent = independent_part(&self.residuals(&fit.state)?);
        self.weigh(Weighing { relative, independent });
        Ok(())
    }

    fn weigh(&mut self, weighing: Weighing) {
        self.weighing = weighing;
        let between = &self.between;
        let records = between.frequency.iter().zip(&between.value).zip(&between.noise).enumerate();
        let lines = records.filter_map(|(index, ((frequency, value), noise))| {
            let record = self.setup.setting(index)?.record;
            let variance = between.level.iter().zip(noise);
            let decay_rate = between.decay_rate.get(index).copied().unwrap_or_default();
            Some(WidenedLines {
                force_at: record.force_at?,
                response_at: record.response_at?,
                s: frequency.iter().map(|f| Complex64::new(decay_rate, f * std::f64::consts::TAU)).collect(),
                value: value.clone(),
                variance: variance.map(|(level, noise)| weighing.relative.powi(2) * level + noise).collect(),
                by_force: vec![],
                scatter: None,
                hits: vec![],
                noise: OnceLock::new(),
            })
        });
        self.lines = lines.collect();
    }

    fn problem<'a>(&'a self, lines: &'a [WidenedLines]) -> RecordProblem<'a> {
        let Self { setup, held, usual_log_zeta, work, .. } = self;
        // No damping is free here.
        let prior = DampingPrior { about: &[], std: f64::INFINITY, beyond: f64::INFINITY };
        let (held, usual_log_zeta) = (*held, *usual_log_zeta);
        RecordProblem {
            setup,
            records: lines,
            held,
            free_damping: false,
            usual_log_zeta,
            prior,
            rough: None,
            work,
            reactions: None,
            known: None,
        }
    }

    /// The fit's own lines and those of the data, over the root of their level, record by record.
    pub(super) fn residuals(&self, state: &State) -> Result<Vec<Vec<Complex64>>, ModelError> {
        let model = self.problem(&self.lines).lines(state)?;
        let missed = self.lines.iter().zip(model).map(|(record, model)| {
            let pairs = record.value.iter().zip(model).zip(&self.between.level);
            pairs.map(|((measured, model), level)| (measured - model) / level.sqrt()).collect()
        });
        Ok(missed.collect())
    }

    /// $\sqrt{\sum|H^{cal}-H^{exp}|^2/\sum|H^{exp}|^2}$ over all lines of all records together.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn part_missed(&self, state: &State) -> Result<f64, ModelError> {
        let residuals = self.residuals(state)?;
        let by_level = residuals.iter().flat_map(|record| record.iter().zip(&self.between.level));
        let missed: f64 = by_level.map(|(residual, level)| residual.norm_sqr() * level).sum();
        let whole: f64 = self.between.value.iter().flatten().map(Complex64::norm_sqr).sum();
        Ok((missed / whole.max(f64::MIN_POSITIVE)).sqrt())
    }

    /// $f_{cal}/f_{exp} - 1$ of every resonance. A resonator has a mode of its own, before or behind which the panel's may be.
    pub(super) fn frequency_errors(&self, state: &State) -> Result<Vec<f64>, ModelError> {
        let states = state.hypothesis.states(self.lines.len())?;
        let constants = state.constants.map(f64::exp);
        let mut errors = vec![f64::NAN; self.resonances.len()];
        let own_modes = state.hypothesis.own_modes().min(MOST_OWN);
        for (frequencies, own) in &self.places {
            let found = frequencies.at(&constants, &states)?;
            for &index in own {
                let Resonance { mode, frequency, .. } = self.resonances[index];
                let beside = found.iter().skip(mode).take(1 + own_modes).map(|found| found / frequency - 1.0);
                let nearest = beside.min_by(|a, b| a.abs().total_cmp(&b.abs()));
                errors[index] = nearest.ok_or(ModelError::Eigenproblem)?;
            }
        }
        Ok(errors)
    }

    /// The sum of squares of all resonances, each beside an error of `blunt` of its frequency.
    fn of_resonances(&self, parameters: &[f64], like: &State, blunt: f64) -> Result<Quadratic, ModelError> {
        let problem = self.problem(&self.lines);
        let errors = |parameters: &[f64]| self.frequency_errors(&problem.state(parameters, like));
        let (here, bounds) = (errors(parameters)?, problem.bounds(like));
        let constants = parameters.len() - like.hypothesis.size();
        // The channel moves no resonance.
        let owners = like.hypothesis.each_free().map(|(on, _)| on.effect.owner() != Owner::Channel);
        let by = std::iter::repeat_n(true, constants).chain(owners).enumerate().map(|(index, moves)| {
            if !moves {
                return Ok(vec![0.0; here.len()]);
            }
            let mut at = parameters.to_vec();
            let (low, high) = bounds[index];
            let step = STEP * (high - low).min(1.0);
            at[index] += if at[index] + step <= high { step } else { -step };
            let step = at[index] - parameters[index];
            Ok(errors(&at)?.iter().zip(&here).map(|(there, here)| (there - here) / step).collect())
        });
        let by = by.collect::<Result<Vec<Vec<f64>>, ModelError>>()?;
        let mut sum = Quadratic::zero(parameters.len());
        for (row, (error, resonance)) in here.iter().zip(&self.resonances).enumerate() {
            let std = resonance.std.hypot(blunt);
            let derivatives: Vec<(usize, f64)> = by.iter().enumerate().map(|(i, by)| (i, by[row] / std)).collect();
            sum.add_row(error / std, &derivatives);
        }
        sum.mirror();
        Ok(sum)
    }

    /// Resonances and lines together.
    pub(super) fn linearise(&self, parameters: &[f64], like: &State, blunt: f64) -> Result<Quadratic, ModelError> {
        let resonances = self.of_resonances(parameters, like, blunt)?;
        let lines = self.problem(&self.lines).linearise(parameters, like)?;
        Ok(total(&[resonances, scaled(lines, self.weighing.independent)]))
    }

    pub(super) fn parameters(&self, state: &State) -> Vec<f64> {
        self.problem(&self.lines).parameters(state)
    }

    /// The minimum near `state`.
    pub(super) fn fit(&self, state: &State, ending: Ending) -> Result<AccelerancesFit, IdentifyError> {
        self.settle(self.descended(state, TUNED, ending)?)
    }

    /// The minimum to which a start leads that may be far off: resonances known to 1e-5 make a valley too narrow to follow, blunt ones do not.
    pub(super) fn led(&self, state: &State, ending: Ending) -> Result<AccelerancesFit, IdentifyError> {
        let mut state = state.clone();
        for blunt in BLUNT {
            state = self.descended(&state, blunt, ending)?;
        }
        self.settle(state)
    }

    fn descended(&self, state: &State, blunt: f64, ending: Ending) -> Result<State, IdentifyError> {
        let problem = self.problem(&self.lines);
        let (start, bounds) = (problem.parameters(state), problem.bounds(state));
        let searched = descend(|p: &[f64]| self.linearise(p, state, blunt), &start, &bounds, ending);
        let (minimum, _) = searched.map_err(IdentifyError::refused)?;
        Ok(problem.state(&minimum.parameters, state))
    }

    fn settle(&self, state: State) -> Result<AccelerancesFit, IdentifyError> {
        let errors = self.frequency_errors(&state)?;
        let resonances =
            errors.iter().zip(&self.resonances).map(|(error, of)| (error / of.std.hypot(TUNED)).powi(2)).sum();
        let residuals = self.residuals(&state)?;
        let missed = residuals.iter().flatten().map(Complex64::norm_sqr).sum::<f64>() / self.between.count() as f64;
        let parameters = self.parameters(&state);
        Ok(AccelerancesFit { size: parameters.len(), parameters, resonances, missed, state })
    }

    /// The sum of squares of the lines of each gap, and last that of the resonances.
    pub(super) fn by_gap(&self, fit: &AccelerancesFit) -> Result<Vec<Quadratic>, ModelError> {
        let gaps = self.between.gap.last().map_or(0, |last| last + 1);
        let mut sums = Vec::new();
        for gap in 0..gaps {
            let own: Vec<usize> = (0..self.between.gap.len()).filter(|&at| self.between.gap[at] == gap).collect();
            let part = |record: &WidenedLines| WidenedLines {
                s: own.iter().map(|&at| record.s[at]).collect(),
                value: own.iter().map(|&at| record.value[at]).collect(),
                variance: own.iter().map(|&at| record.variance[at]).collect(),
                noise: OnceLock::new(),
                ..record.clone()
            };
            let lines: Vec<WidenedLines> = self.lines.iter().map(part).collect();
            let sum = self.problem(&lines).by_group(&fit.parameters, &fit.state, Grouping::Places)?;
            sums.push(scaled(total(&sum), self.weighing.independent));
        }
        sums.push(self.of_resonances(&fit.parameters, &fit.state, TUNED)?);
        Ok(sums)
    }
}

fn scaled(mut sum: Quadratic, by: f64) -> Quadratic {
    sum.cost *= by;
    sum.gradient.iter_mut().for_each(|slope| *slope *= by);
    sum.normal *= faer::Scale(by);
    sum
}
