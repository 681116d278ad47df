//! What panels of a lot have in common and by how much they differ, apart from how well each is known.
//!
//! A constant of panel $i$ is measured as $y_i$ with the variance $v_i$; panels themselves differ by $\tau^2$:
//! $$y_i\sim N(\mu,\ \tau^2+v_i),\qquad w_i = \frac1{\tau^2+v_i},\qquad \hat\mu = \frac{\sum w_iy_i}{\sum w_i}.$$
//! $\tau$ is where the restricted likelihood
//! $$-\tfrac12\Big[\sum\ln(\tau^2+v_i)+\ln\sum w_i+\sum w_i(y_i-\hat\mu)^2\Big]$$
//! is greatest. Its interval is the one in which $Q(\tau) = \sum w_i(y_i-\hat\mu)^2$ lies within the quantiles of $\chi^2_{k-1}$, and that of the mean is
//! Hartung's and Knapp's, with Student's $t_{k-1}$.
//!
//! References: W. Viechtbauer, Statistics in Medicine 26 (2007) 37 (interval of $\tau$); W. Viechtbauer and M. W.-L. Cheung, Research Synthesis Methods 1
//! (2010) 112 (deleted residuals); J. Hartung and G. Knapp, Statistics in Medicine 20 (2001) 3875.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

/// A value and its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// In the constant's unit.
    pub value: f64,
    /// How well it is known, in the same unit.
    pub std: f64,
}

/// The lot's mean and spread of one constant, in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomEffects {
    /// $\hat\mu$.
    pub mean: f64,
    /// In which the mean lies at 95 %.
    pub mean_interval: [f64; 2],
    /// $\tau$, by which panels differ.
    pub spread: f64,
    /// In which $\tau$ lies at 95 %.
    pub spread_interval: [f64; 2],
    /// Median of the panels' own standard deviations.
    pub own: f64,
    /// Of each panel the deleted residual: how far it lies from what the others foretell of it, in standard deviations of both spreads.
    pub residuals: Vec<f64>,
    /// Size of a residual that one panel of such a lot exceeds at 5 %.
    pub limit: f64,
}

/// Panels that a mean and a spread want at least.
pub const FEWEST: usize = 3;

impl RandomEffects {
    /// Of the panels' values; `None` of fewer than three, and where a value or deviation is no number.
    pub fn of(panels: &[Measured]) -> Option<Self> {
        let sound = |panel: &Measured| panel.value.is_finite() && panel.std.is_finite() && panel.std >= 0.0;
        if panels.len() < FEWEST || !panels.iter().all(sound) {
            return None;
        }
        let spread = likeliest_spread(panels);
        let (mean, weights) = mean(panels, spread);
        let sum: f64 = weights.iter().sum();
        let free = (panels.len() - 1) as f64;
        let scatter = squares(panels, spread) / free;
        let half = quantile_of_t(0.975, free) * (scatter / sum).sqrt();
        let residuals = (0..panels.len()).map(|left_out| deleted_residual(panels, left_out)).collect();
        let mut own: Vec<f64> = panels.iter().map(|panel| panel.std).collect();
        own.sort_by(f64::total_cmp);
        Some(Self {
            mean,
            mean_interval: [mean - half, mean + half],
            spread,
            spread_interval: spread_interval(panels),
            own: own[own.len() / 2],
            residuals,
            limit: quantile_of_t(1.0 - 0.025 / panels.len() as f64, (panels.len() - 2) as f64),
        })
    }

    /// Panels whose residual is greater than the limit.
    pub fn outliers(&self) -> impl Iterator<Item = usize> + '_ {
        let residuals = self.residuals.iter().enumerate();
        residuals.filter(|(_, residual)| residual.abs() > self.limit).map(|(panel, _)| panel)
    }
}

/// $\hat\mu$ and $w_i$ at a spread.
fn mean(panels: &[Measured], spread: f64) -> (f64, Vec<f64>) {
    let weights: Vec<f64> = panels.iter().map(|panel| variance(panel, spread).recip()).collect();
    let sum: f64 = weights.iter().sum();
    let moment: f64 = weights.iter().zip(panels).map(|(weight, panel)| weight * panel.value).sum();
    (moment / sum, weights)
}

/// $\tau^2+v_i$; where both are zero the least number that has an inverse.
fn variance(panel: &Measured, spread: f64) -> f64 {
    (spread * spread + panel.std * panel.std).max(f64::MIN_POSITIVE.sqrt())
}

/// $Q$.
fn squares(panels: &[Measured], spread: f64) -> f64 {
    let (mean, weights) = mean(panels, spread);
    weights.iter().zip(panels).map(|(weight, panel)| weight * (panel.value - mean).powi(2)).sum()
}

/// Slope of the restricted likelihood by $\tau^2$: $\tfrac12\big[\sum w_i^2(y_i-\hat\mu)^2-\sum w_i+\sum w_i^2/\sum w_i\big]$.
fn slope(panels: &[Measured], spread: f64) -> f64 {
    let (mean, weights) = mean(panels, spread);
    let sum: f64 = weights.iter().sum();
    let of_squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    let missed: f64 = weights.iter().zip(panels).map(|(weight, panel)| (weight * (panel.value - mean)).powi(2)).sum();
    0.5 * (missed - sum + of_squares / sum)
}

/// Where a function that falls with the spread is zero; none where it is below zero at no spread.
fn root(panels: &[Measured], falling: impl Fn(f64) -> f64) -> f64 {
    if falling(0.0) <= 0.0 {
        return 0.0;
    }
    let values = panels.iter().map(|panel| panel.value);
    let range = values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min);
    let (mut low, mut high) = (0.0, range.max(f64::MIN_POSITIVE.sqrt()));
    while falling(high) > 0.0 && high.is_finite() {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if falling(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Halvings of the range of the values: to the last digit of a double.
const BISECTIONS: usize = 60;

fn likeliest_spread(panels: &[Measured]) -> f64 {
    root(panels, |spread| slope(panels, spread))
}

fn spread_interval(panels: &[Measured]) -> [f64; 2] {
    let free = (panels.len() - 1) as f64;
    [0.975, 0.025].map(|probability| {
        let quantile = ChiSquared::new(free).map_or(f64::NAN, |squared| squared.inverse_cdf(probability));
        root(panels, |spread| squares(panels, spread) - quantile)
    })
}

/// $(y_i-\hat\mu_{(i)})/\sqrt{v_i+\tau_{(i)}^2+1/\sum w_{(i)}}$, of all but $i$.
fn deleted_residual(panels: &[Measured], left_out: usize) -> f64 {
    let others: Vec<Measured> =
        panels.iter().enumerate().filter(|(panel, _)| *panel != left_out).map(|(_, panel)| *panel).collect();
    let spread = likeliest_spread(&others);
    let (mean, weights) = mean(&others, spread);
    let panel = &panels[left_out];
    let foretold = variance(panel, spread) + weights.iter().sum::<f64>().recip();
    (panel.value - mean) / foretold.sqrt()
}

fn quantile_of_t(probability: f64, free: f64) -> f64 {
    StudentsT::new(0.0, 1.0, free).map_or(f64::NAN, |student| student.inverse_cdf(probability))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(values: &[f64], stds: &[f64]) -> Vec<Measured> {
        values.iter().zip(stds).map(|(&value, &std)| Measured { value, std }).collect()
    }

    /// Panels known exactly: mean, standard deviation and interval of the mean are those of any textbook.
    #[test]
    fn val_panels_known_exactly_have_the_usual_mean_and_deviation() {
        let values = [10.2, 10.6, 9.9, 10.4, 10.1];
        let found = RandomEffects::of(&measured(&values, &[0.0; 5])).unwrap();
        let mean = values.iter().sum::<f64>() / 5.0;
        let std = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 4.0).sqrt();
        assert!((found.mean - mean).abs() < 1e-12 && (found.spread / std - 1.0).abs() < 1e-9, "{found:?}");
        // t of four degrees of freedom is 2.776445 at 97.5 %.
        let half = 2.776_445_1 * std / 5.0_f64.sqrt();
        assert!((found.mean_interval[1] - mean - half).abs() < 1e-6, "{found:?}");
        // Of a variance: (n-1)s^2 over the quantiles 0.484419 and 11.143287 of chi-squared.
        let interval = [11.143_286_8_f64, 0.484_418_6].map(|quantile| std * (4.0 / quantile).sqrt());
        for (found, wanted) in found.spread_interval.iter().zip(interval) {
            assert!((found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
        }
    }

    /// Where panels scatter as little as each is known, they are one: the mean is weighted by what is known.
    #[test]
    fn panels_that_differ_by_their_own_deviations_have_no_spread() {
        let found = RandomEffects::of(&measured(&[1.0, 1.1, 0.9, 1.3], &[0.1, 0.1, 0.1, 0.5])).unwrap();
        assert_eq!(found.spread, 0.0);
        let mean = (1.0 + 1.1 + 0.9 + 1.3 / 25.0) / (3.0 + 1.0 / 25.0);
        assert!((found.mean - mean).abs() < 1e-12, "{found:?}");
        assert_eq!(found.outliers().count(), 0);
    }

    #[test]
    fn one_panel_far_from_the_others_is_an_outlier_and_does_not_hide_itself() {
        let values = [10.0, 10.1, 9.9, 10.05, 9.95, 10.02, 9.98, 12.0];
        let found = RandomEffects::of(&measured(&values, &[0.05; 8])).unwrap();
        assert_eq!(found.outliers().collect::<Vec<_>>(), [7], "{:?}, {}", found.residuals, found.limit);
        // The same value, poorly known, tells nothing.
        let mut stds = [0.05; 8];
        stds[7] = 1.0;
        assert_eq!(RandomEffects::of(&measured(&values, &stds)).unwrap().outliers().count(), 0);
    }

    #[test]
    fn too_few_panels_and_what_is_no_number_have_no_spread() {
        assert_eq!(RandomEffects::of(&measured(&[1.0, 2.0], &[0.1; 2])), None);
        assert_eq!(RandomEffects::of(&measured(&[1.0, 2.0, f64::NAN], &[0.1; 3])), None);
        let alike = RandomEffects::of(&measured(&[1.0; 4], &[0.0; 4])).unwrap();
        assert!(alike.spread < 1e-12 && alike.outliers().count() == 0, "{alike:?}");
    }
}
