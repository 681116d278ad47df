//! Hypotheses: nothing missing, each effect, and more while the evidence grows.

mod approach;
mod detectable;
mod further_effect;
mod in_lists;
mod net_on_plate;
mod shared_place;

use std::collections::HashSet;
use std::f64::consts::TAU;

use faer::Mat;
use orthopanel_model::{
    Action, Effect, EffectParameter, EffectSetting, ModelError, Scale, StructureKind, catalogue, natural_frequencies,
};
use rayon::prelude::*;

use approach::{Approach, Ranked};

use crate::comparison::Comparison;
use crate::effect_places::{OF_PIECE, OF_RECORD, has_place, is_of_record};
use crate::free_constants::FreeConstants;
use crate::hit_strength::{HitStrength, Springs};
use crate::hypothesis::{Hypothesis, Part, Role};
use crate::judge::{ODDS, log_prior};
use crate::measured::MeasuredModes;
use crate::model_error::{KINDS, Kind, frequency_prior, medians, waves};
use crate::plate_start::PlateStart;
use crate::posterior::{Following, Judged, Point, Posterior, Problem};
use crate::predicted::{Prediction, Predictor};
use crate::search_progress::SearchProgress;
use crate::shapes_of_list::NamedLists;
use crate::shared_error::SharedError;
use crate::stacked::{Block, Stacked};

/// $\ln\tau_k$ with which starts are judged: wide, so that far ones have a slope to follow.
const LOOSE: [f64; KINDS] = [
    5e-3, 5e-2, 2e-2, 0.1, 1e-3, 5e-3, 5e-4, 5e-3, 5e-2, 0.2, 1e-2, 1e-2, 5e-3, 5e-3, 5e-3, 5e-3, 5e-3, 5e-3, 5e-3,
    5e-3, 5e-3, 5e-3,
];
/// and from which the sizes are estimated: from the sizes of too poor a hypothesis effects drown.
const SMALL: [f64; KINDS] = [
    3e-4, 2e-3, 1e-3, 3e-2, 8e-4, 3e-3, 4e-4, 3e-3, 1e-2, 5e-2, 4e-3, 4e-3, 3e-3, 1e-3, 2e-3, 2e-3, 1e-3, 5e-4, 1e-3,
    1e-3, 5e-4, 3e-4,
];
/// Ratios $E/G$ at which the constants are looked for.
const RATIOS: usize = 28;
/// Starts that are followed.
const FOLLOWED: usize = 3;
/// How far a hypothesis may be behind the best, in logarithms of [`ODDS`], to be looked at more closely,
const NEAR: f64 = 2.0;
/// and for more effects to be looked for in what it has left.
const BESIDE: f64 = 1.0;
/// Limit of rounds for a posterior followed to convergence: where an effect explains much, sizes of model error fall by orders of magnitude.
const TO_THE_END: usize = 40;
/// Hypotheses to which further effects are added: the likeliest, and where no effect by itself explains a list those that miss it least.
const FROM: usize = 2;
/// Effects at most, beside those declared.
const MOST_EFFECTS: usize = 3;

const ONE_RECORD: &str = "one record has no other to differ from";
const BY_LEVEL_OF_PIECE: &str =
    "how hits of unequal strength differ is looked at of one piece alone: trace one piece in a test file";

/// All that is the same for every hypothesis.
pub(crate) struct Inquiry<'a> {
    pub stacked: Stacked<'a>,
    /// The hits, where the test has any.
    pub hits: Option<HitStrength>,
    /// What a panel of the same make shows of the model's error.
    pub shared_error: Option<SharedError>,
    /// What is said of the shapes of a plate's lists.
    pub of_lists: NamedLists,
    /// How far it is.
    pub progress: SearchProgress<'a>,
}

/// A base with one effect more, which lacks in one of so many ways alike. The least of an effect that is looked for is none: what is gained there is what its
/// presence adds to the model error. For a factor, whose null value is one, the gain is at most the Savage-Dickey density ratio there (Dickey, Ann. Math.
/// Stat. 42 (1971) 204): another basis may come with it, and what that gains is no effect.
pub(crate) fn with_one_more(base: &Judged, hypothesis: Hypothesis, posterior: Posterior, ways: usize) -> Judged {
    let last = hypothesis.parts.last().zip(hypothesis.of_parts(&posterior.point.z).last().copied());
    // A declared effect whose numbers are doubted is there.
    let added = last.filter(|(part, z)| part.role == Role::Found && !z.is_empty());
    let most = added.map_or(f64::INFINITY, |(part, z)| {
        let place = posterior.point.z.len() - z.len();
        let by_density = || part.gain_beside_none(z, posterior.covariance[(place, place)].sqrt());
        if part.is_least(z) { 0.0 } else { by_density().unwrap_or(f64::INFINITY) }
    });
    let gain = (posterior.log_evidence - base.posterior.log_evidence).min(most);
    Judged { hypothesis, posterior, log_odds: base.log_odds + gain + log_prior(ways) }
}

/// Whether effects of a list that explain nothing by themselves are tried in pairs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pairs(pub bool);

/// The model error of a frequency that a hypothesis leaves.
fn missed(judged: &Judged) -> f64 {
    judged.posterior.log_sizes[Kind::Frequency as usize].exp()
}

fn logs(sizes: [f64; KINDS]) -> [f64; KINDS] {
    sizes.map(f64::ln)
}

/// Constants that fit the frequencies alone, the likeliest first.
fn starting_constants(block: &Block, constants: &FreeConstants) -> Result<Vec<Vec<f64>>, ModelError> {
    match block.predictor.structure {
        StructureKind::TimoshenkoBeam => {
            Ok(constants_of_beam(block, usize::MAX)?.into_iter().map(|values| values.to_vec()).collect())
        }
        StructureKind::MindlinPlate => {
            let setting = block.predictor.setting(0);
            let held = std::array::from_fn(|constant| constants.held[constant]);
            let start = PlateStart::new(block.comparison().measured, (setting.piece, setting.boundary), held);
            Ok(start.constants()?.into_iter().take(FOLLOWED).map(|(_, values)| values.to_vec()).collect())
        }
    }
}

/// Constants of a beam that fit the frequencies alone, the likeliest first: at each ratio $E/G$ the scale that puts most poles near modes.
/// Of the `lowest` poles.
fn constants_of_beam(block: &Block, lowest: usize) -> Result<Vec<[f64; 2]>, ModelError> {
    let (measured, setting) = (block.comparison().measured, block.predictor.setting(0));
    let poles: Vec<f64> = measured.poles.iter().take(lowest).map(|pole| pole.angular_frequency / TAU).collect();
    let top = poles.last().copied().unwrap_or(0.0);
    let mut found: Vec<(f64, [f64; 2])> = Vec::new();
    for step in 0..RATIOS {
        let ratio = 2.0 * (step as f64 / (RATIOS - 1) as f64 * 300f64.ln()).exp();
        let values = [1e10, 1e10 / ratio];
        let modes = natural_frequencies(&setting, &values, &[], poles.len() + 6)?;
        // Below the first mode may lie any number of poles: springs that are not linear have several where a linear one has one.
        for (pole, mode) in (0..poles.len()).flat_map(|pole| (0..modes.len().min(3)).map(move |mode| (pole, mode))) {
            let scale = poles[pole] / modes[mode];
            let apart = |pole: &f64| modes.iter().map(|mode| (pole / (scale * mode)).ln().powi(2)).fold(0.01, f64::min);
            let missed: f64 = poles.iter().filter(|pole| **pole > 0.5 * scale * modes[0]).map(apart).sum();
            let flexible = poles.iter().filter(|pole| **pole > 0.5 * scale * modes[0]).count();
            let below = modes.iter().filter(|mode| scale * **mode < 1.02 * top).count();
            let cost = missed + 0.004 * below.abs_diff(flexible) as f64;
            found.push((cost, values.map(|value| value * scale * scale)));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Vec<[f64; 2]> = Vec::new();
    for (_, values) in found {
        if best.iter().all(|other| (other[0] / values[0]).ln().abs() + (other[1] / values[1]).ln().abs() > 0.05) {
            best.push(values);
        }
        if best.len() == 2 * FOLLOWED {
            break;
        }
    }
    Ok(best)
}

/// What the measured remainders are over those predicted, all together.
fn larger(comparison: &Comparison, at: &Prediction) -> f64 {
    let numbers = at.near_hanging..comparison.measured.remainder_frequencies.len();
    let square = |values: &[f64]| -> f64 {
        let places = (0..comparison.measured.records.len())
            .flat_map(|record| numbers.clone().map(move |number| comparison.remainder_place(record, number)));
        places.map(|place| values[place].powi(2) + values[place + 1].powi(2)).sum()
    };
    (square(&comparison.values) / square(&at.values)).sqrt()
}

impl<'a> Inquiry<'a> {
    /// With nothing missing: the base from which all begin.
    pub(crate) fn begin(
        stacked: Stacked<'a>,
        constants: &FreeConstants,
        declared: &[Part],
        of_lists: NamedLists,
    ) -> Result<Option<(Self, Judged)>, ModelError> {
        let progress = SearchProgress::default();
        let mut inquiry = Self { stacked, hits: None, shared_error: None, of_lists, progress };
        // Records tell the modes of a plate apart.
        let is_by_shape = inquiry.stacked.is_of_plates() && !inquiry.measured().records.is_empty();
        let first = if is_by_shape { inquiry.stacked.first() } else { inquiry.stacked.longest() };
        let starts = match &inquiry.of_lists.near {
            Some(near) => vec![near.clone()],
            None => starting_constants(first, constants)?,
        };
        let poles = inquiry.stacked.longest().comparison().measured.poles.iter();
        let hertz: Vec<f64> = poles.map(|pole| pole.angular_frequency / TAU).collect();
        let mut best: Option<(f64, Hypothesis, Point)> = None;
        for start in starts {
            let hypothesis = Hypothesis::new(
                constants,
                &start,
                declared,
                (inquiry.predictor().piece(), inquiry.predictor().structure),
            );
            let problem = inquiry.problem(&hypothesis);
            let mut nets: Vec<Vec<f64>> = vec![vec![0.0; hypothesis.free_constants()]];
            for part in &hypothesis.parts {
                let starts = part.starts(|_, _| hertz.clone());
                nets = nets.iter().flat_map(|net| starts.iter().map(|start| [&net[..], start].concat())).collect();
            }
            let Some(Ok(mut at)) = nets.first().map(|first| problem.at(first)) else { continue };
            // A sensitivity that is open may be any, and is told at once.
            if let Some(z) = hypothesis.multiplied(&nets[0], larger(inquiry.comparison(), at.first())) {
                let Ok(there) = problem.at(&z) else { continue };
                (at, nets[0]) = (there, z);
            }
            // Modes first: a remainder near the resonances of cords leads nowhere from afar.
            let errors = problem.errors(&at);
            let Some(modes) = problem.whitening_of_modes(&errors, &logs(LOOSE)) else { continue };
            let points = nets.into_iter().filter_map(|net| problem.point(net, &modes));
            let Some(point) = points.min_by(|a, b| a.misfit.total_cmp(&b.misfit)) else { continue };
            let Some((point, _)) = problem.follow(point, &modes, Following::to_the_end(12, 0.1)) else { continue };
            let misfit = point.misfit + modes.log_determinant;
            if best.as_ref().is_none_or(|(least, ..)| misfit < *least) {
                best = Some((misfit, hypothesis, point));
            }
        }
        let Some((_, hypothesis, point)) = best else { return Ok(None) };
        for block in &mut inquiry.stacked.blocks {
            let (constants, effects) = block.values(&hypothesis, &point.z)?;
            block.waves = waves(&block.predictor, &constants, &effects)?;
        }
        Ok(inquiry.with_base(hypothesis, point))
    }

    /// The base from which all begin, near a point.
    fn with_base(mut self, hypothesis: Hypothesis, point: Point) -> Option<(Self, Judged)> {
        for (block, at) in self.stacked.blocks.iter_mut().zip(&point.at.blocks) {
            block.predictor.hanging = Some(at.hanging);
        }
        // Here sizes first: small ones would lead the constants away where an effect is large.
        let problem = self.problem(&hypothesis);
        let errors = problem.errors(&point.at);
        let sizes = problem.sizes(&point.at, &errors, logs(SMALL), 12).map_or(logs(LOOSE), |(sizes, ..)| sizes);
        let from = [sizes, logs(SMALL), medians()];
        let posteriors = from.into_iter().filter_map(|sizes| problem.posterior(point.clone(), sizes, TO_THE_END));
        let posterior = posteriors.max_by(|a, b| a.log_evidence.total_cmp(&b.log_evidence))?;
        let log_odds = posterior.log_evidence;
        Some((self, Judged { hypothesis, posterior, log_odds }))
    }

    pub(crate) fn problem<'p>(&'p self, hypothesis: &'p Hypothesis) -> Problem<'p> {
        Problem { stacked: &self.stacked, hypothesis }
    }

    /// What predicts the first block: the records, where there are any.
    pub(crate) fn predictor(&self) -> &Predictor<'a> {
        &self.stacked.first().predictor
    }

    fn comparison(&self) -> &'a Comparison<'a> {
        self.stacked.first().comparison()
    }

    /// The modes of the first block: the records, where there are any.
    pub(crate) fn measured(&self) -> &'a MeasuredModes {
        self.comparison().measured
    }

    fn ways(&self, effect: &'static dyn Effect) -> Vec<Part> {
        Part::ways(effect, (self.predictor().piece(), self.predictor().structure), self.measured().records.len())
    }

    /// The posterior once more, to its end, from its own sizes of model error and from those of the best.
    fn closer(&self, judged: &Judged, best: &[f64; KINDS]) -> Judged {
        let problem = self.problem(&judged.hypothesis);
        let mut closer = judged.clone();
        let own = judged.posterior.log_sizes;
        for sizes in std::iter::once(own).chain((*best != own).then_some(*best)) {
            let Some(posterior) = problem.posterior(judged.posterior.point.clone(), sizes, TO_THE_END) else {
                continue;
            };
            if posterior.log_evidence > closer.posterior.log_evidence {
                closer.log_odds += posterior.log_evidence - closer.posterior.log_evidence;
                closer.posterior = posterior;
            }
        }
        closer
    }

    /// Why the test cannot show an effect, whatever its numbers; `None` where it can.
    pub(crate) fn hidden(&self, effect: &dyn Effect) -> Option<String> {
        if let Some(why) = self.hidden_on_plates(effect) {
            return Some(why.to_owned());
        }
        if self.is_of_lists() {
            return self.hidden_in_lists(effect);
        }
        let is_of_several_pieces = self.stacked.is_of_several_pieces();
        // The gain of the only record is the gain.
        let is_of_one = || effect.parameters().iter().any(|parameter| parameter.scale == Scale::Index);
        let why = if self.stacked.recorded().nth(1).is_some() && is_of_record(effect) {
            OF_RECORD
        } else if is_of_several_pieces && has_place(effect) {
            OF_PIECE
        } else if is_of_several_pieces && self.shows_between_hits(effect) {
            BY_LEVEL_OF_PIECE
        } else if is_of_one() && self.measured().records.len() < 2 {
            ONE_RECORD
        } else {
            return None;
        };
        Some(why.to_owned())
    }

    /// Why an effect is not looked for on a plate.
    fn hidden_on_plates(&self, effect: &dyn Effect) -> Option<&'static str> {
        let is_plate = self.predictor().structure == StructureKind::MindlinPlate;
        let makes_one = |action: &Action| matches!(action, Action::Plate(_));
        (is_plate && self.acts(effect).ok()?.iter().any(makes_one)).then_some("the test file declares a plate")
    }

    /// Whether a base on a plate misses by more than modes and poles lie apart: it may have been led away.
    pub(crate) fn is_led_away(&self, base: &Judged) -> bool {
        self.is_plate() && base.posterior.log_sizes[Kind::Frequency as usize].exp() > self.predictor().apart
    }

    /// Every effect of the catalogue added to a base, but those sets that were `seen`, the likeliest first.
    fn each_effect(&self, base: &Judged, seen: &mut Vec<Vec<&'static str>>) -> Vec<Judged> {
        // Of a declared effect with a place there may be one more.
        let is_another = |part: &Part| part.role == Role::Declared && has_place(part.effect);
        let has = |id: &str| base.hypothesis.parts.iter().any(|part| part.effect.id() == id && !is_another(part));
        let mut is_new = |id: &'static str| {
            let mut names = [base.names(), vec![id]].concat();
            names.sort_unstable();
            let new = !seen.contains(&names);
            seen.push(names);
            new
        };
        let effects: Vec<&'static dyn Effect> = catalogue()
            .iter()
            .copied()
            .filter(|effect| self.hidden(*effect).is_none() && !self.shows_between_hits(*effect))
            .filter(|effect| !has(effect.id()) && is_new(effect.id()))
            .collect();
        self.progress.more(effects.len());
        let ranked = |effect: &&'static dyn Effect| (*effect, self.ranked(base, *effect));
        let ranked: Vec<_> = effects.par_iter().map(ranked).collect();
        let gains = ranked.iter().filter_map(|(_, ranked)| Some(ranked.as_ref()?.gain()));
        let most = if self.is_plate() { gains.fold(0.0, f64::max) } else { 0.0 };
        let approached = |(effect, ranked): (&'static dyn Effect, Option<Ranked>)| {
            (effect, ranked.and_then(|ranked| self.approached(base, ranked.without_minor(most))))
        };
        let approached: Vec<(&'static dyn Effect, Option<Approach>)> = ranked.into_par_iter().map(approached).collect();
        let most = approached.iter().filter_map(|(_, approach)| Some(approach.as_ref()?.gain())).fold(0.0, f64::max);
        let added = |(effect, approach): (&'static dyn Effect, Option<Approach>)| {
            let judged = approach.and_then(|approach| self.followed(base, approach, most));
            self.progress.tried(effect.id());
            judged
        };
        let mut judged: Vec<(Judged, bool)> = approached.into_par_iter().filter_map(added).collect();
        judged.extend(self.at_found_place(base, &effects, &judged));
        judged.sort_by(|(a, _), (b, _)| b.log_odds.total_cmp(&a.log_odds));
        let mut ids = HashSet::new();
        judged.retain(|(judged, _)| judged.names().last().is_none_or(|id| ids.insert(*id)));
        let Some((best, _)) = judged.first() else { return vec![] };
        let best = (best.log_odds, best.posterior.log_sizes);
        let closer = |(one, is_promising): (Judged, bool)| {
            let is_near = is_promising && one.log_odds > best.0 - NEAR * ODDS.ln();
            if is_near { self.closer(&one, &best.1) } else { one }
        };
        let mut judged: Vec<Judged> = judged.into_par_iter().map(closer).collect();
        judged.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        judged
    }

    /// A hypothesis without each of its undeclared effects in turn, from where it ends: what was added first may not be needed with what came
    /// after.
    fn each_left_out(&self, of: &Judged, seen: &mut Vec<Vec<&'static str>>) -> Vec<Judged> {
        let undeclared = |part: &usize| of.hypothesis.parts[*part].role == Role::Found;
        let parts: Vec<usize> = (0..of.hypothesis.parts.len()).filter(undeclared).collect();
        let left_out = |part: usize| {
            let (hypothesis, z) = of.hypothesis.without(part, &of.posterior.point.z);
            let problem = self.problem(&hypothesis);
            let posterior = problem.posterior(problem.unjudged(z)?, of.posterior.log_sizes, TO_THE_END)?;
            let priors = hypothesis.undeclared().map(|part| log_prior(self.ways(part.effect).len()));
            let log_odds = posterior.log_evidence + priors.sum::<f64>();
            Some(Judged { hypothesis, posterior, log_odds })
        };
        let mut fewer: Vec<Judged> = parts.into_par_iter().filter_map(left_out).collect();
        fewer.retain(|judged| !judged.names().is_empty());
        seen.extend(fewer.iter().map(Judged::set));
        fewer
    }

    /// What an effect does at usual values, in the first block where it does anything.
    ///
    /// # Errors
    /// What the test lacks for it.
    pub(crate) fn acts(&self, effect: &dyn Effect) -> Result<Vec<Action>, ModelError> {
        // Some lists may tell where a sensor sat, and others not.
        let mut acts = self.stacked.blocks.iter().map(|block| self.acts_in(effect, &block.predictor.setting(0)));
        let first = acts.next().unwrap_or(Ok(vec![]));
        if first.as_ref().is_ok_and(|first| !first.is_empty()) {
            return first;
        }
        acts.find(|acts| acts.as_ref().is_ok_and(|acts| !acts.is_empty())).unwrap_or(first)
    }

    /// The same in a setting.
    fn acts_in(&self, effect: &dyn Effect, setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        let piece = &setting.piece;
        let value = |parameter: &EffectParameter| {
            parameter.held_at.or_else(|| parameter.starts(piece).first().copied()).unwrap_or_default()
        };
        let values: Vec<f64> = effect.parameters().iter().map(value).collect();
        effect.act(&values, setting)
    }

    /// Whether an effect leaves modes as they are, and shows between hits of unequal strength.
    fn shows_between_hits(&self, effect: &dyn Effect) -> bool {
        self.acts(effect).is_ok_and(|acts| acts.is_empty())
    }

    /// The hypotheses that are not clearly behind, with what hits of unequal strength show: on the likeliest it is worked out once for all.
    ///
    /// What is not linear has a linear part in the mean over hits ([`Effect::linearised`]). A hypothesis that holds it may say that it is no effect of
    /// its own: then it has no prior odds of its own either, and hits are held against the panel without it.
    fn with_strength(&self, all: &[Judged]) -> Option<Vec<Judged>> {
        let (hits, best) = (self.hits.as_ref()?, all.first()?);
        let effect = catalogue().iter().copied().find(|effect| self.shows_between_hits(*effect))?;
        if best.hypothesis.parts.iter().any(|part| part.effect.id() == effect.id()) {
            return None;
        }
        let ways = self.ways(effect);
        let part = ways.first()?;
        let springs = |of: &Hypothesis, z: &[f64]| {
            let (constants, effects) = self.stacked.first().values(of, z).ok()?;
            let k3 = |z: f64| part.values(&[z]).first().copied().unwrap_or_default();
            hits.springs(self.predictor(), (&constants, &effects), k3).ok()?
        };
        let with = |judged: &Judged, hypothesis: Hypothesis, springs: Springs| {
            let hypothesis = hypothesis.with(part.clone());
            let z = [&judged.posterior.point.z[..], &[springs.z]].concat();
            let size = z.len();
            let own = &judged.posterior.covariance;
            let covariance = Mat::from_fn(size, size, |i, j| match (i + 1 < size, j + 1 < size) {
                (true, true) => own[(i, j)],
                (false, false) => springs.variance,
                _ => 0.0,
            });
            let point = Point { z, derivatives: Mat::new(), ..judged.posterior.point.clone() };
            let log_evidence = judged.posterior.log_evidence + springs.log_evidence;
            let posterior = Posterior { point, covariance, log_evidence, ..judged.posterior.clone() };
            let log_odds = judged.log_odds + springs.log_evidence + log_prior(ways.len());
            Judged { hypothesis, posterior, log_odds }
        };
        let near: Vec<&Judged> =
            all.iter().filter(|judged| best.log_odds - judged.log_odds < BESIDE * ODDS.ln()).collect();
        let mut found: Vec<Judged> = Vec::new();
        if let Some(springs) = springs(&best.hypothesis, &best.posterior.point.z) {
            found.extend(near.iter().map(|judged| with(judged, judged.hypothesis.clone(), springs)));
        }
        let Some(linear) = effect.linearised() else { return Some(found) };
        let held = |judged: &&Judged| {
            let is_linear = |part: &Part| part.role == Role::Found && part.effect.id() == linear.id();
            judged.hypothesis.parts.iter().position(is_linear)
        };
        let holding: Vec<(&Judged, usize)> = near.iter().filter_map(|judged| Some((*judged, held(judged)?))).collect();
        if let Some((likeliest, number)) = holding.first()
            && let (without, z) = likeliest.hypothesis.without(*number, &likeliest.posterior.point.z)
            && let Some(springs) = springs(&without, &z)
        {
            found.extend(holding.iter().map(|(judged, number)| {
                let mut hypothesis = judged.hypothesis.clone();
                hypothesis.parts[*number].role = Role::Linearised;
                let mut with = with(judged, hypothesis, springs);
                with.log_odds -= log_prior(self.ways(linear).len());
                with
            }));
        }
        Some(found)
    }

    /// Whether pairs of effects are looked for though none by itself explains a list: where its frequencies are missed by more than two of three sound
    /// panels miss theirs. Records show shapes too, in which single effects stand out.
    fn wants_pairs(&self, base: &Judged) -> bool {
        let (median, factor) = frequency_prior();
        self.is_of_lists() && missed(base) > factor * median
    }

    /// All hypotheses that were looked at, the likeliest first.
    pub(crate) fn search(&self, base: Judged, pairs: Pairs) -> Vec<Judged> {
        let mut all = vec![base];
        let (mut from, mut seen) = (vec![all[0].clone()], vec![]);
        for round in 0..MOST_EFFECTS {
            let mut added: Vec<Judged> = Vec::new();
            let before = all.iter().map(|judged| judged.log_odds).fold(f64::NEG_INFINITY, f64::max);
            for base in &from {
                added.extend(self.each_effect(base, &mut seen));
            }
            added.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
            if added.first().is_some_and(|best| best.log_odds > before && best.names().len() > 1) {
                let fewer = self.each_left_out(&added[0].clone(), &mut seen);
                // What was looked for beside a worse end of the same hypothesis is looked for again.
                for found in &fewer {
                    let names = found.set();
                    let same = all.iter().filter(|other| other.set() == names);
                    let known = same.map(|other| other.log_odds).fold(f64::NEG_INFINITY, f64::max);
                    if found.log_odds > known + ODDS.ln() {
                        seen.retain(|set| set.len() <= names.len() || names.iter().any(|name| !set.contains(name)));
                    }
                }
                added.extend(fewer);
                added.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
            }
            let grown = added.first().is_some_and(|best| best.log_odds > before + ODDS.ln());
            // Two effects may do little each by itself.
            let in_pairs = pairs.0 && round == 0 && !grown && self.wants_pairs(&all[0]);
            let near = |judged: &&Judged| judged.log_odds > added[0].log_odds - BESIDE * ODDS.ln();
            let mut near: Vec<&Judged> = added.iter().filter(near).collect();
            if in_pairs {
                near.sort_by(|a, b| missed(a).total_cmp(&missed(b)));
            }
            from = near.into_iter().take(FROM).cloned().collect();
            all.extend(added);
            if !grown && !in_pairs {
                break;
            }
        }
        all.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        all.extend(self.with_strength(&all).unwrap_or_default());
        all.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        all
    }
}
