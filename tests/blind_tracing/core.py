r"""Modes of a beam whose core's shear modulus depends on frequency, K(s) = K_bending + g(s) K_shear.

At each g the problem has modes of its own, complex, with phi' M phi = 1; they change smoothly along the path that
g(s) takes. They are found at a few g on that path and read off between them by the polynomial in g through these, so a line
costs no eigenproblem. A polynomial in g is analytic in s, as everything causal is: what an interpolation over |s| misses grows
with e^{sigma t} into the end of a record, one part in 1e7 of it to the size of the record.

$$ G_{ij}(s) = \sum_k \frac{\phi_k(i)\phi_k(j)}{s^2 + 2\zeta_k\omega_k s + \omega_k^2}
   + \sum_{p=0}^{4} (-s^2)^p R^{(p)}_{ij} ,  $$

all of phi, omega, R at g(s); R are the moments of the modes above CUT. zeta_k is what the panel has beside its core.
"""

from copy import copy

import numpy as np
from scipy.linalg import eig, eigh
from scipy.optimize import linear_sum_assignment

from . import beam

CUT = 15e3  # Hz at the least modulus: modes above count by their moments
BASIS = 30e3  # Hz: modes of the basis
KNOTS = 16  # along the path of g
MOMENTS = 5


def solve(panel, points, zeta, core, sampling):
    """Modes of a free panel along the path of its core's modulus, seen from `points` [m].

    The basis holds the modes at the least and at the greatest modulus, and how each answers a force at each point."""
    mesh = beam.Mesh(panel, beam.boundaries(panel, points))
    seen = np.array([mesh.deflection(x) for x in points])
    highest = sampling.lines()[0][-1]
    basis = [mesh.rigid()]
    for modulus in (1.0, abs(core(2.0j * np.pi * highest))):
        square, vectors = eigh(mesh.bending + modulus * mesh.shear, mesh.mass)
        kept = square < (2.0 * np.pi * BASIS) ** 2
        upper = vectors[:, ~kept]
        answer = (seen @ upper).T / square[~kept, None]
        basis += [vectors[:, kept][:, 2:], upper @ answer, upper @ (answer / square[~kept, None])]
    basis = orthonormal(np.hstack(basis), mesh.mass, rigid=2)
    stiffness, shear = (basis.T @ part @ basis for part in (mesh.bending + mesh.shear, mesh.shear))
    return CoreModes(stiffness, shear, (seen @ basis).T, 2, zeta, core, sampling.sigma, highest)


def orthonormal(basis, mass, rigid):
    """The span of the vectors with phi' M phi = 1, the first `rigid` kept as they are (they are orthonormal)."""
    first, rest = basis[:, :rigid], basis[:, rigid:]
    for _ in range(2):  # once more for what rounding left
        rest = rest - first @ (first.T @ mass @ rest)
        rest = rest / np.sqrt(np.sum(rest * (mass @ rest), axis=0))
        size, turn = eigh(rest.T @ mass @ rest)
        useful = size > 1e-10 * size[-1]
        rest = rest @ (turn[:, useful] / np.sqrt(size[useful]))
    return np.hstack([first, rest])


class CoreModes:
    """Modes along the path g(s) from the reduced matrices `stiffness` (at g = 1), `shear`, and the
    points' rows `shape`, in an M-orthonormal basis whose first `rigid` vectors are the rigid modes."""

    def __init__(self, stiffness, shear, shape, rigid, zeta, core, sigma, highest):
        self.core, self.rigid, self.points = core, rigid, shape.shape[1]
        self.rigid_shape = shape[:rigid]
        inner = slice(rigid, None)
        path = core(sigma + 2.0j * np.pi * np.linspace(0.0, highest, 4096))
        length = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(path)))])
        # A modulus that does not move has one knot.
        knots = KNOTS if length[-1] > 0.0 else 1
        place = length[-1] * 0.5 * (1.0 - np.cos(np.pi * (np.arange(knots) + 0.5) / knots))
        self.knots = np.interp(place, length, path.real) + 1.0j * np.interp(place, length, path.imag)
        apart = (self.knots[:, None] - self.knots) / max(length[-1], np.finfo(float).tiny)
        self.weights = 1.0 / np.prod(apart + np.eye(knots), axis=1)
        flexible = stiffness[inner, inner], shear[inner, inner], shape[inner]
        self.count = self.before = None
        self.table = np.array([self._at(modulus, *flexible) for modulus in self.knots])
        self.zeta = np.zeros(self.count)
        self.zeta[: min(self.count, len(zeta))] = zeta[: self.count]

    def _at(self, modulus, stiffness, shear, shape):
        """omega^2 and shapes of the modes below CUT, and the moments of the others, in one row."""
        square, vectors = eig(stiffness + (modulus - 1.0) * shear)
        order = np.argsort(square.real)
        square, vectors = square[order], vectors[:, order]
        vectors = vectors / np.sqrt(np.sum(vectors**2, axis=0))
        if self.count is None:
            self.count = int(np.sum(square.real < (2.0 * np.pi * CUT) ** 2))
        else:
            # Even and odd modes may cross along the path: each is the one most like what it was a knot before.
            alike = self.before.T @ vectors
            order = linear_sum_assignment(-np.abs(alike))[1]
            square, vectors = square[order], vectors[:, order]
            # The sign of a vector is free: keep that of the path's first.
            vectors = vectors * np.where(alike[np.arange(len(order)), order].real < 0.0, -1.0, 1.0)
        self.before = vectors
        seen = vectors.T @ shape
        upper, far = seen[self.count :], square[self.count :, None]
        moments = [upper.T @ (upper / far**power) for power in range(1, MOMENTS + 1)]
        return np.concatenate([square[: self.count], seen[: self.count].ravel(), *(m.ravel() for m in moments)])

    def __len__(self):
        return self.rigid + self.count

    def of_its_own(self, shares, factors):
        """As `Modes.of_its_own`, but nothing in quadrature; the modes above CUT count by their moments and stay as they are."""
        flexible = slice(self.rigid, self.rigid + self.count)
        other, end = copy(self), self.count * (1 + self.points)
        other.table = self.table.copy()
        other.table[:, : self.count] *= (1.0 + shares[flexible]) ** 2
        other.table[:, self.count : end] *= factors[flexible].real.ravel()
        return other

    def _between(self, modulus):
        """The table's row at each `modulus`, by the barycentric formula."""
        apart = modulus[:, None] - self.knots
        at_knot = apart == 0.0
        share = np.where(at_knot.any(axis=1)[:, None], at_knot, self.weights / np.where(at_knot, 1.0, apart))
        return (share @ self.table) / np.sum(share, axis=1)[:, None]

    def receptance(self, s, rows, columns):
        """G [m/N] (lines, rows, columns) at `s` [1/s] on the contour."""
        row = self._between(self.core(s))
        square, rest = row[:, : self.count], row[:, self.count :]
        seen = rest[:, : self.count * self.points].reshape(len(s), self.count, self.points)
        moments = rest[:, self.count * self.points :].reshape(len(s), MOMENTS, self.points, self.points)
        weight = 1.0 / (s[:, None] ** 2 + 2.0 * self.zeta * np.sqrt(square) * s[:, None] + square)
        pick = np.ix_(rows, columns)
        whole = np.einsum("lkr,lkc->lrc", seen[:, :, rows] * weight[:, :, None], seen[:, :, columns], optimize=True)
        for power in range(MOMENTS):
            whole += (-(s**2)[:, None, None]) ** power * moments[:, power][:, pick[0], pick[1]]
        flat = self.rigid_shape
        return whole + (flat[:, rows].T @ flat[:, columns]) / (s**2)[:, None, None]
