//! Hypotheses: nothing missing, each effect, and more while the evidence grows.

use std::f64::consts::TAU;

use orthopanel_model::{Effect, EffectSetting, ModelError, StructureKind, catalogue, natural_frequencies};
use rayon::prelude::*;

use crate::comparison::Comparison;
use crate::hypothesis::{Hypothesis, Part};
use crate::judge::{MOST_FREQUENCY, ODDS};
use crate::model_error::{KINDS, Kind, Waves, medians, waves};
use crate::posterior::{Judged, Point, Problem, Whitening};
use crate::predicted::Predictor;

/// $\ln\tau_k$ with which starts are judged: wide, so that far ones have a slope to follow.
const LOOSE: [f64; KINDS] = [5e-3, 5e-2, 2e-2, 1e-3, 5e-3, 1e-2, 5e-4, 5e-3, 5e-3, 5e-3, 5e-3, 5e-2, 0.2];
/// and from which the sizes are estimated: from the sizes of too poor a hypothesis effects drown.
const SMALL: [f64; KINDS] = [3e-4, 2e-3, 1e-3, 8e-4, 3e-3, 4e-3, 4e-4, 3e-3, 2e-3, 1e-3, 5e-4, 1e-2, 5e-2];
/// Ratios $E/G$ at which the constants are looked for.
const RATIOS: usize = 28;
/// Numbers of the lowest poles that a plate shares with a beam: below the first that bends across.
const LOWEST_POLES: [usize; 3] = [3, 4, 6];
/// Starts that are followed.
const FOLLOWED: usize = 3;
/// How far a hypothesis may be behind the best, in logarithms of [`ODDS`], to be looked at more closely,
const NEAR: f64 = 5.0;
/// and for more effects to be looked for in what it has left.
const BESIDE: f64 = 2.0;
/// Effects at most, beside those declared.
const MOST_EFFECTS: usize = 3;

/// All that is the same for every hypothesis.
pub(crate) struct Inquiry<'a> {
    predictor: Predictor<'a>,
    waves: Waves,
}

fn logs(sizes: [f64; KINDS]) -> [f64; KINDS] {
    sizes.map(f64::ln)
}

/// Constants of a beam that fit the frequencies alone, the likeliest first: at each ratio $E/G$ the scale that puts most poles near modes.
/// Of the `lowest` poles.
fn starting_constants(
    comparison: &Comparison,
    setting: &EffectSetting,
    lowest: usize,
) -> Result<Vec<[f64; 2]>, ModelError> {
    let measured = comparison.measured;
    let poles: Vec<f64> = measured.poles.iter().take(lowest).map(|pole| pole.angular_frequency / TAU).collect();
    let top = poles.last().copied().unwrap_or(0.0);
    let mut found: Vec<(f64, [f64; 2])> = Vec::new();
    for step in 0..RATIOS {
        let ratio = 2.0 * (step as f64 / (RATIOS - 1) as f64 * 300f64.ln()).exp();
        let values = [1e10, 1e10 / ratio];
        let modes = natural_frequencies(setting, &values, &[], poles.len() + 6)?;
        for (pole, mode) in
            (0..poles.len().min(5)).flat_map(|pole| (0..modes.len().min(3)).map(move |mode| (pole, mode)))
        {
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

impl<'a> Inquiry<'a> {
    /// With nothing missing: the base from which all begin.
    pub(crate) fn begin(
        comparison: &'a Comparison<'a>,
        setting: &EffectSetting,
        held: &[Option<f64>],
        declared: &[Part],
    ) -> Result<Option<(Self, Judged)>, ModelError> {
        let predictor = Predictor::new(comparison, StructureKind::TimoshenkoBeam, setting)?;
        let records = comparison.measured.records.len();
        let mut inquiry = Self { predictor, waves: vec![] };
        let starts = starting_constants(comparison, setting, usize::MAX)?;
        let mut best: Option<(f64, Hypothesis, Vec<f64>)> = None;
        for start in starts {
            let constants: Vec<(f64, bool)> =
                start.iter().zip(held).map(|(start, held)| (held.unwrap_or(*start), held.is_some())).collect();
            let hypothesis = Hypothesis::new(&constants, declared.to_vec(), records);
            let problem = inquiry.problem(&hypothesis);
            let mut nets: Vec<Vec<f64>> = vec![vec![0.0; hypothesis.free_constants()]];
            for part in &hypothesis.parts {
                let starts = part.starts(&[]);
                nets = nets.iter().flat_map(|net| starts.iter().map(|start| [&net[..], start].concat())).collect();
            }
            let Ok(at) = problem.with_slopes(&nets[0]) else { continue };
            // Modes first: a remainder near the resonances of cords leads nowhere from afar.
            let errors = problem.errors(&at);
            let Some(modes) = problem.whitening_of_modes(&errors, &logs(LOOSE)) else { continue };
            let points = nets.into_iter().filter_map(|net| problem.point(net, &modes));
            let Some(point) = points.min_by(|a, b| a.misfit.total_cmp(&b.misfit)) else { continue };
            let Some((point, _)) = problem.follow(point, &modes, 12, 0.1) else { continue };
            let misfit = point.misfit + modes.log_determinant;
            if best.as_ref().is_none_or(|(least, ..)| misfit < *least) {
                best = Some((misfit, hypothesis, point.z));
            }
        }
        let Some((_, hypothesis, z)) = best else { return Ok(None) };
        inquiry.waves = waves(&inquiry.predictor, &hypothesis.constants(&z))?;
        // Here sizes first: small ones would lead the constants away where an effect is large.
        let problem = inquiry.problem(&hypothesis);
        let at = problem.with_slopes(&z)?;
        let sizes = problem.sizes(&at, &problem.errors(&at), logs(SMALL), 12).map_or(logs(LOOSE), |(sizes, ..)| sizes);
        let from = [sizes, logs(SMALL), medians()];
        let posteriors = from.into_iter().filter_map(|sizes| problem.posterior(z.clone(), sizes, 4));
        let judged = posteriors.max_by(|a, b| a.log_evidence.total_cmp(&b.log_evidence));
        Ok(judged.map(|posterior| {
            let log_odds = posterior.log_evidence;
            (inquiry, Judged { hypothesis, posterior, log_odds })
        }))
    }

    fn problem<'p>(&'p self, hypothesis: &'p Hypothesis) -> Problem<'p> {
        Problem { predictor: &self.predictor, hypothesis, waves: &self.waves }
    }

    /// Where the coordinates of a base stand as an effect joins it: as they are, and where that puts another structure in the place of the first,
    /// which then may have fitted it anyhow if it missed more than a real panel does, at constants that fit the lowest poles alone as well.
    fn bases(&self, base: &Judged, with: &Hypothesis) -> Vec<Vec<f64>> {
        let mut bases = vec![base.posterior.z.clone()];
        let misses = base.posterior.log_sizes[Kind::Frequency as usize].exp() > MOST_FREQUENCY;
        if misses && with.parts.last().is_some_and(|part| part.replaces_structure(&self.predictor)) {
            let (comparison, setting) = (self.predictor.comparison, self.predictor.setting(0));
            for lowest in LOWEST_POLES {
                for constants in
                    starting_constants(comparison, &setting, lowest).unwrap_or_default().into_iter().take(2)
                {
                    let mut z = base.posterior.z.clone();
                    let own = base.hypothesis.of_constants(&constants);
                    z.iter_mut().zip(own).for_each(|(z, own)| *z = own);
                    bases.push(z);
                }
            }
        }
        bases
    }

    /// An effect more, in the way and from the start that serve best: a net of starts of all ways is ranked, the best are followed with
    /// wide sizes of model error, the best of these to the posterior.
    fn with_effect(&self, base: &Judged, effect: &'static dyn Effect) -> Option<Judged> {
        let measured = self.predictor.comparison.measured;
        let resonances: Vec<f64> = measured.poles.iter().map(|pole| pole.angular_frequency / TAU).collect();
        let of_base = self.problem(&base.hypothesis);
        let errors = of_base.errors(&of_base.with_slopes(&base.posterior.z).ok()?);
        let loose = of_base.whitening(&errors, &logs(LOOSE))?;
        let small = of_base.whitening(&errors, &logs(SMALL))?;
        let based = of_base.whitening(&errors, &base.posterior.log_sizes)?;
        let ways: Vec<Hypothesis> = Part::ways(effect, self.predictor.piece(), measured.records.len())
            .into_iter()
            .map(|part| base.hypothesis.with(part))
            .collect();
        let bases = self.bases(base, &ways[0]);
        let starts = |(way, hypothesis): (usize, &Hypothesis)| {
            let problem = self.problem(hypothesis);
            let starts = hypothesis.parts.last().map_or(vec![], |part| part.starts(&resonances));
            let starts = bases.iter().flat_map(|z| starts.iter().map(|start| [&z[..], start].concat()));
            starts.filter_map(|z| problem.point(z, &loose)).map(|point| (way, point)).collect::<Vec<_>>()
        };
        let best = |mut points: Vec<(usize, Point)>, most: usize| {
            points.sort_by(|a, b| a.1.misfit.total_cmp(&b.1.misfit));
            let mut apart: Vec<(usize, Point)> = Vec::new();
            for (way, point) in points {
                let near = |(other, of): &(usize, Point)| {
                    *other == way && of.z.iter().zip(&point.z).all(|(a, b)| (a - b).abs() < 0.05)
                };
                if apart.len() < most && !apart.iter().any(near) {
                    apart.push((way, point));
                }
            }
            apart
        };
        let follow = |points: Vec<(usize, Point)>, by: &Whitening, most: usize| -> Vec<(usize, Point)> {
            let on = |(way, point): (usize, Point)| {
                let problem = self.problem(&ways[way]);
                let point = problem.point(point.z, by)?;
                problem.follow(point, by, most, 1.0).map(|(point, _)| (way, point))
            };
            points.into_iter().filter_map(on).collect()
        };
        let points = best(ways.iter().enumerate().flat_map(starts).collect(), 4 * FOLLOWED);
        let points = best(follow(points, &loose, 3), FOLLOWED);
        // From small sizes, since an effect drowns in those of too poor a hypothesis; and from those, since it need not be all that lacks.
        let from = [(logs(SMALL), &small), (base.posterior.log_sizes, &based)];
        let ends = from.into_iter().filter_map(|(sizes, by)| {
            let (way, point) = best(follow(points.clone(), by, 4), 1).pop()?;
            Some((way, self.problem(&ways[way]).posterior(point.z, sizes, 2)?))
        });
        let (way, posterior) = ends.max_by(|a, b| a.1.log_evidence.total_cmp(&b.1.log_evidence))?;
        let hypothesis = ways[way].clone();
        let log_odds = base.log_odds - base.posterior.log_evidence + posterior.log_evidence
            - ((ways.len() * catalogue().len()) as f64).ln();
        Some(Judged { hypothesis, posterior, log_odds })
    }

    /// The posterior once more, to its end, from its own sizes of model error and from those of the best.
    fn closer(&self, judged: &Judged, best: &[f64; KINDS]) -> Judged {
        let problem = self.problem(&judged.hypothesis);
        let mut closer = judged.clone();
        for sizes in [judged.posterior.log_sizes, *best] {
            let Some(posterior) = problem.posterior(judged.posterior.z.clone(), sizes, 4) else { continue };
            if posterior.log_evidence > closer.posterior.log_evidence {
                closer.log_odds += posterior.log_evidence - closer.posterior.log_evidence;
                closer.posterior = posterior;
            }
        }
        closer
    }

    /// Every effect of the catalogue added to a base, but those sets that were `seen`, the likeliest first.
    fn each_effect(&self, base: &Judged, seen: &mut Vec<Vec<&'static str>>) -> Vec<Judged> {
        let has = |id: &str| base.hypothesis.parts.iter().any(|part| part.effect.id() == id);
        let mut is_new = |id: &'static str| {
            let mut names = [base.names(), vec![id]].concat();
            names.sort_unstable();
            let new = !seen.contains(&names);
            seen.push(names);
            new
        };
        let effects: Vec<&'static dyn Effect> =
            catalogue().iter().copied().filter(|effect| !has(effect.id()) && is_new(effect.id())).collect();
        let mut judged: Vec<Judged> =
            effects.into_par_iter().filter_map(|effect| self.with_effect(base, effect)).collect();
        judged.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        let Some(best) = judged.first().map(|best| (best.log_odds, best.posterior.log_sizes)) else { return vec![] };
        let closer = |one: Judged| {
            if one.log_odds > best.0 - NEAR * ODDS.ln() { self.closer(&one, &best.1) } else { one }
        };
        let mut judged: Vec<Judged> = judged.into_par_iter().map(closer).collect();
        judged.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        judged
    }

    /// All hypotheses that were looked at, the likeliest first.
    pub(crate) fn search(&self, base: Judged) -> Vec<Judged> {
        let mut all = vec![base];
        let (mut from, mut seen) = (vec![all[0].clone()], vec![]);
        for _ in 0..MOST_EFFECTS {
            let mut added: Vec<Judged> = Vec::new();
            let before = all.iter().map(|judged| judged.log_odds).fold(f64::NEG_INFINITY, f64::max);
            for base in &from {
                added.extend(self.each_effect(base, &mut seen));
            }
            added.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
            let grown = added.first().is_some_and(|best| best.log_odds > before + ODDS.ln());
            let near = |judged: &&Judged| judged.log_odds > added[0].log_odds - BESIDE * ODDS.ln();
            from = added.iter().filter(near).take(2).cloned().collect();
            all.extend(added);
            if !grown {
                break;
            }
        }
        all.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        all
    }
}
