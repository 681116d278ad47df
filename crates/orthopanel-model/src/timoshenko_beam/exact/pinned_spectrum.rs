//! Natural frequencies of the beam pinned at both ends, in closed form: the brackets of every other search.

use std::f64::consts::PI;

use super::end_conditions::Family;
use super::waves::Ratios;

/// The two values of $\mu$ at which a wave of wave number $\kappa$ travels, lower first:
/// $\mu^2r^2s^2 - \mu(1+(r^2+s^2)\kappa^2) + \kappa^4 = 0$.
pub(super) fn travelling(ratios: Ratios, wave_number: f64) -> [f64; 2] {
    let Ratios { r2, s2 } = ratios;
    let k2 = wave_number * wave_number;
    let middle = 1.0 + (r2 + s2) * k2;
    let root = ((1.0 + (r2 - s2) * k2).powi(2) + 4.0 * s2 * k2).sqrt();
    [2.0 * k2 * k2 / (middle + root), (middle + root) / (2.0 * r2 * s2)]
}

/// Rising values of $\mu$ of one family, from both branches, with the wave number of each.
pub(super) struct PinnedSpectrum {
    ratios: Ratios,
    step: usize,
    lower: usize,
    upper: usize,
}

impl PinnedSpectrum {
    pub(super) fn new(ratios: Ratios, family: Family) -> Self {
        let (first, step) = match family {
            Family::Even => (1, 2),
            Family::Odd => (2, 2),
            Family::Mixed => (1, 1),
        };
        // The upper branch begins with pure shear, wave number zero, which belongs to the odd family.
        Self { ratios, step, lower: first, upper: first - if family == Family::Even { 0 } else { step } }
    }
}

impl Iterator for PinnedSpectrum {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let lower = travelling(self.ratios, self.lower as f64 * PI)[0];
        let upper = travelling(self.ratios, self.upper as f64 * PI)[1];
        if lower <= upper {
            self.lower += self.step;
            Some(lower)
        } else {
            self.upper += self.step;
            Some(upper)
        }
    }
}
