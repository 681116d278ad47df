r"""What is fixed to the panel at a point: its dynamic stiffness Z(s), force over displacement, N/m.

With attachments at points a, the panel's receptance G becomes

$$ \tilde G_{rf} = G_{rf} - G_{ra} Z (I + G_{aa} Z)^{-1} G_{af} . $$
"""

import numpy as np


def mass(kilograms):
    """A point mass (negative where one is missing): Z = m s^2."""
    return lambda s: kilograms * s**2


def spring(stiffness, damping=0.0):
    """A spring [N/m] and dashpot [N s/m] to ground: Z = k + c s."""
    return lambda s: stiffness + damping * s


def resonator(kilograms, frequency, zeta):
    """A mass on a spring and dashpot of its own, `frequency` [Hz] with the panel held still."""
    omega = 2.0 * np.pi * frequency

    def stiffness(s):
        holder = 2.0 * zeta * omega * s + omega**2
        return kilograms * s**2 * holder / (s**2 + holder)

    return stiffness


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
