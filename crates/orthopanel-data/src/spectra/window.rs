//! Windows over the records of a hit.

/// What the records are multiplied by before the transform.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Window {
    /// Nothing: right where the response has decayed at the record's end.
    #[default]
    None,
    /// Hann's window over both channels, $\tfrac12(1 - \cos 2\pi n/N)$, as in the paper.
    Hann,
    /// The force kept within `half_width` \[s\] of its peak and zero elsewhere; both channels times $e^{-t/\tau}$.
    ///
    /// Since both channels carry the same exponential, the quotient is the accelerance at $s = 1/\tau + j\omega$
    /// exactly, for any linear piece: each mode's decay rate $\zeta\omega$ seems raised by $1/\tau$, and nothing leaks.
    ForceExponential {
        /// Half the width of the force window \[s\].
        half_width: f64,
        /// Time constant $\tau$ \[s\].
        tau: f64,
    },
}

impl Window {
    /// The decay rate $\sigma = 1/\tau$ \[1/s\] that the window adds; zero without an exponential.
    pub fn decay_rate(self) -> f64 {
        match self {
            Self::None | Self::Hann => 0.0,
            Self::ForceExponential { tau, .. } => 1.0 / tau,
        }
    }

    /// True where the window's numbers are finite and greater than zero.
    pub(super) fn is_valid(self) -> bool {
        match self {
            Self::None | Self::Hann => true,
            Self::ForceExponential { half_width, tau } => {
                [half_width, tau, 1.0 / tau].iter().all(|value| value.is_finite() && *value > 0.0)
            }
        }
    }

    /// Windows the two channels of a hit whose offsets are removed; `peak` is the sample of the greatest force.
    pub(super) fn apply(self, force: &mut [f64], acceleration: &mut [f64], peak: usize, rate: f64) {
        match self {
            Self::None => {}
            Self::Hann => {
                for channel in [force, acceleration] {
                    let length = channel.len() as f64;
                    for (n, value) in channel.iter_mut().enumerate() {
                        *value *= 0.5 - 0.5 * (std::f64::consts::TAU * n as f64 / length).cos();
                    }
                }
            }
            Self::ForceExponential { half_width, tau } => {
                for (n, value) in force.iter_mut().enumerate() {
                    if n.abs_diff(peak) as f64 > half_width * rate {
                        *value = 0.0;
                    }
                }
                for channel in [force, acceleration] {
                    for (n, value) in channel.iter_mut().enumerate() {
                        *value *= (-(n as f64) / (rate * tau)).exp();
                    }
                }
            }
        }
    }
}
