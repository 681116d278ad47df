"""Modes of a free-free Timoshenko beam, from its differential equations, by bisection.

Written from equations (5) to (7) and (15) of the paper, for even and odd shapes apart, below the cut-off (9):

    w = C cos(alpha x) + D cosh(beta x)     or     w = C sin(alpha x) + D sinh(beta x)
"""

from dataclasses import dataclass

import numpy as np

SHEAR_COEFFICIENT = 2.0 / 3.0


@dataclass(frozen=True)
class Beam:
    """SI units; mass_per_area is rho t."""

    length: float
    width: float
    thickness: float
    mass_per_area: float
    e_x: float
    g_zx: float

    @property
    def line_mass(self):
        return self.mass_per_area * self.width

    @property
    def line_inertia(self):
        return self.line_mass * self.thickness**2 / 12.0

    @property
    def bending(self):
        return self.e_x * self.width * self.thickness**3 / 12.0

    @property
    def shear(self):
        return SHEAR_COEFFICIENT * self.g_zx * self.width * self.thickness

    def wave_numbers(self, omega):
        """alpha and beta of the harmonic and the exponential part."""
        ratio = self.line_inertia / self.bending + self.line_mass / self.shear
        difference = self.line_inertia / self.bending - self.line_mass / self.shear
        root = np.sqrt((difference * omega**2) ** 2 + 4.0 * self.line_mass / self.bending * omega**2)
        alpha = np.sqrt((ratio * omega**2 + root) / 2.0)
        # The product of the squares is known, so beta needs no difference of nearly equal numbers.
        cut_off = 1.0 - self.line_inertia * omega**2 / self.shear
        beta = np.sqrt(self.line_mass / self.bending * cut_off) * omega / alpha
        return alpha, beta

    def mismatch(self, omega, even):
        """Zero where moment and shear force can both vanish at the ends."""
        alpha, beta = self.wave_numbers(omega)
        s = self.line_mass * omega**2 / self.shear
        half = self.length / 2.0
        tanh, sine, cosine = np.tanh(beta * half), np.sin(alpha * half), np.cos(alpha * half)
        if even:
            return (alpha**2 - s) * cosine * tanh / beta + (beta**2 + s) * sine / alpha
        return (alpha**2 - s) * sine / beta - (beta**2 + s) * tanh * cosine / alpha

    def flexible_modes(self, count):
        """The first modes as (omega, shape), shape a function of x with unit modal mass."""
        limit = np.sqrt(self.shear / self.line_inertia)
        found = []
        grid = np.linspace(1e-4, 0.999, 20_000) * limit
        for even in (True, False):
            values = self.mismatch(grid, even)
            for i in np.flatnonzero(np.sign(values[:-1]) != np.sign(values[1:])):
                omega = bisect(lambda w: self.mismatch(w, even), grid[i], grid[i + 1])
                found.append((omega, self.shape(omega, even)))
        assert len(found) >= count, "modes above the cut-off are not covered here"
        return sorted(found, key=lambda mode: mode[0])[:count]

    def shape(self, omega, even):
        alpha, beta = self.wave_numbers(omega)
        s = self.line_mass * omega**2 / self.shear
        half = self.length / 2.0
        # No shear force at the end gives the ratio of both parts; the exponential part is scaled by its end value.
        if even:
            share = -(beta / alpha) * np.sin(alpha * half) / np.tanh(beta * half)
            w = lambda x: np.cos(alpha * x) + share * np.cosh(beta * x) / np.cosh(beta * half)
            psi = lambda x: (alpha - s / alpha) * np.sin(alpha * x) - share * (beta + s / beta) * np.sinh(
                beta * x
            ) / np.cosh(beta * half)
        else:
            share = (beta / alpha) * np.cos(alpha * half)
            w = lambda x: np.sin(alpha * x) + share * np.sinh(beta * x) / np.cosh(beta * half)
            psi = lambda x: -(alpha - s / alpha) * np.cos(alpha * x) - share * (beta + s / beta) * np.cosh(
                beta * x
            ) / np.cosh(beta * half)
        nodes, weights = np.polynomial.legendre.leggauss(200)
        x = half * nodes
        density = self.line_mass * w(x) ** 2 + self.line_inertia * psi(x) ** 2
        norm = np.sqrt(half * np.sum(weights * density))
        return lambda x: w(x) / norm

    def rigid_modes(self):
        """Translation and rotation, with omega = 0 and unit modal mass."""
        mass = self.line_mass * self.length
        inertia = self.line_mass * self.length**3 / 12.0 + self.line_inertia * self.length
        return [(0.0, lambda x: 1.0 / np.sqrt(mass)), (0.0, lambda x: x / np.sqrt(inertia))]


def bisect(function, low, high):
    """A root to the last bit."""
    sign = np.sign(function(low))
    while True:
        middle = (low + high) / 2.0
        if middle in (low, high):
            return middle
        if np.sign(function(middle)) == sign:
            low = middle
        else:
            high = middle
