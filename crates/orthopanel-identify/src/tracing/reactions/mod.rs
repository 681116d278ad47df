//! Forces of a suspension that is not linear, worked out in time from the hits, and what they add to the accelerances.
//!
//! With the receptances $H$ of everything that is linear, forces $r_j$ at the suspension points $p_j$ make of a hit's ratio
//! $$\frac{A}{F} = s^2\Big(H_{rf} - \sum_jH_{rp_j}\frac{R_j}{F}\Big),$$
//! $R_j$ being the transform of $r_j$ over the same window. The ratio differs from hit to hit, as a linear suspension's does
//! not. The panel's motion under the measured hit, and so $r_j$, is that of its bare modes, those above it, up to 2.5 times the band, giving way at once:
//! masses and springs beside it are left out of $r_j$, and $r_j$ is taken to follow $k_3$ alone.

pub(super) mod blow;
pub(super) mod lines;
pub(super) mod motion_doubt;

use std::sync::Arc;

use num_complex::Complex64;
use orthopanel_data::{ImpactTest, TimeHistory};
use orthopanel_model::{
    CubicForces, Damping, EffectState, ModelError, Place, ReceptanceSetup, RecordSetting, SuspensionMotion,
    cubic_support_forces,
};
use rayon::prelude::*;
use realfft::{RealFftPlanner, RealToComplex};

use super::hypothesis::{CUBIC, Hypothesis};
use super::widened_lines::WidenedLines;
use blow::Blow;

/// What working out the forces takes.
pub(super) struct Reactions {
    supports: Vec<Place>,
    /// From every suspension point to the sensor of every record, point by point within a record.
    setup: ReceptanceSetup,
    records: Vec<Played>,
    /// Highest mode that swings \[Hz\]; those above follow the forces at once.
    band: f64,
}

/// One record's hits.
struct Played {
    force_at: Place,
    /// By how much each hit fell beside the place of all \[m\].
    beside: Vec<f64>,
    rate: f64,
    samples: usize,
    blows: Vec<Blow>,
    transform: Arc<dyn RealToComplex<f64>>,
}

/// $R_j/F$ and its derivative by $k_3$ on the lines of a record, hit by hit and point by point.
pub(super) type Ratios = Vec<Vec<[Vec<Complex64>; 2]>>;

/// Forces are worked out until the window has fallen by $e^{-14}$: a millionth.
const FADED: f64 = 14.0;

impl Reactions {
    /// `None` where the test names no suspension points.
    ///
    /// # Errors
    /// As [`ReceptanceSetup::new`].
    pub(super) fn new(
        test: &ImpactTest,
        histories: &[TimeHistory],
        (summed, band): (usize, f64),
    ) -> Result<Option<Self>, ModelError> {
        let supports = test.suspension.clone();
        if supports.is_empty() {
            return Ok(None);
        }
        let reach = histories.iter().enumerate().flat_map(|(index, history)| {
            supports.iter().map(move |&place| RecordSetting {
                number: index + 1,
                force_at: Some(place),
                response_at: Some(history.response_at),
                suspension_motion: SuspensionMotion::InTime,
                is_reaction: true,
                ..RecordSetting::default()
            })
        });
        let piece = test.pieces[0].piece;
        let reach: Vec<RecordSetting> = reach.collect();
        let setup = ReceptanceSetup::new(&piece, test.boundary, &supports, &reach, summed)?;
        let mut planner = RealFftPlanner::<f64>::new();
        let records = histories.iter().map(|history| {
            let samples = history.hits.first().map_or(0, |hit| hit.force.len());
            Played {
                force_at: history.force_at,
                beside: vec![0.0; history.hits.len()],
                rate: history.rate,
                samples,
                blows: history.hits.iter().map(|hit| Blow::of(hit, history.rate)).collect(),
                transform: planner.plan_fft_forward(samples),
            }
        });
        Ok(Some(Self { supports, setup, records: records.collect(), band }))
    }

    /// The receptances from the suspension points with these effects: that of point `j` in record `k` is number
    /// `k * points + j`; and the number of points.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn reach(
        &self,
        constants: &[f64],
        damping: &Damping,
        effects: &[EffectState],
    ) -> Result<(orthopanel_model::ReceptanceModel, usize), ModelError> {
        Ok((self.setup.model(constants, damping, effects)?, self.supports.len()))
    }

    /// $R_j/F$ of every record on its lines, where its force falls `offsets` beside the place written down \[m\].
    ///
    /// # Errors
    /// What the model refuses, and a motion without bounds.
    pub(super) fn ratios(
        &self,
        (k3, offsets): (f64, &[f64]),
        constants: &[f64],
        (damping, effects): (&Damping, &[EffectState]),
        lines: &[(usize, &WidenedLines)],
    ) -> Result<Vec<Ratios>, ModelError> {
        let mut struck = Vec::new();
        let mut ports = Vec::with_capacity(self.records.len());
        for (index, record) in self.records.iter().enumerate() {
            let offset = offsets.get(index).copied().unwrap_or(0.0);
            let first = struck.len();
            struck.extend(
                record.beside.iter().map(|beside| Place { x: record.force_at.x + offset + beside, ..record.force_at }),
            );
            ports.push(first..struck.len());
        }
        let modes = self.setup.summed_modes(constants, (damping, effects), [&struck, &self.supports], f64::INFINITY)?;
        let of_record = |&(index, lines): &(usize, &WidenedLines)| match (self.records.get(index), ports.get(index)) {
            (Some(record), Some(ports)) => record.ratios(&modes.with_forces(ports.clone())?, (k3, self.band), lines),
            _ => Ok(vec![]),
        };
        lines.par_iter().map(of_record).collect()
    }

    /// Takes note of how far beside the place of all hits of its record each fell \[m\].
    pub(super) fn put_hits(&mut self, beside: &[Vec<f64>]) {
        for (record, beside) in self.records.iter_mut().zip(beside) {
            record.beside.clone_from(beside);
        }
    }

    /// Undoes [`Reactions::put_hits`].
    pub(super) fn put_hits_together(&mut self) {
        self.records.iter_mut().for_each(|record| record.beside.fill(0.0));
    }
}

impl Played {
    fn ratios(
        &self,
        modes: &orthopanel_model::ModalModel,
        (k3, band): (f64, f64),
        lines: &WidenedLines,
    ) -> Result<Ratios, ModelError> {
        let Some(sigma) = lines.s.first().map(|s| s.re) else { return Ok(vec![]) };
        let last = self.blows.iter().map(|blow| blow.peak).max().unwrap_or(0);
        let horizon = (last + (FADED / sigma * self.rate) as usize).min(self.samples);
        let forces: Vec<&[f64]> = self.blows.iter().map(|blow| &blow.force[..]).collect();
        let played = cubic_support_forces(modes, k3, &forces, (1.0 / self.rate, horizon), band)?;
        let hits = played.into_iter().zip(&self.blows).zip(&lines.hits).map(|((played, blow), hit)| {
            let CubicForces { force, by_k3 } = played;
            let over = |list: Vec<f64>| -> Vec<Complex64> {
                let spectrum = self.spectrum(list, sigma, blow.peak);
                let bin =
                    |s: &Complex64| (s.im / std::f64::consts::TAU * self.samples as f64 / self.rate).round() as usize;
                let of_line =
                    |(s, f): (&Complex64, &Complex64)| spectrum.get(bin(s)).copied().unwrap_or(Complex64::ZERO) / f;
                lines.s.iter().zip(&hit.force).map(of_line).collect()
            };
            force.into_iter().zip(by_k3).map(|(force, by)| [over(force), over(by)]).collect()
        });
        Ok(hits.collect())
    }

    /// Transform of the list times $e^{-\sigma(t-t_0)}$ with $t_0$ the hit, as that of the force.
    fn spectrum(&self, mut list: Vec<f64>, sigma: f64, peak: usize) -> Vec<Complex64> {
        let step = -sigma / self.rate;
        list.iter_mut().enumerate().for_each(|(n, value)| *value *= (step * (n as f64 - peak as f64)).exp());
        list.resize(self.samples, 0.0);
        let mut spectrum = self.transform.make_output_vec();
        // Lengths are the plan's own, so this cannot fail.
        let done = self.transform.process(&mut list, &mut spectrum);
        debug_assert!(done.is_ok());
        spectrum
    }
}

/// $k_3$ where a hypothesis has such springs, and its column after `first` columns of constants and damping.
pub(super) fn cubic(hypothesis: &Hypothesis, first: usize) -> Option<(f64, usize)> {
    let mut column = first;
    for on in &hypothesis.effects {
        if on.effect.id() == CUBIC {
            return on.values.first().map(|k3| (*k3, column));
        }
        column += on.values.len();
    }
    None
}
