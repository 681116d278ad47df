//! The error of every line by itself, beside that of the means of neighbouring lines by which a search goes.
//!
//! Files of accelerances are often hundreds of lines to a resonance, each with its own scatter. That scatter is no error of the
//! model, but it is in the number that one gets who compares the curves line by line; so both are told.

use orthopanel_data::Accelerance;

use super::between_peaks::{BetweenPeaks, line_noise};
use crate::AcceleranceFit;

/// Errors between the resonances, line by line, each over the rms of all records at its frequency:
/// $$e^2 = \overline{\sum_r|H_r^{cal}-H_r^{exp}|^2 \Big/ \sum_r|H_r^{exp}|^2}$$
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EveryLine {
    pub before: f64,
    pub after: f64,
    /// What neighbouring lines differ by, over the same.
    pub scatter: f64,
}

/// Scatter is told where it is more than this part of the error before: else both errors are the same.
const TOLD: f64 = 0.2;

impl EveryLine {
    /// `None` where the records do not stand at the same lines.
    pub(super) fn of(
        measured: &[Accelerance],
        between: &BetweenPeaks,
        [before, after]: [&[AcceleranceFit]; 2],
    ) -> Option<Self> {
        let lines = &before.first()?.frequency;
        if before.iter().chain(after).any(|record| record.frequency != *lines) {
            return None;
        }
        let (low, high) = between.band()?;
        let is_between = |f: f64| (low..=high).contains(&f) && !between.is_at_a_peak(f);
        let mut sums = [0.0; 3];
        let mut count = 0_usize;
        // A line at either end has one neighbour only.
        for line in (1..lines.len().saturating_sub(1)).filter(|&line| is_between(lines[line])) {
            let level: f64 = before.iter().map(|record| record.measured[line].norm_sqr()).sum();
            let missed = |fits: &[AcceleranceFit]| -> f64 {
                fits.iter().map(|record| (record.model[line] - record.measured[line]).norm_sqr()).sum()
            };
            let scatter: f64 = measured.iter().map(|record| line_noise(&record.value[line - 1..=line + 1])).sum();
            let each = [missed(before), missed(after), scatter];
            sums.iter_mut().zip(each).for_each(|(sum, own)| *sum += own / level.max(f64::MIN_POSITIVE));
            count += 1;
        }
        let [before, after, scatter] = sums.map(|sum| (sum / count.max(1) as f64).sqrt());
        (count > 0).then_some(Self { before, after, scatter })
    }

    /// A sentence, where the lines scatter enough to need it.
    pub(super) fn note(&self) -> Option<String> {
        let Self { before, after, scatter } = self;
        let told = |part: f64| 100.0 * part;
        (*scatter > TOLD * before).then(|| {
            format!(
                "line by line, not averaged over neighbours, the same error is {:.1} % without effects and {:.1} % with them, of \
                 which {:.1} % is what neighbouring lines differ by",
                told(*before),
                told(*after),
                told(*scatter)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;
    use orthopanel_model::Place;

    use super::*;

    /// One record of a line that alternates by `rough` about one, and models that are off by `off`.
    fn told(rough: f64, off: [f64; 2]) -> EveryLine {
        let frequency: Vec<f64> = (0..400).map(|line| 10.0 + 0.1 * f64::from(line)).collect();
        let sign = |line: usize| if line.is_multiple_of(2) { 1.0 } else { -1.0 };
        let value: Vec<Complex64> = (0..400).map(|line| Complex64::new(1.0 + rough * sign(line), 0.0)).collect();
        let place = Place { x: 0.1, y: 0.0 };
        let record = Accelerance {
            force_at: place,
            response_at: place,
            frequency: frequency.clone(),
            value: value.clone(),
            variance: None,
            coherence: None,
            hits: 0,
            verdicts: vec![],
            decay_rate: 0.0,
            decay_rate_in_doubt: 0.0,
            force_noise: None,
            bias: None,
            notes: vec![],
        };
        let between = BetweenPeaks::of(std::slice::from_ref(&record), &[], |_| 0.01);
        let fit = |off: f64| AcceleranceFit {
            piece: 0,
            force_at: place,
            response_at: place,
            model: vec![Complex64::new(1.0 + off, 0.0); 400],
            measured: value.clone(),
            decay_rate: 0.0,
            variance: None,
            frequency: frequency.clone(),
        };
        EveryLine::of(&[record], &between, [&[fit(off[0])], &[fit(off[1])]]).unwrap()
    }

    /// Lines of 1.1 and 0.9 in turn, each over its own size; neighbours differ from the line between them by 0.2, which is
    /// $\sqrt{0.2^2/1.5}$ of scatter.
    #[test]
    fn scatter_stays_in_the_error_of_every_line_and_is_told() {
        let over_both = |high: f64, low: f64| ((high / 1.1).powi(2) / 2.0 + (low / 0.9).powi(2) / 2.0).sqrt();
        let found = told(0.1, [0.3, 0.0]);
        let scatter = 0.2 / 1.5_f64.sqrt();
        let expected = [over_both(0.2, 0.4), over_both(0.1, 0.1), over_both(scatter, scatter)];
        for (found, expected) in [found.before, found.after, found.scatter].into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 5e-3, "{found}, expected {expected}");
        }
        assert!(found.note().is_some());
        assert_eq!(told(0.0, [0.3, 0.1]).note(), None);
    }
}
