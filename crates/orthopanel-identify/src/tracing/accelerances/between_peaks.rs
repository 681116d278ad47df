//! The lines between the resonances, where a drift of the frequencies does not show.

use num_complex::Complex64;
use orthopanel_data::Accelerance;

use super::resonances::Resonance;
use crate::tracing::widened_lines::median;

/// Accelerances at a few frequencies between each two resonances.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BetweenPeaks {
    /// Decay rate $\sigma$ \[1/s\] of $s = \sigma + j\omega$ at which each record stands.
    pub decay_rate: Vec<f64>,
    /// Of each record \[Hz\]: those of a record's own lines.
    pub frequency: Vec<Vec<f64>>,
    /// Of each record \[(m/s²)/N\].
    pub value: Vec<Vec<Complex64>>,
    /// Variance of each by the record's noise.
    pub noise: Vec<Vec<f64>>,
    /// Mean $|H|^2$ of all records at each frequency: how much the piece moves there.
    pub level: Vec<f64>,
    /// The gap between two resonances that each frequency lies in.
    pub gap: Vec<usize>,
}

/// Lines this near to a resonance, as a part of its frequency and in damping ratios, measure drift and damping: a drift of
/// 1e-4 is half a percent of a line 2 % away.
const APART: (f64, f64) = (0.02, 10.0);
/// The same of a mode that no record told: where it lies the model alone says, without the effect that it may lack.
const UNSEEN_APART: f64 = 0.05;
/// Up to here, in parts of the first resonance, lines tell suspensions and filters more than the panel: they are a gap of their own.
const LOW: f64 = 1.0 / 6.0;
/// The lowest line, in parts of the first resonance: below it sensors and amplifiers pass no constant acceleration.
const LOWEST: f64 = 1.0 / 40.0;
/// Frequencies in each gap.
const IN_GAP: usize = 12;
/// A mean over neighbouring lines reaches this part of the way to the next resonance on either side: its curvature then
/// shifts it by a part in a thousand.
const REACH: f64 = 1.0 / 16.0;
/// and so far \[lines\].
const MOST: usize = 50;
/// So many records are never still all at once.
const ENOUGH: usize = 3;
/// Lines with more noise than this part of their level are dropped.
const NOISY: f64 = 0.1;
/// Lines from whose scatter the noise is read.
const SCATTERED: usize = 9;

impl BetweenPeaks {
    /// Reads the lines; resonances with their damping ratio, and natural frequencies \[Hz\] of modes that no record told, which
    /// may be damped as much as the most damped one of the others.
    pub(super) fn of(
        accelerances: &[Accelerance],
        resonances: &[Resonance],
        zeta: impl Fn(usize) -> f64,
        (unseen, most_damped): (&[f64], f64),
    ) -> Self {
        let ends =
            |pick: &dyn Fn(&Accelerance) -> Option<f64>| accelerances.iter().filter_map(pick).collect::<Vec<_>>();
        let top = ends(&|record| record.frequency.last().copied()).into_iter().fold(f64::INFINITY, f64::min);
        let bottom = ends(&|record| record.frequency.first().copied()).into_iter().fold(0.0, f64::max);
        let mut peaks: Vec<(f64, f64)> = resonances
            .iter()
            .map(|resonance| (resonance.frequency, APART.0.max(APART.1 * zeta(resonance.mode)) * resonance.frequency))
            .chain(unseen.iter().map(|&frequency| (frequency, UNSEEN_APART.max(APART.1 * most_damped) * frequency)))
            .collect();
        peaks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut found = Self {
            decay_rate: accelerances.iter().map(|record| record.decay_rate).collect(),
            frequency: vec![vec![]; accelerances.len()],
            value: vec![vec![]; accelerances.len()],
            noise: vec![vec![]; accelerances.len()],
            level: vec![],
            gap: vec![],
        };
        let lowest = peaks.first().map_or(bottom, |(first, _)| bottom.max(LOWEST * first));
        let low = peaks.first().map_or(lowest, |(first, _)| lowest.max(LOW * first));
        let starts = [lowest, low].into_iter().chain(peaks.iter().map(|(peak, apart)| peak + apart));
        let stops = [low].into_iter().chain(peaks.iter().map(|(peak, apart)| top.min(peak - apart))).chain([top]);
        for (gap, (start, stop)) in starts.zip(stops).enumerate() {
            for step in 0..if stop > start { IN_GAP } else { 0 } {
                let part = (step as f64 + 0.5) / IN_GAP as f64;
                // What suspensions and filters do goes with a power of the frequency.
                let centre = if gap == 0 { start * (stop / start).powf(part) } else { start + part * (stop - start) };
                let to_peak = peaks.iter().map(|(peak, _)| (peak - centre).abs()).fold(centre, f64::min);
                found.add(accelerances, centre, REACH * to_peak, gap);
            }
        }
        found.drop_noise();
        if accelerances.len() < ENOUGH {
            found.raise_valleys();
        }
        found
    }

    /// Lines that are mostly noise, as above the band of the hammer, tell nothing but are missed by all models; where all are, all stay.
    fn drop_noise(&mut self) {
        let records = self.noise.len().max(1) as f64;
        let told = |at: usize| {
            self.noise.iter().map(|noise| noise[at]).sum::<f64>() < NOISY.powi(2) * records * self.level[at]
        };
        let told: Vec<bool> = (0..self.level.len()).map(told).collect();
        if told.iter().any(|told| *told) {
            self.frequency.iter_mut().for_each(|lines| keep(lines, &told));
            self.value.iter_mut().for_each(|lines| keep(lines, &told));
            self.noise.iter_mut().for_each(|lines| keep(lines, &told));
            keep(&mut self.level, &told);
            keep(&mut self.gap, &told);
        }
    }

    /// Few records are still at the same frequencies, where a single error of place weighs beyond all measure.
    fn raise_valleys(&mut self) {
        for gap in 0..=self.gap.last().copied().unwrap_or(0) {
            let own: Vec<usize> = (0..self.gap.len()).filter(|&at| self.gap[at] == gap).collect();
            let usual = median(&own.iter().map(|&at| self.level[at]).collect::<Vec<_>>());
            own.iter().for_each(|&at| self.level[at] = self.level[at].max(usual));
        }
    }

    fn add(&mut self, accelerances: &[Accelerance], centre: f64, reach: f64, gap: usize) {
        let mut power = 0.0;
        for (index, record) in accelerances.iter().enumerate() {
            let Averaged { frequency, value, noise } = Averaged::near(record, centre, reach);
            power += value.norm_sqr();
            self.frequency[index].push(frequency);
            self.value[index].push(value);
            self.noise[index].push(noise);
        }
        self.level.push((power / accelerances.len().max(1) as f64).max(f64::MIN_POSITIVE));
        self.gap.push(gap);
    }

    /// Number of complex lines of all records.
    pub(super) fn count(&self) -> usize {
        self.value.iter().map(Vec::len).sum()
    }

    /// Lowest and highest frequency.
    pub(super) fn band(&self) -> Option<(f64, f64)> {
        let lines = self.frequency.first()?;
        Some((*lines.first()?, *lines.last()?))
    }

    /// Rms of the noise over the level.
    pub(super) fn noise_floor(&self) -> f64 {
        let parts =
            self.noise.iter().flat_map(|record| record.iter().zip(&self.level).map(|(noise, level)| noise / level));
        (parts.sum::<f64>() / self.count().max(1) as f64).sqrt()
    }
}

fn keep<T>(lines: &mut Vec<T>, told: &[bool]) {
    let mut told = told.iter();
    lines.retain(|_| told.next().is_none_or(|told| *told));
}

/// The mean of some neighbouring lines.
struct Averaged {
    frequency: f64,
    value: Complex64,
    /// Variance of the mean.
    noise: f64,
}

impl Averaged {
    fn near(record: &Accelerance, centre: f64, reach: f64) -> Self {
        let lines = record.frequency.len();
        let middle = record.frequency.partition_point(|&frequency| frequency < centre).min(lines.saturating_sub(1));
        let first = record.frequency.partition_point(|&frequency| frequency < centre - reach);
        let end = record.frequency.partition_point(|&frequency| frequency <= centre + reach);
        let half = (end.saturating_sub(first) / 2).min(MOST / 2);
        let around = |half: usize| middle.saturating_sub(half)..(middle + half + 1).min(lines);
        let own = around(half);
        let count = own.len().max(1) as f64;
        let frequency = record.frequency[own.clone()].iter().sum::<f64>() / count;
        let value = record.value[own].iter().sum::<Complex64>() / count;
        let scattered = &record.value[around(half.max(SCATTERED / 2))];
        Self { frequency, value, noise: line_noise(scattered) / count }
    }
}

/// Variance of one line, from what three neighbours leave of a straight line:
/// $E|h_k - (h_{k-1}+h_{k+1})/2|^2 = \tfrac32 E|n|^2$.
fn line_noise(lines: &[Complex64]) -> f64 {
    let bends = lines.windows(3).map(|three| (three[1] - 0.5 * (three[0] + three[2])).norm_sqr());
    bends.sum::<f64>() / 1.5 / lines.len().saturating_sub(2).max(1) as f64
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Place;

    use super::*;

    /// Lines of 1 Hz up to 1000 Hz, flat, with noise in turn above and below it from `noisy` on.
    fn record(noisy: f64) -> Accelerance {
        let frequency: Vec<f64> = (10..=1000).map(f64::from).collect();
        let noise = |f: f64| if f < noisy { 0.0 } else { 6.0 * (f % 2.0 - 0.5) };
        let place = Place { x: 0.0, y: 0.0 };
        Accelerance {
            force_at: place,
            response_at: place,
            value: frequency.iter().map(|&f| Complex64::new(1.0 + noise(f), 0.0)).collect(),
            frequency,
            variance: None,
            coherence: None,
            hits: 0,
            verdicts: vec![],
            decay_rate: 0.0,
            decay_rate_in_doubt: 0.0,
            force_noise: None,
            bias: None,
            read_as: orthopanel_data::ReadAs::SI,
            notes: vec![],
        }
    }

    fn between(noisy: f64, unseen: &[f64]) -> Vec<f64> {
        let response_at = Place { x: 0.0, y: 0.0 };
        let seen = [Resonance { mode: 0, response_at, frequency: 100.0, std: 1e-6 }];
        let mut found = BetweenPeaks::of(&[record(noisy)], &seen, |_| 1e-3, (unseen, 0.01));
        found.frequency.remove(0)
    }

    #[test]
    fn no_line_is_read_near_a_mode_that_no_record_told() {
        let (all, apart) = (between(f64::INFINITY, &[]), between(f64::INFINITY, &[440.0, 1020.0]));
        assert!(all.iter().any(|f| (420.0..460.0).contains(f)));
        assert!(apart.iter().all(|f| (f / 440.0 - 1.0).abs() >= 0.1 && *f < 920.0), "{apart:?}");
        // The gap that it parts is read on both sides.
        assert_eq!(apart.len(), all.len() + IN_GAP);
    }

    #[test]
    fn lines_that_are_mostly_noise_are_dropped_unless_all_are() {
        let told = between(600.0, &[]);
        assert!(told.last().is_some_and(|last| (500.0..620.0).contains(last)), "{told:?}");
        assert_eq!(between(0.0, &[]).len(), between(f64::INFINITY, &[]).len());
    }
}
