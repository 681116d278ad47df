//! What hits of unequal strength show that their mean does not: springs at the suspension whose force goes with the cube of their motion.
//!
//! Under hit $h$ the springs at the suspension points $p_j$ push back with $k_3w_j^3$, which is worked out in time from the measured blow.
//! With the transform $R_{hj}$ of that force the motion at the sensor is
//! $$A_h = HF_h - s^2\sum_jH_{rp_j}R_{hj} + N_h.$$
//! What every hit has alike goes into $H$, so that $A_h-\hat HF_h$ is held against the same part of the sum, for each $k_3$. Hits that fall beside
//! each other differ as well, by no law that is known: the noise is as large as what the best $k_3$ leaves.

use num_complex::Complex64;
use orthopanel_data::{ImpactTest, TimeHistory};
use orthopanel_model::{EffectState, ModalModel, Mode, ModelError, Place, cubic_support_forces};
use rayon::prelude::*;

use crate::IdentifyError;
use crate::measured::{HitSpectra, HitsOfRecord, sound, transform};
use crate::predicted::Predictor;

/// Windows $e^{-\sigma t}$ after the blow \[1/s\], each with the steps of a coordinate of $k_3$ by which a search goes on from the best: at first a short one,
/// since the swing of a spring that is not linear runs ahead of that of another, the more the longer it lasts.
const WINDOWS: [(f64, &[f64]); 2] = [(40.0, &[0.2, 0.1]), (12.0, &[0.05, 0.02])];
/// Where it begins.
const NET: usize = 17;
const FARTHEST: f64 = 3.0;
/// A window has faded when it has fallen by $e^{-14}$.
const FADED: f64 = 14.0;

/// The hits of a test, each by itself.
pub(crate) struct HitStrength {
    histories: Vec<TimeHistory>,
    supports: Vec<Place>,
    /// \[Hz\]; modes above it follow forces at once.
    band: [f64; 2],
}

/// A record under a window, with what a hypothesis says of it.
struct Record {
    /// Sampling step \[s\], and samples.
    step: f64,
    samples: usize,
    sigma: f64,
    of: HitsOfRecord,
    /// From the hammer to the suspension points.
    model: ModalModel,
    /// $s^2H_{rp_j}$ on the record's lines, as the channel shows it, a list a suspension point.
    reach: Vec<Vec<Complex64>>,
    /// \[Hz\], as [`HitStrength::band`].
    highest: f64,
}

/// Springs that hits ask for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Springs {
    /// The coordinate of $k_3$, and its variance.
    pub z: f64,
    pub variance: f64,
    /// Logarithm of the marginal likelihood with them over that without.
    pub log_evidence: f64,
}

impl HitStrength {
    /// Of the hits of a test, up to a frequency \[Hz\]; none where it has none, or names no suspension points.
    ///
    /// # Errors
    /// [`IdentifyError::Data`] where records cannot be read.
    pub(crate) fn new(test: &ImpactTest, band: [f64; 2]) -> Result<Option<Self>, IdentifyError> {
        if test.suspension.is_empty() {
            return Ok(None);
        }
        let histories: Vec<TimeHistory> = test.time_histories()?.into_iter().map(|(_, history)| history).collect();
        if histories.is_empty() {
            return Ok(None);
        }
        Ok(Some(Self { histories: sound(&histories)?.0, supports: test.suspension.clone(), band }))
    }

    /// The springs that the hits ask for, on a panel with these constants and effects; `k3` gives the value at a coordinate, whose prior is a
    /// standard one. None where every hit of a record is alone, or where $k_3$ leads out of its range.
    pub(crate) fn springs(
        &self,
        predictor: &Predictor,
        (constants, effects): (&[f64], &[EffectState]),
        k3: impl Fn(f64) -> f64,
    ) -> Result<Option<Springs>, ModelError> {
        let net = (0..NET).map(|i| FARTHEST * (2.0 * i as f64 / (NET - 1) as f64 - 1.0));
        let mut at: Vec<f64> = net.collect();
        let mut springs = None;
        for (sigma, steps) in WINDOWS {
            let record = |number: usize| self.record(number, sigma, predictor, (constants, effects));
            let records = (0..self.histories.len()).into_par_iter().map(record).collect::<Result<Vec<_>, _>>()?;
            let free: usize = records.iter().map(|Record { of, .. }| of.s.len() * (of.hits.len().max(1) - 1)).sum();
            if free == 0 {
                return Ok(None);
            }
            let misfit =
                |k3: f64| -> Result<f64, ModelError> { records.par_iter().map(|record| record.misfit(k3)).sum() };
            let mut best = (0.0, f64::INFINITY);
            for step in [0.0].iter().chain(steps) {
                let beside = if *step > 0.0 { vec![best.0 - step, best.0 + step] } else { at.clone() };
                for z in beside {
                    let left = misfit(k3(z))?;
                    if left < best.1 {
                        best = (z, left);
                    }
                }
            }
            let (z, left) = best;
            if z.abs() >= FARTHEST {
                return Ok(None);
            }
            // Noise, or what differs from hit to hit by no law that is known.
            let longest = records.iter().map(|record| record.step * record.samples as f64).fold(0.0, f64::max);
            // The window's lines are as wide as sigma/2, and lines beside each other tell the same.
            let scale = (left / free as f64).max(1.0) * (0.5 * sigma * longest).max(1.0);
            let step = steps.last().copied().unwrap_or(0.1);
            let [before, after] = [misfit(k3(z - step))?, misfit(k3(z + step))?];
            let bend = before + after - 2.0 * left;
            let curvature = (bend / (step * step * scale)).max(0.0) + 1.0;
            // The parabola through the three.
            let z = z + if bend > 0.0 { 0.5 * step * (before - after) / bend } else { 0.0 };
            let log_evidence = (misfit(0.0)? - left) / scale - 0.5 * (z * z + curvature.ln());
            springs = Some(Springs { z, variance: curvature.recip(), log_evidence });
            at = vec![z - step, z, z + step];
        }
        Ok(springs)
    }

    fn record(
        &self,
        number: usize,
        sigma: f64,
        predictor: &Predictor,
        (constants, effects): (&[f64], &[EffectState]),
    ) -> Result<Record, ModelError> {
        let history = &self.histories[number];
        let of = HitsOfRecord::new(history, self.band, sigma);
        let ports = [&[history.force_at, history.response_at], &self.supports[..]].concat();
        let (modes, channel) = predictor.in_record(number, &ports, constants, effects)?;
        let at = |mode: &Mode, port: usize| mode.at_responses[port];
        let to_supports = |mode: &Mode| Mode {
            at_forces: vec![at(mode, 0)],
            at_responses: (2..ports.len()).map(|port| at(mode, port)).collect(),
            ..mode.clone()
        };
        let reach = |support: usize| -> Vec<Complex64> {
            let line = |s: &Complex64| {
                let of_mode = |mode: &Mode| {
                    let omega = mode.angular_frequency;
                    let stiffness = s * s + 2.0 * mode.damping_ratio * omega * s + omega * omega;
                    at(mode, 1) * at(mode, 2 + support) / stiffness
                };
                channel(*s) * s * s * modes.iter().map(of_mode).sum::<Complex64>()
            };
            of.s.iter().map(line).collect()
        };
        Ok(Record {
            step: history.rate.recip(),
            samples: history.hits.first().map_or(0, |hit| hit.force.len()),
            sigma,
            model: ModalModel::new(1, self.supports.len(), modes.iter().map(to_supports).collect())?,
            reach: (0..self.supports.len()).map(reach).collect(),
            of,
            highest: self.band[1],
        })
    }
}

impl Record {
    /// What hits leave beside their mean, over their noise, with springs of this $k_3$ \[N/m³\]; every line of every hit adds one where noise is
    /// all.
    fn misfit(&self, k3: f64) -> Result<f64, ModelError> {
        let Self { step, samples, sigma, of, .. } = self;
        let blows: Vec<&[f64]> = of.hits.iter().map(|hit| &hit.blow[..]).collect();
        let pushed: Vec<Vec<Complex64>> = if k3 == 0.0 {
            vec![vec![Complex64::ZERO; of.s.len()]; blows.len()]
        } else {
            let last = of.hits.iter().map(|hit| hit.peak).max().unwrap_or(0);
            let faded = (last + (FADED / (sigma * step)) as usize).min(*samples);
            let played = cubic_support_forces(&self.model, k3, &blows, (*step, faded), self.highest)?;
            let of_hit = |(hit, forces): (&HitSpectra, Vec<Vec<f64>>)| {
                let mut sum = vec![Complex64::ZERO; of.s.len()];
                for (mut force, reach) in forces.into_iter().zip(&self.reach) {
                    let decay = |n: usize| (sigma * (hit.peak as f64 - n as f64) * step).exp();
                    force.iter_mut().enumerate().for_each(|(n, force)| *force *= decay(n));
                    force.resize(*samples, 0.0);
                    let spectrum = transform(force, of.lines.clone(), *step);
                    sum.iter_mut()
                        .zip(reach.iter().zip(spectrum))
                        .for_each(|(sum, (reach, force))| *sum -= reach * force);
                }
                sum
            };
            of.hits.iter().zip(played).map(|(hit, played)| of_hit((hit, played.force))).collect()
        };
        let line = |k: usize| -> f64 {
            // What all hits have alike is part of the accelerance.
            let alike: Complex64 = of.hits.iter().zip(&pushed).map(|(hit, pushed)| of.share(hit, k) * pushed[k]).sum();
            let left =
                |(hit, pushed): (&HitSpectra, &Vec<Complex64>)| of.left(hit, k, pushed[k] - alike * hit.force[k]);
            of.hits.iter().zip(&pushed).map(left).sum()
        };
        Ok((0..of.s.len()).map(line).sum())
    }
}
