//! How far a fit may miss a list, and whether it does by more.

use orthopanel_model::{End, Readable};

use super::list_fit::ListFit;
use super::list_problem::ListProblem;

/// What any model of a panel is trusted to beside the noise \[1\]: the paper's piece 1 is met to 0.22 % rms, of which rounding to
/// the analyser's bins makes half.
const TRUST: f64 = 2.5e-3;
/// Where a list does not tell its noise, this rms error is too much for a panel that hangs free \[1\]: the paper's four pieces are
/// met to 0.2 to 1.04 % rms by a beam.
const FREE: f64 = 1.25e-2;
/// and this where an end is held: no clamp is an edge of a drawing, a length to it is good to a millimetre or two.
const HELD: f64 = 2e-2;
/// Where the noise is told, its mean square may stand above one by so many of its own standard deviations.
const SURE: f64 = 3.0;
/// A frequency may miss what the others foretell of it by so many times what a fit may miss: where the fewest are measured that an
/// effect is tried on, every other frequency fixes an unknown, and the ends of a list lean on themselves the most.
const FORETOLD: f64 = 5.0;

/// and by so many times where effects stand untested that the list is too short for.
const WITHIN_NOISE: f64 = 1.5;

/// What a test may miss.
pub(super) enum Trust {
    /// Relative standard deviation of each frequency, noise and model together.
    Told(Vec<f64>),
    /// Rms error \[1\].
    Untold(f64),
}

impl Trust {
    pub(super) fn of(problem: &ListProblem) -> Self {
        if let Some(noise) = problem.noise() {
            // Scatter is what the tester saw frequencies miss; rounding is the least of what they do.
            let scatters = problem.lists.iter().flat_map(|list| list.measured.iter().map(|_| !list.scatter.is_empty()));
            let together = |(std, scatters): (f64, bool)| if scatters { std.max(TRUST) } else { std.hypot(TRUST) };
            return Self::Told(noise.into_iter().zip(scatters).map(together).collect());
        }
        let free = |list: &super::list_problem::FrequencyList| {
            [list.setting.boundary.left, list.setting.boundary.right] == [End::Free, End::Free]
        };
        Self::Untold(if problem.lists.iter().all(free) { FREE } else { HELD })
    }

    /// Mean square of what a fit misses, over what it may miss.
    pub(super) fn chi_square(&self, fit: &ListFit) -> f64 {
        self.in_units(&fit.residuals).iter().sum::<f64>() / fit.residuals.len().max(1) as f64
    }

    /// Squares of what is missed over what may be.
    fn in_units(&self, missed: &[f64]) -> Vec<f64> {
        match self {
            Self::Told(std) => missed.iter().zip(std).map(|(miss, std)| (miss / std).powi(2)).collect(),
            Self::Untold(rms) => missed.iter().map(|miss| (miss / rms).powi(2)).collect(),
        }
    }

    /// Up to which [`Self::chi_square`] a fit meets the lists.
    fn most(&self) -> f64 {
        match self {
            Self::Told(std) => 1.0 + SURE * (2.0 / std.len().max(1) as f64).sqrt(),
            Self::Untold(_) => 1.0,
        }
    }

    pub(super) fn is_met(&self, fit: &ListFit) -> bool {
        self.chi_square(fit) <= self.most()
    }

    /// Whether the others foretell each frequency: a fit with an unknown for almost every one meets all and foretells none.
    pub(super) fn is_foretold(&self, fit: &ListFit) -> bool {
        self.of_foretold(fit) <= FORETOLD.powi(2) * self.most()
    }

    fn of_foretold(&self, fit: &ListFit) -> f64 {
        let (missed, foretold) = (self.in_units(&fit.left_out), fit.foretold());
        foretold.iter().map(|&at| missed[at]).sum::<f64>() / foretold.len().max(1) as f64
    }

    /// Whether nothing of what the others foretell leaves room for one more effect.
    pub(super) fn is_foretold_within_noise(&self, fit: &ListFit) -> bool {
        self.of_foretold(fit) <= WITHIN_NOISE.powi(2) * self.most()
    }

    /// What the verdict goes by, a sentence.
    pub(super) fn note(&self) -> String {
        match self {
            Self::Told(_) => format!(
                "the verdict holds what is left against the noise that the test file tells (scatter, or {0} % where that is less; \
                 rounding to the resolution with {0} % added): no model of a panel is trusted to better",
                100.0 * TRUST
            ),
            Self::Untold(rms) => format!(
                "the verdict takes up to {:.2} % rms for usual, since no noise is told: give scatter or resolution [Hz] in the \
                 measurement to be judged by that",
                100.0 * rms
            ),
        }
    }

    /// The error of a fit beside what it may be, in words.
    pub(super) fn said(&self, fit: &ListFit) -> String {
        let percent = Readable(fit.percent());
        match self {
            Self::Told(_) => format!(
                "{percent:.2} % rms; mean square {:.1} times that of the noise told and the {} % that a model of a panel is trusted to",
                Readable(self.chi_square(fit)),
                100.0 * TRUST
            ),
            Self::Untold(rms) => format!("{percent:.2} % rms, where up to {:.2} % is usual", 100.0 * rms),
        }
    }
}
