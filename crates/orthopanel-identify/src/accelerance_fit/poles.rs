//! Poles of the records without a model: natural frequencies and damping read off each resonance.

use std::ops::Range;

use rayon::prelude::*;

use super::pole::Pole;
use super::records::PlaceRecord;
use super::resonance_fit::ResonanceFit;
use crate::least_squares::levenberg_marquardt;
use crate::structures::SeenMode;

/// Power of a peak over that of the valleys beside it, at least.
const PROMINENCE: f64 = 10.0;
/// Power of either over that of the noise, at least.
const SIGNAL_TO_NOISE: f64 = 30.0;
/// A resonance has less damping than this.
pub(super) const MOST_DAMPING: f64 = 0.2;

/// The noise of all records of a piece that stand at the same lines, in power.
pub(super) struct NoisePower {
    /// \[Hz\].
    frequency: Vec<f64>,
    power: Vec<f64>,
    /// Whether the records tell it.
    is_known: bool,
}

impl NoisePower {
    pub(super) fn of(records: &[&PlaceRecord]) -> Self {
        let frequency = records.first().map_or(Vec::new(), |record| record.frequency.clone());
        let of_line = |line: usize| records.iter().map(|record| record.variance[line]).sum();
        let power = (0..frequency.len()).map(of_line).collect();
        Self { frequency, power, is_known: records.iter().all(|record| record.variance_known) }
    }

    /// Whether a mode of this damping would stand out: at its resonance $|H| = |W(l_1)W(l_x)|/2\zeta$.
    pub(super) fn is_heard(&self, mode: &SeenMode, zeta: f64) -> bool {
        let power: f64 = mode.products.iter().map(|product| (product / (2.0 * zeta)).powi(2)).sum();
        let line = self.frequency.partition_point(|&frequency| frequency < mode.frequency);
        !self.is_known || self.power.get(line).is_some_and(|noise| power > SIGNAL_TO_NOISE * noise)
    }
}

/// The records at the lines of the first.
pub(super) fn alike(records: &[PlaceRecord]) -> Vec<&PlaceRecord> {
    // Places with other lines (another rate or length) take part through their own peaks only where lines agree.
    records.iter().filter(|record| records.first().is_some_and(|first| record.frequency == first.frequency)).collect()
}

/// The poles of one piece's records, rising.
pub(super) fn poles(records: &[PlaceRecord]) -> Vec<Pole> {
    let Some(first) = records.first() else { return Vec::new() };
    let alike = alike(records);
    let power: Vec<f64> =
        (0..first.frequency.len()).map(|line| alike.iter().map(|record| record.value[line].norm_sqr()).sum()).collect();
    let noise = NoisePower::of(&alike);
    let mut heard = peaks(&power);
    heard.retain(|&line| power[line] > SIGNAL_TO_NOISE * noise.power[line]);
    let mut found: Vec<Pole> = heard.par_iter().filter_map(|&line| common_pole(&alike, &power, line)).collect();
    found.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // Two peaks of one resonance, split by noise, lead to one pole.
    found.dedup_by(|later, earlier| later.frequency - earlier.frequency < earlier.zeta * earlier.frequency);
    found
}

/// Lines of local maxima that stand out from both sides.
fn peaks(power: &[f64]) -> Vec<usize> {
    let mut found = Vec::new();
    for line in 2..power.len().saturating_sub(2) {
        let height = power[line];
        if height < power[line - 1] || height <= power[line + 1] || !height.is_finite() {
            continue;
        }
        // Down by so much on both sides before anything higher comes.
        let falls = |side: &mut dyn Iterator<Item = &f64>| {
            for &value in side {
                if value > height {
                    return false;
                }
                if value < height / PROMINENCE {
                    return true;
                }
            }
            false
        };
        if falls(&mut power[..line].iter().rev()) && falls(&mut power[line + 1..].iter()) {
            found.push(line);
        }
    }
    found
}

/// Least and most lines on either side of a peak that take part.
const SIDE_LINES: (usize, usize) = (15, 400);

/// The pole at a peak of all records: each record's own, weighted by what it knows.
///
/// Records are fitted one by one, since a test drifts: at a damping ratio of 1e-4 a shift of 1e-4 between two records is
/// a whole half-power width, and a common pole would come out wide.
fn common_pole(records: &[&PlaceRecord], power: &[f64], peak: usize) -> Option<Pole> {
    let own: Vec<Pole> = records.iter().filter_map(|record| Some(fit_pole(record, power, peak)?.0)).collect();
    mean_pole(&own)
}

/// The mean of the records' poles, each weighted by what it knows.
pub(super) fn mean_pole(own: &[Pole]) -> Option<Pole> {
    let weights = own.iter().map(|pole| pole.log_zeta_std.max(1e-6).powi(-2));
    let total: f64 = weights.clone().sum();
    let mean = |value: &dyn Fn(&Pole) -> f64| {
        own.iter().zip(weights.clone()).map(|(pole, weight)| weight * value(pole)).sum::<f64>() / total
    };
    let (log_zeta, frequency) = (mean(&|pole| pole.zeta.ln()), mean(&|pole| pole.frequency));
    // Records that disagree by more than each states say how well their mean is known.
    let scatter = |square: &dyn Fn(&Pole) -> f64| mean(square) / (own.len().max(2) - 1) as f64;
    let log_zeta_std = (1.0 / total).max(scatter(&|pole| (pole.zeta.ln() - log_zeta).powi(2))).sqrt();
    let own_noise = own
        .iter()
        .zip(weights.clone())
        .map(|(pole, weight)| (weight / total * pole.log_frequency_std).powi(2))
        .sum::<f64>();
    let log_frequency_std = own_noise.max(scatter(&|pole| (pole.frequency / frequency - 1.0).powi(2))).sqrt();
    (!own.is_empty()).then(|| Pole { frequency, log_frequency_std, zeta: log_zeta.exp(), log_zeta_std })
}

/// The pole of one record at a peak of `power`, and the lines it was read from.
pub(super) fn fit_pole(record: &PlaceRecord, power: &[f64], peak: usize) -> Option<(Pole, Range<usize>)> {
    let frequency = &record.frequency;
    let step = frequency.get(peak + 1)? - frequency[peak];
    // Half-power width from the first lines below half on each side.
    let half = power[peak] / 2.0;
    let right = power[peak..].iter().position(|&value| value < half).unwrap_or(1);
    let left = power[..=peak].iter().rev().position(|&value| value < half).unwrap_or(1);
    let width = (right + left) as f64 * step / 2.0;
    let side = ((6.0 * width / step) as usize).clamp(SIDE_LINES.0, SIDE_LINES.1);
    let lines = peak.saturating_sub(side)..(peak + side + 1).min(frequency.len());
    let start = [frequency[peak].ln(), (0.5 * width / frequency[peak]).max(1e-6).ln()];
    let bounds = [
        (start[0] - 3.0 * side as f64 * step / frequency[peak], start[0] + 3.0 * side as f64 * step / frequency[peak]),
        (1e-7_f64.ln(), 0.5_f64.ln()),
    ];
    let fit = ResonanceFit { record, value: record.value[lines.clone()].to_vec(), lines };
    let linearise = |p: &[f64]| Ok::<_, std::convert::Infallible>(fit.linearise(p));
    let pole = fit.pole(&levenberg_marquardt(linearise, &start, &bounds).ok()?, 0, step)?;
    // A pole away from its peak, or of any damping, is no resonance but a bump of the background.
    let at_peak = (pole.frequency - frequency[peak]).abs() < 2.0 * width.max(step);
    let sure = pole.log_zeta_std < 0.5 && pole.zeta < MOST_DAMPING;
    (at_peak && sure).then_some((pole, fit.lines))
}
