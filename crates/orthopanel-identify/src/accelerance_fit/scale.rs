//! The factor and the delay with which a record is nearest to its model.
//!
//! A response that is sampled late by $T$ is $e^{-sT}$ times what it should be: a delay of 50 µs turns it by 80° at 4.5 kHz, and hides
//! factor and sign in the phase. So $H_{exp}e^{sT}/H_{cal}$ is looked at, which is one real number at all lines for the right $T$.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::misfit::{median, scaled_misfit_percent};
use super::records::PlaceRecord;

/// Lines of a record that are looked at: the median of these is that of all.
const LINES: usize = 1200;
/// Fewer lines than these tell no factor.
const LEAST_LINES: usize = 30;
/// Delays up to this \[s\] are looked for: many times the group delay of converters and their filters.
const LONGEST: f64 = 1e-3;
/// Steps of delay within a period of the highest line: the sum of the phasors falls by 5 % half a step beside its peak.
const STEPS: f64 = 8.0;
/// A delay is taken where it leaves less than this part of the median misfit.
const MENDS: f64 = 0.5;
/// Passes of least squares over the phases that are left.
const PASSES: usize = 3;

/// A record and its model on the lines that both have.
pub(super) struct Compared {
    record: PlaceRecord,
    model: Vec<Complex64>,
}

/// The factor on a record with which it is nearest to its model.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// The model over the record.
    pub factor: f64,
    /// Median misfit that is left with it \[%\].
    pub left: f64,
}

impl Compared {
    /// A record beside the `lines` of its model at these frequencies \[Hz\]; `None` where they share too few.
    pub fn of(record: &PlaceRecord, frequencies: &[f64], lines: &[Complex64]) -> Option<Self> {
        // Noise leaves lines out of one reading and not of another.
        let line_of = |frequency: &f64| {
            let next = frequencies.partition_point(|line| *line < frequency * (1.0 - 1e-9));
            let found = frequencies.get(next).is_some_and(|line| (line / frequency - 1.0).abs() < 1e-9);
            lines.get(next).copied().filter(|model| found && model.norm() > 0.0)
        };
        let mut thin = record.thinned(LINES);
        let models: Vec<Option<Complex64>> = thin.frequency.iter().map(line_of).collect();
        let kept: Vec<usize> = (0..models.len()).filter(|&line| models[line].is_some()).collect();
        let of_kept = |values: &[f64]| kept.iter().map(|&line| values[line]).collect();
        thin.value = kept.iter().map(|&line| thin.value[line]).collect();
        thin.variance = of_kept(&thin.variance);
        thin.frequency = of_kept(&thin.frequency);
        (kept.len() >= LEAST_LINES).then(|| Self { record: thin, model: models.into_iter().flatten().collect() })
    }

    /// The factor with which the record is nearest, sampled late by `delay` \[s\].
    pub fn scale(&self, delay: f64) -> Scale {
        let late = |(line, model): (usize, &Complex64)| model * (-self.record.s(line) * delay).exp();
        let model: Vec<Complex64> = self.model.iter().enumerate().map(late).collect();
        let factor = median(self.record.value.iter().zip(&model).map(|(measured, model)| (measured / model).re));
        let left = match factor {
            0.0 => f64::INFINITY,
            _ => scaled_misfit_percent(&self.record, &model, factor),
        };
        Scale { factor: 1.0 / factor, left }
    }

    /// The factor of the lines in the lowest `part` of the band alone.
    pub fn factor_below(&self, part: f64, delay: f64) -> f64 {
        let end = part * self.record.band_end();
        let ratio = |line: usize| self.record.value[line] / self.model[line] * (self.record.s(line) * delay).exp();
        let low = (0..self.model.len()).filter(|line| self.record.frequency[*line] < end);
        1.0 / median(low.map(|line| ratio(line).re))
    }

    /// Median misfit \[%\] of the record over $s^n$, which is what it was read as.
    pub fn misfit_as_read(&self, derivatives: i8) -> f64 {
        let with_s = |(line, model): (usize, &Complex64)| model * self.record.s(line).powi(i32::from(derivatives));
        let model: Vec<Complex64> = self.model.iter().enumerate().map(with_s).collect();
        scaled_misfit_percent(&self.record, &model, 1.0)
    }

    /// The phase of each line over its model's as a phasor, shorter where noise drowns the line.
    fn phasors(&self) -> Vec<Complex64> {
        let lines = self.record.value.iter().zip(&self.model).zip(&self.record.variance);
        let of_line = |((measured, model), variance): ((&Complex64, &Complex64), &f64)| {
            let ratio = measured / model;
            let noise = if self.record.variance_known { 3.0 * variance.sqrt() } else { 0.0 };
            let weight = measured.norm() / measured.norm().max(noise);
            if ratio.norm() > 0.0 && weight.is_finite() { ratio / ratio.norm() * weight } else { Complex64::ZERO }
        };
        lines.map(of_line).collect()
    }
}

/// The delay \[s\] that all these records share; zero where none mends them.
pub(super) fn common_delay(records: &[Compared]) -> f64 {
    let highest = records.iter().map(|of| of.record.band_end()).fold(0.0, f64::max);
    if highest <= 0.0 {
        return 0.0;
    }
    let step = 1.0 / (STEPS * highest);
    let count = (LONGEST / step).floor();
    let phasors: Vec<Vec<Complex64>> = records.iter().map(Compared::phasors).collect();
    let turned = |by: f64| -> Vec<Vec<Complex64>> {
        let of_record = |(of, phasors): (&Compared, &Vec<Complex64>)| {
            let turn = |(phasor, f): (&Complex64, &f64)| phasor * Complex64::cis(TAU * f * by);
            phasors.iter().zip(&of.record.frequency).map(turn).collect()
        };
        records.iter().zip(&phasors).map(of_record).collect()
    };
    // Each record may have a sign of its own.
    let met = |at: &[Vec<Complex64>]| -> f64 {
        at.iter().map(|phasors| phasors.iter().map(|phasor| phasor.re).sum::<f64>().abs()).sum()
    };
    let steps: Vec<Vec<Complex64>> =
        records.iter().map(|of| of.record.frequency.iter().map(|f| Complex64::cis(TAU * f * step)).collect()).collect();
    let mut at = turned(-count * step);
    let (mut best, mut delay) = (0.0, 0.0);
    for index in 0..=2 * count as usize {
        let found = met(&at);
        if found > best {
            (best, delay) = (found, (index as f64 - count) * step);
        }
        let lines = at.iter_mut().flatten().zip(steps.iter().flatten());
        lines.for_each(|(phasor, step)| *phasor *= step);
    }
    for _ in 0..PASSES {
        let (mut along, mut squares) = (0.0, 0.0);
        for (phasors, of) in turned(delay).iter().zip(records) {
            let sign = phasors.iter().map(|phasor| phasor.re).sum::<f64>().signum();
            for (phasor, f) in phasors.iter().zip(&of.record.frequency) {
                let (weight, phase) = (phasor.norm(), (sign * phasor).arg());
                // What stands across is no matter of the delay.
                if phase.abs() < 1.0 {
                    along += weight * TAU * f * phase;
                    squares += weight * (TAU * f).powi(2);
                }
            }
        }
        if squares > 0.0 {
            delay -= along / squares;
        }
    }
    let left = |delay: f64| median(records.iter().map(|of| of.scale(delay).left));
    if left(delay) < MENDS * left(0.0) { delay } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two modes and a rigid one, as numbers.
    fn panel(f: f64) -> Complex64 {
        let s = Complex64::new(0.0, TAU * f);
        let mode = |f: f64, part: f64| part * s * s / (s * s + 0.01 * TAU * f * s + (TAU * f).powi(2));
        0.4 + mode(320.0, 0.5) - mode(840.0, 0.3)
    }

    /// The sign of each record, and the delay that they share, are found together.
    #[test]
    fn val_sign_and_delay_are_told_apart() {
        let frequency: Vec<f64> = (40..4000).map(f64::from).collect();
        let model: Vec<Complex64> = frequency.iter().map(|f| panel(*f)).collect();
        let of = |factor: f64, delay: f64| {
            let late = |(f, model): (&f64, &Complex64)| model / factor * Complex64::cis(-TAU * f * delay);
            let record = PlaceRecord::even(frequency.clone(), frequency.iter().zip(&model).map(late).collect());
            Compared::of(&record, &frequency, &model).unwrap()
        };
        for delay in [0.0, 20e-6, -50e-6, 3e-4] {
            let records = [of(-9.81, delay), of(9.81, delay)];
            let found = common_delay(&records);
            assert!((found - delay).abs() < 1e-8, "{delay}: {found}");
            let scales: Vec<Scale> = records.iter().map(|of| of.scale(found)).collect();
            assert!((scales[0].factor / -9.81 - 1.0).abs() < 1e-6 && (scales[1].factor / 9.81 - 1.0).abs() < 1e-6);
        }
    }
}
