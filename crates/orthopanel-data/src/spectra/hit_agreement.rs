//! Hits of one pair of places held against one another: each alone makes an accelerance, and all must be alike.

use std::ops::Range;

use num_complex::Complex64;
use orthopanel_model::Readable;

use super::{
    extremes::median, hit_faults::HitFault, hit_verdict::HitVerdict, spectrum::Sums, time_history::TimeHistory,
};
use crate::DataError;

/// Lines from which a median is worth taking.
const LEAST_LINES: usize = 24;

/// A gain this far off is a fault of the record. Hits a millimetre apart differ by a tenth of it in the median line.
const ASTRAY: f64 = 0.05;

/// and this many standard deviations of its median.
const SURE: f64 = 5.0;

/// Parts of what one hit is off by which the others may differ.
const AGREED: f64 = 1.0 / 3.0;

/// Difference of the median line, over the greater of both, beyond which two hits belong to different places.
const CONTRADICTION: f64 = 0.5;

/// The same between hits that belong together.
const TOGETHER: f64 = 0.25;

/// A difference so many times its hit's noise is none of noise, in amplitude.
const BEYOND_NOISE: f64 = 5.0;

/// How the hits of a place stand to one another.
#[derive(Debug, PartialEq)]
pub(super) enum Agreement {
    /// Alike, or too few lines to say.
    Alike,
    /// Most agree, these do not.
    Astray(Vec<(usize, HitFault)>),
    /// They fall in two groups of two hits and more: the hits of the second, the median difference between and within.
    Parted { second: Vec<usize>, apart: f64, within: f64 },
    /// They differ, and nothing tells which are right: the greatest median difference, and whether in gain.
    Differ { by: f64, in_gain: bool },
    /// They differ by this in the median line, and no more than the noise before their blows explains.
    Noisy { by: f64 },
}

impl TimeHistory {
    /// Leaves out hits that stand beside the others, and says so; true where any does. The sums are those of the hits kept so far.
    pub(super) fn heed_agreement(
        &self,
        sums: &Sums,
        band: Range<usize>,
        verdicts: &mut [HitVerdict],
        notes: &mut Vec<String>,
    ) -> Result<bool, DataError> {
        let kept: Vec<usize> = self.kept(verdicts).into_iter().map(|(index, _)| index).collect();
        let named = |own: usize| self.hit_name(kept[own]);
        match sums.agreement(band) {
            Agreement::Alike => Ok(false),
            Agreement::Astray(astray) => {
                for (own, fault) in astray {
                    let beside = HitVerdict { faults: vec![fault] };
                    notes.extend(beside.notes(&named(own)));
                    verdicts[kept[own]].faults.extend(beside.faults);
                }
                Ok(true)
            }
            Agreement::Parted { second, apart, within } => {
                let names: Vec<String> = second.iter().map(|&own| named(own)).collect();
                Err(DataError::NoUsableHit {
                    file: self.file.clone(),
                    reasons: format!(
                        "{} differ by {:.0} % in the median line from the other hits of force [{}, {}], response [{}, {}], \
                         and agree with one another within {:.0} %: they belong to another place; correct force_at or \
                         response_at",
                        names.join(", "),
                        Readable(100.0 * apart),
                        self.force_at.x,
                        self.force_at.y,
                        self.response_at.x,
                        self.response_at.y,
                        Readable((100.0 * within).ceil())
                    ),
                })
            }
            Agreement::Noisy { by } => {
                notes.push(format!(
                    "the hits differ by {:.0} % in the median line, as the noise of their channels before the blow explains: \
                     much noise; hit harder, or average more hits",
                    Readable(100.0 * by)
                ));
                Ok(false)
            }
            Agreement::Differ { by, in_gain } => {
                let names: Vec<String> = (0..kept.len()).map(named).collect();
                let how = if in_gain {
                    "over the whole band, and nothing tells which is right: a sample cut off, or another \
                     gain"
                } else {
                    "in the median line: much noise, or hits at several places"
                };
                notes.push(format!("{} differ by {:.1} % {how}", names.join(", "), Readable(100.0 * by)));
                Ok(false)
            }
        }
    }
}

impl Sums {
    /// Holds each hit's own quotient $A_i/F_i$ at the sampled lines within `band` against those of the others.
    pub(super) fn agreement(&self, band: Range<usize>) -> Agreement {
        let sampled = band.start.div_ceil(self.stride)..band.end.div_ceil(self.stride);
        let quotients: Vec<&[Complex64]> =
            self.quotients.iter().map(|hit| hit.get(sampled.clone()).unwrap_or_default()).collect();
        match quotients.first() {
            Some(first) if quotients.len() > 1 && first.len() >= LEAST_LINES => {}
            _ => return Agreement::Alike,
        }
        let groups = match parted(&quotients) {
            Ok(()) => return in_gain(&quotients, (self.stride * sampled.len()) as f64 / self.tied),
            Err(groups) => groups,
        };
        let Some(Groups { own, others, apart, within }) = groups.filter(|groups| groups.within < TOGETHER) else {
            let by = quotients.iter().skip(1).map(|hit| difference(quotients[0], hit)).fold(0.0, f64::max);
            return match (1..quotients.len()).any(|hit| self.beyond_noise(hit, 0, &sampled)) {
                true => Agreement::Differ { by, in_gain: false },
                false => Agreement::Noisy { by },
            };
        };
        let alone = |hit: usize, good: usize| match self.beyond_noise(hit, good, &sampled) {
            true => Agreement::Astray(vec![(hit, HitFault::Elsewhere { apart, within })]),
            // A weak hit among strong ones: the average weighs it.
            false => Agreement::Alike,
        };
        match (own.as_slice(), others.as_slice()) {
            ([one], [good, _, ..]) | ([good, _, ..], [one]) => alone(*one, *good),
            ([_, _, ..], [_, _, ..]) => Agreement::Parted { second: others, apart, within },
            _ => Agreement::Differ { by: apart, in_gain: false },
        }
    }

    /// Whether a hit differs from another by more than the noise before its blow explains.
    fn beyond_noise(&self, hit: usize, good: usize, sampled: &Range<usize>) -> bool {
        let Some(noise) = &self.noise else { return true };
        let parts = sampled.clone().map(|at| {
            let (own, other) = (self.quotients[hit][at], self.quotients[good][at]);
            let expected = noise[hit].of_line(other.norm_sqr()) / self.powers[hit][at * self.stride];
            (own - other).norm_sqr() / expected
        });
        median(parts.filter(|part| part.is_finite()).collect()) > BEYOND_NOISE.powi(2)
    }
}

/// Median over the lines of $|q_a-q_b|$ over the greater of both.
fn difference(a: &[Complex64], b: &[Complex64]) -> f64 {
    let parts = a.iter().zip(b).map(|(a, b)| (a - b).norm() / a.norm().max(b.norm()));
    median(parts.filter(|part| part.is_finite()).collect())
}

/// Hits that go with the first, and those that do not.
struct Groups {
    own: Vec<usize>,
    others: Vec<usize>,
    /// Median difference between both, and the greatest within.
    apart: f64,
    within: f64,
}

/// `Ok` where no hit contradicts the first; `Err(None)` where no two hits tell how far hits of one place differ.
fn parted(quotients: &[&[Complex64]]) -> Result<(), Option<Groups>> {
    let from_first: Vec<f64> = quotients.iter().map(|hit| difference(quotients[0], hit)).collect();
    let (others, own): (Vec<usize>, Vec<usize>) =
        (0..quotients.len()).partition(|&hit| from_first[hit] > CONTRADICTION);
    if others.is_empty() {
        return Ok(());
    }
    let within = |group: &[usize]| {
        let first = quotients[group[0]];
        group.iter().skip(1).map(|&hit| difference(first, quotients[hit])).fold(0.0, f64::max)
    };
    let within = within(&own).max(within(&others));
    let apart = median(others.iter().map(|&hit| from_first[hit]).collect());
    Err((quotients.len() > 2).then_some(Groups { own, others, apart, within }))
}

/// Hits whose gain stands beside that of the others over the whole band, as after one cut-off sample of the force.
/// No more than `independent` lines tell of it.
fn in_gain(quotients: &[&[Complex64]], independent: f64) -> Agreement {
    let mut gains: Vec<(f64, f64)> = quotients
        .iter()
        .map(|hit| {
            let logarithms: Vec<f64> = hit
                .iter()
                .zip(quotients[0])
                .map(|(own, first)| (own.norm() / first.norm()).ln())
                .filter(|gain| gain.is_finite())
                .collect();
            let lines = (logarithms.len() as f64).min(independent).max(1.0);
            let gain = median(logarithms.clone());
            let spread = median(logarithms.iter().map(|own| (own - gain).abs()).collect()) / 0.674_49;
            // A median's own deviation is 1.25 times a mean's.
            (gain, 1.25 * spread / lines.sqrt())
        })
        .collect();
    // Held against itself the first hit has no scatter; the others' holds its own.
    let most = gains.iter().map(|(_, deviation)| *deviation).fold(0.0, f64::max);
    gains.iter_mut().take(1).for_each(|first| first.1 = most);
    let middle = median(gains.iter().map(|(gain, _)| *gain).collect());
    let off = |(gain, deviation): &(f64, f64)| {
        let off = (gain - middle).abs();
        off > ASTRAY && off > SURE * deviation
    };
    if let [_, second] = gains.as_slice() {
        let (by, deviation) = (second.0.abs(), second.1);
        let differ = by > ASTRAY && by > SURE * deviation;
        return if differ { Agreement::Differ { by: by.exp_m1(), in_gain: true } } else { Agreement::Alike };
    }
    let (astray, agreed): (Vec<usize>, Vec<usize>) = (0..gains.len()).partition(|&hit| off(&gains[hit]));
    let least = astray.iter().map(|&hit| (gains[hit].0 - middle).abs()).fold(f64::INFINITY, f64::min);
    let most = agreed.iter().map(|&hit| (gains[hit].0 - middle).abs()).fold(0.0, f64::max);
    match astray.len() {
        0 => Agreement::Alike,
        few if 2 * few < gains.len() && most < AGREED * least => {
            let fault = |hit: usize| (hit, HitFault::Astray { gain: (gains[hit].0 - middle).exp() });
            Agreement::Astray(astray.into_iter().map(fault).collect())
        }
        _ => {
            let by = gains.iter().map(|(gain, _)| (gain - middle).abs().exp_m1()).fold(0.0, f64::max);
            Agreement::Differ { by, in_gain: true }
        }
    }
}
