//! Charts of individuals and moving ranges: whether a lot's panels come from one process.
//!
//! Of values $y_i$ in the order of making, $MR_i = |y_i-y_{i-1}|$. Two values of one normal process differ by $d_2\sigma$ in the mean, $d_2 = 2/\sqrt\pi$, with the
//! deviation $d_3\sigma$, $d_3 = \sqrt{2-4/\pi}$. So the limits of individuals are $\bar y\pm3\overline{MR}/d_2$, and that of moving ranges is
//! $\overline{MR}(1+3d_3/d_2)$.
//!
//! Reference: D. C. Montgomery, Introduction to Statistical Quality Control (2012), section 6.4; L. S. Nelson, J. Quality Technology 16 (1984) 237.

use std::f64::consts::PI;

/// Both charts of one constant, in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlChart {
    /// $\bar y$.
    pub centre: f64,
    /// Limits of individuals, lower and upper.
    pub limits: [f64; 2],
    /// Moving ranges, from the second value on.
    pub ranges: Vec<f64>,
    /// $\overline{MR}$.
    pub mean_range: f64,
    /// Upper limit of moving ranges; the lower one is zero.
    pub range_limit: f64,
    /// Values beyond a limit.
    pub beyond: Vec<usize>,
    /// Values that end a run of nine or more on one side of the centre.
    pub in_a_run: Vec<usize>,
    /// Values whose moving range is beyond its limit.
    pub jumps: Vec<usize>,
}

/// Values in a row on one side of the centre that are no chance: one of 256 runs of a process that keeps its mean (Nelson's second rule).
pub const RUN: usize = 9;

/// Values that a chart wants at least.
pub const FEWEST: usize = 3;

impl ControlChart {
    /// Of values in their order; `None` of fewer than three, or where one is no number.
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.len() < FEWEST || !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let centre = values.iter().sum::<f64>() / values.len() as f64;
        let ranges: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
        let mean_range = ranges.iter().sum::<f64>() / ranges.len() as f64;
        let (of_mean, of_deviation) = (2.0 / PI.sqrt(), (2.0 - 4.0 / PI).sqrt());
        let half = 3.0 * mean_range / of_mean;
        let limits = [centre - half, centre + half];
        let range_limit = mean_range * (1.0 + 3.0 * of_deviation / of_mean);
        let outside = |value: f64| value < limits[0] || value > limits[1];
        let mut in_a_run = Vec::new();
        let (mut side, mut length) = (0.0, 0);
        for (number, value) in values.iter().enumerate() {
            let own = if *value == centre { 0.0 } else { (value - centre).signum() };
            length = if own != 0.0 && own == side { length + 1 } else { usize::from(own != 0.0) };
            side = own;
            if length >= RUN {
                in_a_run.push(number);
            }
        }
        Some(Self {
            centre,
            limits,
            mean_range,
            range_limit,
            beyond: (0..values.len()).filter(|&number| outside(values[number])).collect(),
            in_a_run,
            jumps: (1..values.len()).filter(|&number| ranges[number - 1] > range_limit).collect(),
            ranges,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Montgomery's factors: 3/d2 = 2.66 and D4 = 3.267 of two values.
    #[test]
    fn val_limits_are_those_of_the_tables() {
        let chart = ControlChart::of(&[10.0, 11.0, 10.0, 11.0]).unwrap();
        assert_eq!((chart.centre, chart.mean_range), (10.5, 1.0));
        assert!((chart.limits[1] - 10.5 - 2.6587).abs() < 1e-3, "{:?}", chart.limits);
        assert!((chart.range_limit - 3.267).abs() < 1e-3, "{}", chart.range_limit);
        assert!(chart.beyond.is_empty() && chart.jumps.is_empty() && chart.in_a_run.is_empty());
    }

    #[test]
    fn a_value_beyond_its_limits_a_jump_and_a_run_are_found() {
        let mut values = vec![10.0, 10.1, 9.9, 10.05, 9.95, 10.0, 10.1, 9.9];
        values.push(13.0);
        let chart = ControlChart::of(&values).unwrap();
        assert_eq!((&chart.beyond[..], &chart.jumps[..]), (&[8][..], &[8][..]), "{chart:?}");
        let shifted: Vec<f64> = (0..20).map(|n| if n < 10 { 1.0 } else { 2.0 } + 0.01 * f64::from(n % 2)).collect();
        assert_eq!(ControlChart::of(&shifted).unwrap().in_a_run, [8, 9, 18, 19]);
    }

    #[test]
    fn too_few_values_and_what_is_no_number_have_no_chart() {
        assert_eq!(ControlChart::of(&[1.0, 2.0]), None);
        assert_eq!(ControlChart::of(&[1.0, 2.0, f64::INFINITY]), None);
    }
}
