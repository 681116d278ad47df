//! The exact step of one mode over a time $h$, free of cancellation at any $\omega h$.

/// Steps with $\omega h$ up to here use the power series, longer ones the closed form.
///
/// Below, the closed form of $G_2$ would subtract nearly equal numbers; above, the series would.
const SERIES_UP_TO: f64 = 1.0;

/// Terms of the series: at $\omega h = 1$ the first one left out is below $1/23! \approx 4\cdot10^{-23}$.
const SERIES_TERMS: u32 = 24;

/// How one mode moves over a step $h$.
///
/// With the impulse response $g(t) = e^{-\zeta\omega t}\sin(\omega_d t)/\omega_d$ and its integrals
/// $G_1 = \int_0^h g$, $G_2 = \int_0^h G_1$, a modal force that runs from $p_0$ to $p_0 + \Delta p$ gives
/// $$a_1 = a + g\,v + G_1 (p_0 - \omega^2 a) + \frac{G_2}{h}\Delta p,$$
/// $$v_1 = v + g\,(p_0 - \omega^2 a - 2\zeta\omega v) - \omega^2 G_1 v + \frac{G_1}{h}\Delta p.$$
/// Written as increments, a short step loses nothing: the error of a coefficient is multiplied by the increment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coefficients {
    /// $g(h)$ \[s\].
    pub impulse: f64,
    /// $G_1(h)$ \[s²\].
    pub held: f64,
    /// $G_2(h)/h$ \[s²\].
    pub ramp: f64,
    /// $G_1(h)/h$ \[s\].
    pub ramp_rate: f64,
}

impl Coefficients {
    /// Coefficients of a mode with $\omega \ge 0$ \[rad/s\] and $0 \le \zeta < 1$ for a step $h > 0$ \[s\].
    pub(super) fn new(omega: f64, zeta: f64, step: f64) -> Self {
        if omega * step <= SERIES_UP_TO { Self::series(omega, zeta, step) } else { Self::closed(omega, zeta, step) }
    }

    pub(super) fn is_finite(&self) -> bool {
        [self.impulse, self.held, self.ramp, self.ramp_rate].iter().all(|value| value.is_finite())
    }

    /// Power series of $g$ in $z = \omega h$, from its differential equation; exact for a rigid mode ($z = 0$).
    fn series(omega: f64, zeta: f64, step: f64) -> Self {
        let z = omega * step;
        let (mut before, mut term) = (0.0, 1.0);
        let (mut impulse, mut held, mut ramp) = (0.0, 0.0, 0.0);
        for n in 1..=SERIES_TERMS {
            let n = f64::from(n);
            impulse += term;
            held += term / (n + 1.0);
            ramp += term / ((n + 1.0) * (n + 2.0));
            let next = -(2.0 * zeta * z * n * term + z * z * before) / (n * (n + 1.0));
            (before, term) = (term, next);
        }
        Self { impulse: step * impulse, held: step * step * held, ramp: step * step * ramp, ramp_rate: step * held }
    }

    fn closed(omega: f64, zeta: f64, step: f64) -> Self {
        let z = omega * step;
        let (sine, cosine, ratio) = damped_phase(omega, zeta, step);
        let decay = (-zeta * z).exp();
        let s = decay * sine / ratio;
        let c = decay * cosine;
        let held = 1.0 - c - zeta * s;
        let ramp = z - s - 2.0 * zeta * held;
        let (omega_squared, per_omega) = (omega * omega, 1.0 / omega);
        Self {
            impulse: s * per_omega,
            held: held / omega_squared,
            ramp: ramp / (omega_squared * z),
            ramp_rate: held * per_omega / z,
        }
    }
}

/// $\sin\omega_d h$, $\cos\omega_d h$ and $\omega_d/\omega = \sqrt{1-\zeta^2}$.
///
/// The product $\omega_d h$ is carried with its rounding error: otherwise a step of many periods would be off in
/// phase by $\omega h$ units in the last place, and the same error would return at every step.
fn damped_phase(omega: f64, zeta: f64, step: f64) -> (f64, f64, f64) {
    let square = zeta * zeta;
    let square_low = zeta.mul_add(zeta, -square);
    let rest = 1.0 - square;
    let rest_low = (1.0 - rest - square) - square_low;
    let ratio = rest.sqrt();
    let ratio_low = ((-ratio).mul_add(ratio, rest) + rest_low) / (2.0 * ratio);

    let damped = omega * ratio;
    let damped_low = omega.mul_add(ratio, -damped) + omega * ratio_low;
    let phase = damped * step;
    let phase_low = damped.mul_add(step, -phase) + damped_low * step;

    let (sine, cosine) = phase.sin_cos();
    (sine + phase_low * cosine, cosine - phase_low * sine, ratio)
}
