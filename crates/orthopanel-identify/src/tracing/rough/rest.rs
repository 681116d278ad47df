//! What roughness leaves that no few numbers tell: waves of the core too short to be among them, faces that are not even either.

use crate::tracing::model_error::slope;
use crate::tracing::widened_lines::WidenedLines;

/// Standard deviations of a rough test's motion beside its model, shared by all hypotheses: a `part` of the motion $h$ itself,
/// and that of a resonance whose frequency is off by the part `tuning`, so that a line has the variance
/// $s^2 + (\text{part}\,|h|)^2 + (\text{tuning}\,|s\,dh/ds|)^2$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::tracing) struct RoughRest {
    pub part: f64,
    pub tuning: f64,
}

/// Values of either number that are tried: the most, and how many times it is halved.
const MOST: RoughRest = RoughRest { part: 1e-2, tuning: 4e-4 };
const HALVED: i32 = 12;

impl RoughRest {
    /// Where the estimate begins: wide enough that no search follows the strongest peak alone.
    pub(in crate::tracing) const USUAL: Self = Self { part: 2e-3, tuning: 1e-4 };

    /// What all of a test's roughness may make of a plain model's lines: some millimetres of the shortest half-waves, and a core
    /// half a per cent uneven.
    pub(super) const OF_PLAIN: Self = Self { part: 1e-2, tuning: 1e-3 };

    /// Adds this to the variances of a record and of its hits.
    pub(in crate::tracing) fn widen(&self, record: &mut WidenedLines) {
        record.widen(|record, line| {
            let [part, tuning] = powers(record, line);
            self.part.powi(2) * part + self.tuning.powi(2) * tuning
        });
    }

    /// The two numbers at which residuals are likeliest, of all $\sum\ln v + |r|^2/v$ the least; `residuals` are over the
    /// deviations of the records, to which this has been added.
    pub(super) fn estimated(self, records: &[WidenedLines], residuals: &[Vec<num_complex::Complex64>]) -> Self {
        let lines: Vec<[f64; 4]> = records
            .iter()
            .zip(residuals)
            .flat_map(|(record, residuals)| {
                residuals.iter().enumerate().map(|(line, residual)| {
                    let [part, tuning] = powers(record, line);
                    let rest = self.part.powi(2) * part + self.tuning.powi(2) * tuning;
                    let variance = record.variance[line];
                    // Rounding must not leave less than nothing of the noise.
                    let noise = (variance - rest).max(1e-9 * variance);
                    [noise, part, tuning, residual.norm_sqr() * variance]
                })
            })
            .collect();
        let tried = (0..=HALVED).flat_map(|i| {
            let part = MOST.part * 0.5_f64.powi(i);
            (0..=HALVED).map(move |j| Self { part, tuning: MOST.tuning * 0.5_f64.powi(j) })
        });
        let unlikely = |rest: &Self| -> f64 {
            let (part, tuning) = (rest.part.powi(2), rest.tuning.powi(2));
            let each = lines.iter().map(|[noise, of_part, of_tuning, missed]| {
                let variance = noise + part * of_part + tuning * of_tuning;
                variance.ln() + missed / variance
            });
            each.sum()
        };
        let costed = tried.map(|rest| (unlikely(&rest), rest));
        costed.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(self, |(_, rest)| rest)
    }
}

/// $|h|^2$ and $|s\,dh/ds|^2$ of a line.
fn powers(record: &WidenedLines, line: usize) -> [f64; 2] {
    [record.value[line].norm_sqr(), (record.s[line] * slope(record, line)).norm_sqr()]
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use num_complex::Complex64;
    use orthopanel_model::Place;

    use super::*;

    /// A resonance with a known misfit, an eighth of the noise beside it.
    #[test]
    fn val_the_part_that_was_missed_is_found() {
        let place = Place { x: 0.0, y: 0.0 };
        let s: Vec<Complex64> = (1..800).map(|line| Complex64::new(6.0, 20.0 * line as f64)).collect();
        let value: Vec<Complex64> = s.iter().map(|s| s * s / (s * s + 40.0 * s + 6.4e7)).collect();
        let missed = |line: usize| Complex64::from_polar(1.25e-3, (line * line) as f64) * value[line];
        let rest = RoughRest { part: 1e-5, tuning: 1e-6 };
        let mut record = WidenedLines {
            force_at: place,
            response_at: place,
            variance: vec![1e-12; s.len()],
            by_force: vec![],
            scatter: None,
            hits: vec![],
            noise: OnceLock::new(),
            s,
            value: value.clone(),
        };
        rest.widen(&mut record);
        let residuals = (0..value.len()).map(|line| missed(line) / record.variance[line].sqrt()).collect();
        let found = rest.estimated(&[record], &[residuals]);
        assert!((found.part / 1.25e-3 - 1.0).abs() < 0.01 && found.tuning < 1e-6, "{found:?}");
    }
}
