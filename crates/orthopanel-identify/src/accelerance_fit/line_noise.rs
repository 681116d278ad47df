//! Variance of every line, told from a few hits and smoothed.

use orthopanel_data::Accelerance;

/// Lines on either side over which the noise is taken to be even.
const HALF_WINDOW: usize = 40;
/// Ratios of force noise to motion noise tried, as $|H|^2$ at which both weigh alike, relative to the median
/// $|H|^2$: lowest, highest and steps.
const RATIOS: (f64, f64, usize) = (1e-6, 1e4, 60);

/// Steps passed over in the first search for the ratio.
const STRIDE: usize = 5;

/// The variance $E|\hat H-H|^2$ of each line.
///
/// The scatter of $n$ hits tells a line's variance to $1/\sqrt{n-1}$ only: as weights such numbers would favour lines
/// that happen to scatter little. Noise on both channels gives $(N_a + |H|^2N_f)/|F|^2$, where everything but $|H|^2$
/// runs smoothly with frequency. So the shape $1 + r|H|^2$ is divided out, the rest averaged over neighbours, and $r$
/// chosen for the greatest likelihood of the scatter seen.
///
/// Where the records tell no variance, an even one is returned; the fit's own scatter then gives its size. The second number is $r$.
pub(super) fn line_variance(accelerance: &Accelerance) -> (Vec<f64>, f64) {
    let power: Vec<f64> = accelerance.value.iter().map(|value| value.norm_sqr()).collect();
    let Some(raw) = &accelerance.variance else {
        // Nothing is known but that strong lines carry the errors of gain: a thousandth of each and of the median.
        let floor = median(&power);
        return (power.iter().map(|p| 1e-6 * (p + floor)).collect(), 1.0 / floor);
    };
    most_likely(&power, |shape| raw.iter().zip(shape).map(|(v, s)| v / s).collect())
}

/// The same where the records tell a variance: what a residual is held against.
pub(crate) fn told_variance(accelerance: &Accelerance) -> Option<Vec<f64>> {
    accelerance.variance.as_ref()?;
    let (mut variance, _) = line_variance(accelerance);
    let by_force = accelerance.force_noise.iter().flat_map(|noise| &noise.variance);
    variance.iter_mut().zip(by_force).for_each(|(all, of)| *all = all.max(*of));
    Some(variance)
}

/// The likeliest variance $l(1 + r|H|^2)$ with a level $l$ even over neighbours, and its $r$; `quotient` gives each line's own variance
/// over such a shape.
pub(super) fn most_likely(power: &[f64], quotient: impl Fn(&[f64]) -> Vec<f64>) -> (Vec<f64>, f64) {
    let typical = median(power).max(f64::MIN_POSITIVE);
    let ratio = |step: usize| {
        let (lowest, highest, steps) = RATIOS;
        lowest * (highest / lowest).powf(step as f64 / steps as f64) / typical
    };
    let smooth = |step: usize| {
        let ratio = ratio(step);
        let shape: Vec<f64> = power.iter().map(|p| 1.0 + ratio * p).collect();
        let quotient = quotient(&shape);
        let level = running_mean(&quotient);
        let variance: Vec<f64> = level.iter().zip(&shape).map(|(l, s)| (l * s).max(f64::MIN_POSITIVE)).collect();
        let own: Vec<f64> = quotient.iter().zip(&shape).map(|(q, s)| q * s).collect();
        (own, variance)
    };
    // Gamma likelihood of the lines' own variances given the smooth ones.
    let misfit = |step: usize| -> f64 {
        let (own, variance) = smooth(step);
        let pairs = own.iter().zip(variance).filter(|(own, _)| own.is_finite());
        pairs.map(|(own, smooth)| own / smooth + smooth.ln()).sum()
    };
    let least = |steps: &mut dyn Iterator<Item = usize>| {
        let scored = steps.map(|step| (misfit(step), step));
        scored.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, step)| step)
    };
    // Every few steps, then each beside the best: the misfit bends but slowly with the ratio.
    let coarse = least(&mut (0..=RATIOS.2).step_by(STRIDE));
    let nearest = coarse.saturating_sub(STRIDE - 1)..=(coarse + STRIDE - 1).min(RATIOS.2);
    let best = least(&mut { nearest });
    (smooth(best).1, ratio(best))
}

/// Mean over the neighbours within [`HALF_WINDOW`], lines without a finite value left out.
fn running_mean(values: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0)];
    for value in values {
        let (sum, count) = sums.last().copied().unwrap_or_default();
        sums.push(if value.is_finite() { (sum + value, count + 1.0) } else { (sum, count) });
    }
    (0..values.len())
        .map(|line| {
            let (from, to) = (line.saturating_sub(HALF_WINDOW), (line + HALF_WINDOW + 1).min(values.len()));
            let (sum, count) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
            if count > 0.0 { sum / count } else { f64::INFINITY }
        })
        .collect()
}

fn median(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(1.0)
}
