//! How an identification is to be done.

use orthopanel_data::{Estimation, Window};

use crate::{DampingLaw, IdentifyError};

/// How to search for the minimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Search {
    /// Least squares on exact derivatives: eq. 22 for frequencies, maximum likelihood for records.
    #[default]
    LeastSquares,
    /// The paper's downhill simplex with a penalty: eq. 24 for frequencies, eq. 25 for records. Eq. 23 weighs all resonances
    /// alike, whatever their noise, and with the paper's weights magnitudes lead and frequencies yield: at 1 % noise and several
    /// places, constants stray by 0.1 %, hundreds of times further than those of the likelihood. Standard deviations from records
    /// are what the noise of the resonances does to that minimum; they do not know of what the model lacks.
    Simplex,
}

/// All choices of an identification; the default is what we recommend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The search.
    pub search: Search,
    /// How records become accelerances; by default with [`Window::AsNeeded`], since the model is evaluated at the
    /// window's own $s$ and nothing is lost by it.
    pub estimation: Estimation,
    /// How modes lose energy.
    pub damping_law: DampingLaw,
    /// Weights of the paper's error on records; [`Search::Simplex`] alone asks for them.
    pub paper_weights: PaperWeights,
}

/// $W_f$ and $W_G$ of eq. 23, which weighs a resonance's frequency against its magnitude:
/// $$W_f\sum_m\left(\frac{f_{exp}-f_{cal}}{f_{exp}}\right)^2 + W_G\sum_m\left(\frac{G(f_{exp})-G(f_{cal})}{G(f_{exp})}\right)^2.$$
///
/// Both are zero or greater. Only their ratio matters; the default is that of the paper's section 3.4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperWeights {
    /// $W_f$ \[1\].
    pub frequency: f64,
    /// $W_G$ \[1\].
    pub magnitude: f64,
}

impl PaperWeights {
    /// # Errors
    /// [`IdentifyError::PaperWeights`] for a weight that is negative or not finite, and where both are zero.
    pub(crate) fn check(self) -> Result<(), IdentifyError> {
        let Self { frequency, magnitude } = self;
        let sound = [frequency, magnitude].iter().all(|weight| weight.is_finite() && *weight >= 0.0);
        if sound && frequency + magnitude > 0.0 {
            return Ok(());
        }
        Err(IdentifyError::PaperWeights { frequency, magnitude })
    }
}

impl Default for PaperWeights {
    fn default() -> Self {
        Self { frequency: 0.1, magnitude: 1e4 }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            search: Search::default(),
            estimation: Estimation { window: Window::AsNeeded, ..Estimation::default() },
            damping_law: DampingLaw::default(),
            paper_weights: PaperWeights::default(),
        }
    }
}

impl From<Search> for Settings {
    fn from(search: Search) -> Self {
        Self { search, ..Self::default() }
    }
}
