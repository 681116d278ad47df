//! Windows over the records of a hit.

use super::{blow::Blow, blow_window::BlowWindow, hit::Hit};

/// What the records are multiplied by before the transform.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Window {
    /// Nothing: right where the response has decayed at the record's end.
    #[default]
    None,
    /// [`Window::None`] where the responses of a place have died away at the record's end and the force's noise counts for
    /// nothing. Where it counts, the force is kept near its blow, as in [`Window::Force`]: over the whole record noise of a
    /// thousandth of the peak makes a hundredth of $S_{ff}$. Where a response rings on, an exponential as in
    /// [`Window::ForceExponential`], with the time constant that takes what is left down to 1e-6 of the greatest.
    AsNeeded,
    /// Hann's window over both channels, $\tfrac12(1 - \cos 2\pi n/N)$, as in the paper.
    Hann,
    /// The force kept within `half_width` \[s\] of its peak and zero elsewhere; the response as it is.
    ///
    /// What is left of the force's noise is tied together over $1/(2\,\text{half\_width})$ of frequency:
    /// [`Accelerance::force_noise`](crate::Accelerance::force_noise).
    Force {
        /// Half the width of the force window \[s\].
        half_width: f64,
    },
    /// The force kept within `half_width` \[s\] of its peak and zero elsewhere; both channels times $e^{-t/\tau}$ from
    /// $\tau/2$ before the blow on, and zero before that, where there is nothing but noise.
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

/// What the exponential leaves of a response at the record's end, over its greatest. The slow low modes that ring longest
/// are a hundredth of what a hammer raises in all, and their leak should still be below noise.
const LEFT: f64 = 1e-6;

/// Hann's window at the blow, over its greatest, below which it leaves next to nothing of the hit: at 7 % of the record's length.
const CUT_OFF: f64 = 0.05;

/// Time constants before the blow at which the exponential begins: so far ahead a filter has not begun to ring, and noise counts for
/// little more than at the blow.
const BEGINS_AHEAD: f64 = 0.5;

impl Window {
    /// Half the width of the force window unless said \[s\]: ten times a usual blow.
    pub const USUAL_HALF_WIDTH: f64 = 0.004;

    /// The window over a place's hits, of which `left` is the greatest rms at the record's end over the greatest of the
    /// record, `None` where all have died away.
    pub(super) fn resolved(self, left: Option<f64>, hits: &[&Hit], rate: f64) -> Self {
        if self != Self::AsNeeded {
            return self;
        }
        let blow = BlowWindow::of(hits);
        let samples = hits.first().map_or(0, |hit| hit.force.len());
        let half_width = blow.needed().map(|half| half as f64 / rate);
        match left {
            None => half_width.map_or(Self::None, |half_width| Self::Force { half_width }),
            Some(left) => {
                // After the last blow of all hits the responses fall.
                let after = samples.saturating_sub(blow.last) as f64 / rate;
                Self::ForceExponential {
                    half_width: half_width.unwrap_or(samples as f64 / rate),
                    tau: after / (left / LEFT).max(std::f64::consts::E).ln(),
                }
            }
        }
    }

    /// Half the width of the force window \[s\], where there is one.
    pub(super) fn force_half_width(self) -> Option<f64> {
        match self {
            Self::None | Self::AsNeeded | Self::Hann => None,
            Self::Force { half_width } | Self::ForceExponential { half_width, .. } => Some(half_width),
        }
    }

    /// What there is to say of it, beside hits that have not all died away.
    pub(super) fn notes(self, ringing: bool) -> Vec<String> {
        let of_ringing = match self {
            Self::ForceExponential { tau, .. } => {
                format!("exponential window, tau = {tau:.3} s: the damping that it adds is known and taken out")
            }
            _ => "what has not decayed leaks: record longer, or use the force and exponential window".into(),
        };
        let of_hann = "Hann's window shapes the decay: damping comes out too low for a blow before the record's middle, \
                       too high after it; none or force and exponential keep it";
        let of_force = match self {
            Self::Force { half_width } => Some(format!(
                "the force is kept within {} of its peak, for the noise of the rest counts",
                milliseconds(half_width)
            )),
            _ => None,
        };
        let of_force = of_force.into_iter();
        of_force
            .chain(ringing.then_some(of_ringing).into_iter().chain((self == Self::Hann).then(|| of_hann.into())))
            .collect()
    }

    /// The decay rate $\sigma = 1/\tau$ \[1/s\] that the window adds; zero without an exponential.
    pub fn decay_rate(self) -> f64 {
        match self {
            Self::None | Self::AsNeeded | Self::Hann | Self::Force { .. } => 0.0,
            Self::ForceExponential { tau, .. } => 1.0 / tau,
        }
    }

    /// By how much the window may have moved the decay rate of a resonance under a hit \[1/s\], where that is not known.
    ///
    /// Over a response that dies away soon Hann's window acts by its slope, $-w'/w = -\frac{2\pi}{T}\cot(\pi t_0/T)$ at the
    /// blow's $t_0$; one that does not is smeared over the window's own width, $2\pi/T$. Where the window all but cuts off the blow
    /// nothing is known of any decay: what is seen is the window's.
    pub(super) fn decay_rate_in_doubt(self, hit: &Hit, rate: f64) -> f64 {
        if self != Self::Hann {
            return 0.0;
        }
        let length = hit.force.len() as f64;
        let phase = std::f64::consts::PI * hit.blow().at as f64 / length;
        if phase.sin().powi(2) < CUT_OFF {
            return f64::INFINITY;
        }
        std::f64::consts::TAU * rate / length * phase.tan().recip().abs().max(1.0)
    }

    /// A sentence where the window all but cuts off the blow of a hit.
    pub(super) fn cut_off(self, hits: &[&Hit], rate: f64) -> Option<String> {
        let hit = hits.iter().find(|hit| self.decay_rate_in_doubt(hit, rate).is_infinite())?;
        let part = (std::f64::consts::PI * hit.blow().at as f64 / hit.force.len() as f64).sin().powi(2);
        Some(format!(
            "Hann's window is {:.2} % of its greatest where the blow is: noise drowns the hit, and damping is not told; take none or \
             force and exponential",
            100.0 * part
        ))
    }

    /// True where the window's numbers are finite and greater than zero.
    pub(super) fn is_valid(self) -> bool {
        match self {
            Self::None | Self::AsNeeded | Self::Hann => true,
            Self::Force { half_width } => half_width.is_finite() && half_width > 0.0,
            Self::ForceExponential { half_width, tau } => {
                [half_width, tau, 1.0 / tau].iter().all(|value| value.is_finite() && *value > 0.0)
            }
        }
    }

    /// Windows the two channels of a hit whose offsets are removed.
    pub(super) fn apply(self, force: &mut [f64], acceleration: &mut [f64], blow: &Blow, rate: f64) {
        match self {
            Self::None | Self::AsNeeded => {}
            Self::Hann => {
                for channel in [force, acceleration] {
                    let length = channel.len() as f64;
                    for (n, value) in channel.iter_mut().enumerate() {
                        *value *= 0.5 - 0.5 * (std::f64::consts::TAU * n as f64 / length).cos();
                    }
                }
            }
            Self::Force { half_width } => keep_near(force, blow.at, half_width * rate),
            Self::ForceExponential { half_width, tau } => {
                keep_near(force, blow.at, half_width * rate);
                let begins = blow
                    .quiet
                    .map_or(0, |quiet| quiet.min(blow.at.saturating_sub((BEGINS_AHEAD * tau * rate) as usize)));
                for channel in [force, acceleration] {
                    let (before, after) = channel.split_at_mut(begins.min(channel.len()));
                    before.fill(0.0);
                    for (n, value) in after.iter_mut().enumerate() {
                        *value *= (-(n as f64) / (rate * tau)).exp();
                    }
                }
            }
        }
    }
}

/// A time \[s\] in ms, to two significant digits at least.
pub(super) fn milliseconds(time: f64) -> String {
    let value = 1e3 * time;
    let digits = (1.0 - value.abs().log10().floor()).clamp(0.0, 12.0);
    format!("{value:.0$} ms", if digits.is_finite() { digits as usize } else { 0 })
}

/// Zeroes what is further than `reach` samples from the peak.
fn keep_near(force: &mut [f64], peak: usize, reach: f64) {
    for (n, value) in force.iter_mut().enumerate() {
        if n.abs_diff(peak) as f64 > reach {
            *value = 0.0;
        }
    }
}
