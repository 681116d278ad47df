r"""What vibrates, seen from a few points: frequencies, damping ratios and shape values.

A structure's full solution has hundreds of modes. Those below CUT stay as they are. What the others do at the points
is carried by a few pseudo-modes: the response of the upper modes to a force at each point, to first order in omega^2,
made a small eigenproblem of its own. Together they err by order (f / CUT)^8 of the upper modes' part, so one sum
serves

$$ G_{ij}(s) = \sum_k \frac{\phi_k(i)\,\phi_k(j)}{s^2 + 2\zeta_k\omega_k s + \omega_k^2} $$

with s = sigma + j omega anywhere right of the poles. SI units, shapes mass-normalised (kg^-1/2).
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import eigh

CUT = 24e3  # Hz: three times the band of the records
BEYOND = 0.005  # damping ratio of modes that no test case names


@dataclass(frozen=True)
class Modes:
    """`omega` [rad/s] (n), `zeta` (n), `shape` (n, points); `rigid` counts the modes that start the
    list at zero. `turn` (n, points) is what a force at a point does in quadrature: it meets the mode as shape + s turn."""

    omega: np.ndarray
    zeta: np.ndarray
    shape: np.ndarray
    rigid: int
    turn: np.ndarray | None = None

    def __len__(self):
        return len(self.omega)

    @property
    def points(self):
        """How many points the modes are seen from."""
        return self.shape.shape[1]

    def receptance(self, s, rows, columns):
        """G [m/N] (lines, rows, columns) at complex `s` [1/s] between points given by their index."""
        weight = 1.0 / (s[:, None] ** 2 + 2.0 * (self.zeta * self.omega) * s[:, None] + self.omega**2)
        pairs = self.shape[:, rows][:, :, None] * self.shape[:, columns][:, None, :]
        flat = pairs.reshape(len(self.omega), -1)
        whole = weight @ flat
        if self.turn is not None:
            turned = self.shape[:, rows][:, :, None] * self.turn[:, columns][:, None, :]
            whole += s[:, None] * (weight @ turned.reshape(len(self.omega), -1))
        return whole.reshape(len(s), len(rows), len(columns))

    def stiffer(self, factor):
        """All stiffness times `factor`: frequencies by its root, shapes as they are."""
        return replace(self, omega=self.omega * np.sqrt(factor))

    def of_its_own(self, shares, factors):
        """Each mode's frequency off by its share (modes) of itself, what a force at each point does to it by a complex factor
        (modes, points)."""
        turn = self.shape * factors.imag / np.maximum(self.omega, np.finfo(float).tiny)[:, None]
        return replace(self, omega=self.omega * (1.0 + shares), shape=self.shape * factors.real, turn=turn)


def reduced(square, vectors, seen, rigid_shape, zeta):
    """Modes from a full eigensolution.

    `square` [1/s2] rising and `vectors` (unknowns, n) mass-normalised, `seen` (points, unknowns) reads the points off
    a vector, `rigid_shape` (rigid, points) is what the first modes are in closed form, `zeta` the damping ratios of the
    flexible modes in order.
    """
    rigid = len(rigid_shape)
    square = np.concatenate([np.zeros(rigid), square[rigid:]])
    shape = (seen @ vectors).T
    shape[:rigid] = rigid_shape
    kept = square <= (2.0 * np.pi * CUT) ** 2
    mix = _static_part(square[~kept], shape[~kept])
    upper, turn = eigh(mix.T @ (square[~kept, None] * mix))
    mix = mix @ turn
    omega = np.sqrt(np.concatenate([square[kept], upper]))
    damping = np.full(len(omega), BEYOND)
    damping[:rigid] = 0.0
    count = min(len(zeta), int(kept.sum()) - rigid)
    damping[rigid : rigid + count] = zeta[:count]
    return Modes(omega, damping, np.vstack([shape[kept], mix.T @ shape[~kept]]), rigid)


def _static_part(square, shape):
    """An orthonormal basis, in coordinates of the upper modes, of their responses to a force at each point: the static
    one and the next term in omega^2."""
    responses = np.hstack([shape / square[:, None], shape / square[:, None] ** 2])
    responses = responses / np.linalg.norm(responses, axis=0)
    left, size, _ = np.linalg.svd(responses, full_matrices=False)
    return left[:, size > 1e-9 * size[0]]
