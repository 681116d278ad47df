//! How hits become an accelerance: window, estimator, and where the band ends.

use super::window::Window;

/// How spectra are averaged into an accelerance. With $S_{ff} = \overline{|F|^2}$, $S_{aa} = \overline{|A|^2}$ and
/// $S_{fa} = \overline{\bar F A}$ over the hits:
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// $H_1 = S_{fa}/S_{ff}$: noise on the response averages out. Right at antiresonances, and where the hammer's
    /// channel is the cleaner one, as it mostly is.
    #[default]
    H1,
    /// $H_2 = S_{aa}/\overline{S_{fa}}$: noise on the force averages out. Right at resonances.
    H2,
    /// $H_v = \sqrt{S_{aa}/S_{ff}}\; S_{fa}/|S_{fa}|$: noise on both, in proportion; between the other two.
    Hv,
}

/// How hits become an accelerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimation {
    /// The window over each hit.
    pub window: Window,
    /// The estimator.
    pub estimator: Estimator,
    /// The band ends where the force spectrum has fallen by this much below its greatest line \[dB\]; infinite keeps
    /// all lines. 30 dB by default: a choice on the generous side, since the variance weighs the weak lines anyway.
    pub force_drop: f64,
}

impl Default for Estimation {
    fn default() -> Self {
        Self { window: Window::None, estimator: Estimator::H1, force_drop: 30.0 }
    }
}
