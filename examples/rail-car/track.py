"""Track irregularity as a sum of lines with seeded phases, periodic in time.

ERRI B176 gives one-sided spectra of the vertical level, in m2/(rad/m), and of the cant angle, in rad2/(rad/m), over the
wavenumber Omega [rad/m]:

    S_v = A O_c^2 / ((Omega^2 + O_r^2) (Omega^2 + O_c^2))
    S_c = S_v / b^2 * Omega^2 / (Omega^2 + O_s^2)

A is that of a track of low disturbance. The fit is meant for wavelengths above 3 m; here it runs on down to 1 m.
"""

from dataclasses import dataclass

import numpy as np

LEVEL = 4.032e-7  # A [m2 rad/m]
CUT_LONG, CUT_SHORT, CUT_CANT = 0.0206, 0.8246, 0.4380  # O_r, O_c, O_s [rad/m]
HALF_GAUGE = 0.75  # b, half the distance of the rolling circles [m]


@dataclass(frozen=True)
class Track:
    """The irregularity as a car meets it: lines from 1/period to `up_to` [Hz] in steps of 1/period."""

    speed: float = 55.0  # m/s
    period: float = 8.0  # s, after which the track repeats
    up_to: float = 50.0  # Hz
    seed: int = 1997

    @property
    def omegas(self):
        """Angular frequencies of the lines [rad/s]."""
        return 2.0 * np.pi * np.arange(1, round(self.up_to * self.period) + 1) / self.period

    def amplitudes(self):
        """Complex amplitudes of level [m] and cant [rad] at s = 0; the height is Re(sum amplitude exp(j omega t))."""
        wavenumber = self.omegas / self.speed
        level = LEVEL * CUT_SHORT**2 / ((wavenumber**2 + CUT_LONG**2) * (wavenumber**2 + CUT_SHORT**2))
        cant = level / HALF_GAUGE**2 * wavenumber**2 / (wavenumber**2 + CUT_CANT**2)
        width = 2.0 * np.pi / self.period / self.speed
        phases = np.random.default_rng(self.seed).uniform(0.0, 2.0 * np.pi, (2, len(wavenumber)))
        return np.sqrt(2.0 * width * np.array([level, cant])) * np.exp(1j * phases)

    def under(self, x):
        """Level and cant at the place x [m] ahead of the car's centre, as complex amplitudes."""
        return self.amplitudes() * np.exp(1j * self.omegas * x / self.speed)
