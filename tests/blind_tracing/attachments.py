r"""What is fixed to the panel at a point: its dynamic stiffness Z(s), force over displacement, N/m.

With attachments at points a, the panel's receptance G becomes

$$ \tilde G_{rf} = G_{rf} - G_{ra} Z (I + G_{aa} Z)^{-1} G_{af} . $$

`matrices` are mass, damping and stiffness over the panel's deflection at the point and, in a resonator, its own one.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Mass:
    """A point mass [kg] (negative where one is missing): Z = m s^2."""

    kilograms: float

    def __call__(self, s):
        return self.kilograms * s**2

    def matrices(self):
        """Of one deflection."""
        return np.array([[[self.kilograms]], [[0.0]], [[0.0]]])


@dataclass(frozen=True)
class Spring:
    """A spring [N/m] and dashpot [N s/m] to ground: Z = k + c s."""

    stiffness: float
    damping: float = 0.0

    def __call__(self, s):
        return self.stiffness + self.damping * s

    def matrices(self):
        """Of one deflection."""
        return np.array([[[0.0]], [[self.damping]], [[self.stiffness]]])


@dataclass(frozen=True)
class Resonator:
    """A mass on a spring and dashpot of its own, `frequency` [Hz] with the panel held still."""

    kilograms: float
    frequency: float
    zeta: float

    def __call__(self, s):
        omega = 2.0 * np.pi * self.frequency
        holder = 2.0 * self.zeta * omega * s + omega**2
        return self.kilograms * s**2 * holder / (s**2 + holder)

    def matrices(self):
        """Of two deflections."""
        omega = 2.0 * np.pi * self.frequency
        own, between = np.array([[0.0, 0.0], [0.0, 1.0]]), np.array([[1.0, -1.0], [-1.0, 1.0]])
        return self.kilograms * np.stack([own, 2.0 * self.zeta * omega * between, omega**2 * between])


mass, spring, resonator = Mass, Spring, Resonator


def coupled(receptance, s, rows, columns, at, stiffnesses):
    """Receptance (lines, rows, columns) of the panel with the attachments on.

    `receptance(rows, columns)` is the bare panel's, `at` the attachments' point indices, `stiffnesses` their Z.
    """
    if not at:
        return receptance(rows, columns)
    whole = receptance([*rows, *at], [*columns, *at])
    r, c = len(rows), len(columns)
    z = np.stack([stiffness(s) for stiffness in stiffnesses], axis=1)
    inner = np.eye(len(at)) + whole[:, r:, c:] * z[:, None, :]
    return whole[:, :r, :c] - (whole[:, :r, c:] * z[:, None, :]) @ np.linalg.solve(inner, whole[:, r:, :c])
