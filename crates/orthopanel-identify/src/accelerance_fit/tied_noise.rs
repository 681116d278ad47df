//! The force's noise under a window, apart from what is independent from line to line.

use orthopanel_data::{Accelerance, ForceNoise};

/// The noise of the force under a window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TiedNoise {
    /// Half the window's width \[s\].
    pub half_width: f64,
    /// The part of each line's variance that comes from it.
    pub variance: Vec<f64>,
    /// The rest of it, independent from line to line.
    pub independent: Vec<f64>,
}

/// Lines on either side over which the scatter of the hits is held against what their channels tell.
const HALF_WINDOW: usize = 200;

impl TiedNoise {
    /// At these of the lines.
    pub(super) fn of(noise: &ForceNoise, accelerance: &Accelerance, lines: &[usize]) -> Self {
        let level = match &accelerance.variance {
            Some(scatter) if accelerance.hits > 1 => level(noise, scatter),
            _ => vec![1.0; noise.independent.len()],
        };
        let at = |of: &[f64]| lines.iter().map(|&line| of.get(line).copied().unwrap_or_default()).collect::<Vec<f64>>();
        let mut independent = at(&noise.independent);
        independent.iter_mut().zip(at(&level)).for_each(|(own, level)| *own = (*own * level).max(f64::MIN_POSITIVE));
        Self { half_width: noise.half_width, variance: at(&noise.variance), independent }
    }

    /// Times at which noise under the window enters, from its middle \[s\]: between any two of them lie less than half a period of
    /// the highest line, so that no two lines, nor a line and another's mirror image at negative frequency, look alike.
    pub(super) fn times(&self, band: f64) -> Vec<f64> {
        let count = (5.0 * self.half_width * band).ceil().max(1.0);
        (0..=count as usize).map(|time| (2.0 * time as f64 / count - 1.0) * self.half_width).collect()
    }
}

/// The scatter of the hits over what their channels tell of it, averaged over neighbours; lines that the force's noise makes
/// count little, since that wanders together with all its neighbours'.
fn level(noise: &ForceNoise, scatter: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0)];
    for ((tied, independent), scatter) in noise.variance.iter().zip(&noise.independent).zip(scatter) {
        let (seen, told) = sums.last().copied().unwrap_or_default();
        let all = tied + independent;
        // Relative to what is told, so that strong lines count no more than weak ones.
        let weight = (independent / all).powi(2);
        let counts = scatter.is_finite() && weight.is_finite();
        sums.push(if counts { (seen + weight * scatter / all, told + weight) } else { (seen, told) });
    }
    let count = sums.len() - 1;
    (0..count)
        .map(|line| {
            let (from, to) = (line.saturating_sub(HALF_WINDOW), (line + HALF_WINDOW + 1).min(count));
            let (seen, told) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
            if told > 0.0 { seen / told } else { 1.0 }
        })
        .collect()
}
