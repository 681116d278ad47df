r"""The hammer's force and what the structure does under it, both in closed form.

A pulse of peak F and duration T is a sum of exponentials while it lasts, f(t) = F Re sum c_k e^{s_k t} on 0 <= t <= T:

- half-sine: F sin(pi t / T); its spectrum falls as 1/f^2, first zero at 1.5/T;
- haversine: F (1 - cos(2 pi t / T)) / 2; smooth at both ends, falls as 1/f^3, first zero at 2/T.

So equation 20's convolution has a closed form, and no time stepping enters a record.
"""

from dataclasses import dataclass

import numpy as np

SHAPES = ("haversine", "half-sine")
# A free decay below this part of its start is left out: it is under the rounding of the sum it would enter.
FORGOTTEN = 1e-17


@dataclass(frozen=True)
class Pulse:
    """One contact of the hammer: `peak` [N], `duration` [s], `start` [s] in the record, `shape` one of SHAPES."""

    peak: float
    duration: float
    start: float
    shape: str = "haversine"

    def terms(self):
        """Pairs (c_k, s_k) with f(t) = sum c_k e^{s_k t}, t from the start of the contact."""
        if self.shape == "half-sine":
            s = 1.0j * np.pi / self.duration
            return [(self.peak / 2.0j, s), (-self.peak / 2.0j, -s)]
        s = 2.0j * np.pi / self.duration
        return [(self.peak / 2.0, 0.0j), (-self.peak / 4.0, s), (-self.peak / 4.0, -s)]

    def force(self, time):
        """The force in N at `time` [s] of the record."""
        t = time - self.start
        inside = (t >= 0.0) & (t <= self.duration)
        force = np.zeros_like(t)
        force[inside] = sum(c * np.exp(s * t[inside]) for c, s in self.terms()).real
        return force

    def spectrum(self, frequency):
        """The Fourier integral of the force, N s, at `frequency` [Hz], for e^{+j omega t}."""
        omega = 2.0 * np.pi * np.asarray(frequency, dtype=float)
        whole = sum(c * _integral(s - 1.0j * omega, self.duration) for c, s in self.terms())
        return whole * np.exp(-1.0j * omega * self.start)


def acceleration(modes, zeta, force_at, response_at, pulse, time):
    r"""The acceleration in m/s2 at `response_at` under `pulse` at `force_at`, exact at every instant of `time` (rising,
    even).

    With lambda = -zeta omega + j omega_d and C(t) the convolution of e^{lambda t} with the force, a mode gives
    $$ \ddot a = W_m(l_1) W_m(l_x) \{ f(t) + Im(\lambda^2 C(t)) / \omega_d \} . $$
    Rigid modes give W W f; the static remainder R gives R f'' (a five-point difference on `time`).
    """
    if np.any(zeta >= 1.0) or np.any(zeta < 0.0):
        raise ValueError("damping ratios must lie in [0, 1)")
    i, j = modes.index(force_at), modes.index(response_at)
    products = modes.shape[:, i] * modes.shape[:, j]
    force = pulse.force(time)
    direct = float(modes.rigid[:, i] @ modes.rigid[:, j]) + products.sum()
    total = direct * force + modes.remainder[i, j] * _second_derivative(force, time[1] - time[0])

    begin = np.searchsorted(time, pulse.start)
    contact = np.arange(begin, np.searchsorted(time, pulse.start + pulse.duration, side="right"))
    after = contact[-1] + 1 if len(contact) else begin
    for product, omega, ratio in zip(products, modes.omega, zeta):
        damped = omega * np.sqrt(1.0 - ratio**2)
        pole = -ratio * omega + 1.0j * damped
        scale = product / damped * pole**2
        total[contact] += (scale * _convolution(pulse, pole, time[contact] - pulse.start)).imag
        lasting = np.inf if ratio == 0.0 else -np.log(FORGOTTEN) / (ratio * omega)
        free = slice(after, np.searchsorted(time, pulse.start + pulse.duration + lasting))
        left = _convolution(pulse, pole, np.array([pulse.duration]))[0]
        total[free] += (scale * left * np.exp(pole * (time[free] - pulse.start - pulse.duration))).imag
    return total


def _convolution(pulse, pole, t):
    """Integral of e^{pole (t - tau)} f(tau) from 0 to t, for t inside the contact."""
    return np.exp(pole * t) * sum(c * _integral(s - pole, t) for c, s in pulse.terms())


def _integral(rate, t):
    """Integral of e^{rate tau} from 0 to t: expm1(rate t)/rate, and t where the rate vanishes."""
    rate, t = np.broadcast_arrays(np.asarray(rate, dtype=complex), np.asarray(t, dtype=float))
    small = np.abs(rate) * np.maximum(t, 1e-300) < 1e-12
    safe = np.where(small, 1.0, rate)
    return np.where(small, t, np.expm1(safe * t) / safe)


def _second_derivative(values, step):
    """Central five-point difference; its error in the band is (omega step)^4 / 90, about 1e-6 on the fine grid."""
    padded = np.pad(values, 2)
    weights = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * step**2)
    return np.convolve(padded, weights, mode="valid")
