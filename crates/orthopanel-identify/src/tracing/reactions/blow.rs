//! The hammer's blow, cut out of its channel.

use orthopanel_data::Hit;

use crate::tracing::widened_lines::median;

/// Half the width of the window over the force \[s\]: the hammer has left the piece, its channel's noise stays out.
pub(in crate::tracing) const HALF_WIDTH: f64 = 4e-3;

/// A force without its offset, zero outside its window.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::tracing) struct Blow {
    /// \[N\], from the beginning of the record to the window's end.
    pub force: Vec<f64>,
    /// The strongest sample.
    pub peak: usize,
    /// The channel's offset \[N\].
    pub offset: f64,
    /// Half the window's width in samples.
    pub reach: usize,
}

impl Blow {
    pub(in crate::tracing) fn of(hit: &Hit, rate: f64) -> Self {
        let offset = median(&hit.force);
        let away = |n: usize| (hit.force[n] - offset).abs();
        let peak = (0..hit.force.len()).max_by(|&a, &b| away(a).total_cmp(&away(b))).unwrap_or(0);
        let reach = (HALF_WIDTH * rate) as usize;
        let windowed = hit.force.iter().take(peak + reach + 1).enumerate();
        let force = windowed.map(|(n, f)| if n.abs_diff(peak) <= reach { f - offset } else { 0.0 }).collect();
        Self { force, peak, offset, reach }
    }

    /// Whether a sample lies in the window.
    pub(in crate::tracing) fn holds(&self, sample: usize) -> bool {
        sample.abs_diff(self.peak) <= self.reach
    }
}
