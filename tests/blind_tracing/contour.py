r"""From transfer functions to samples: the inverse Laplace transform on one line s = sigma + j omega, by an FFT.

$$ x(t) = e^{\sigma t} \frac{1}{2\pi} \int X(\sigma + j\omega) e^{j\omega t} d\omega $$

Every linear effect is a factor of X, however it depends on frequency, so no time step and no modal sum enters a
record. The period is the record itself; what wraps round is damped by e^{-sigma T} = 1e-7, and rounding grows by the
inverse. Both channels pass the analyser's anti-alias filter, erfc((f - 0.435 r)/(0.0156 r))/2 at the sampling rate r:
flat within 1e-4 up to r/2.56, the bandwidth that analysers state, and 1e-9 at r/2. Its delay is taken out.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import erfc

WRAP = 16.0  # sigma T


@dataclass(frozen=True)
class Sampling:
    """Rate [Hz] and number of samples of a record."""

    rate: float = 20480.0
    samples: int = 32768

    @property
    def duration(self):
        """Of the record, s."""
        return self.samples / self.rate

    @property
    def sigma(self):
        """The contour's distance from the axis, 1/s."""
        return WRAP / self.duration

    @property
    def time(self):
        """The instants of the samples, s."""
        return np.arange(self.samples) / self.rate

    def finer(self, times):
        """The same record at a multiple of the rate."""
        return Sampling(self.rate * times, self.samples * times)

    def low_pass(self, frequency):
        """The anti-alias filter's gain at `frequency` [Hz]."""
        return 0.5 * erfc((np.asarray(frequency) - 0.435 * self.rate) / (0.0156 * self.rate))

    def lines(self):
        """Frequencies [Hz] at which the filter passes anything, and s on the contour there."""
        frequency = np.arange(self.samples // 2 + 1) / self.duration
        frequency = frequency[self.low_pass(frequency) > 1e-13]
        return frequency, self.sigma + 2.0j * np.pi * frequency

    def samples_of(self, transform, frequency, filtered=True):
        """The record (..., samples) of Laplace transforms (..., lines) on the contour."""
        passed = transform * self.low_pass(frequency) if filtered else transform
        damped = np.fft.irfft(passed, n=self.samples, axis=-1) * self.rate
        return damped * np.exp(self.sigma * self.time)

    def transform_of(self, signal, lines):
        """The Laplace transform (..., lines) of samples (..., samples) whose content lies below half the rate."""
        return np.fft.rfft(signal * np.exp(-self.sigma * self.time), axis=-1)[..., :lines] / self.rate


def half_sine(s, peak, duration, start):
    """The transform [N s] of a half-sine contact: `peak` [N], `duration` and `start` [s]."""
    turn = np.pi / duration
    return peak * turn * (1.0 + np.exp(-s * duration)) / (s**2 + turn**2) * np.exp(-s * start)
