r"""The orthotropic Mindlin plate: the panel that a beam cannot follow across its width.

Strain energy with D_11 = E_x t^3/12/(1 - nu_xy nu_yx), D_22, D_12 = nu_xy E_y t^3/12/(1 - nu_xy nu_yx),
D_66 = G_xy t^3/12, A_55 = k' G_zx t, A_44 = k' G_yz t, k' = 2/3, nu_yx = nu_xy E_y / E_x; kinetic energy
rho t w^2 + rho t^3/12 (psi_x^2 + psi_y^2); all edges free. Along x the beam's elements, across y Legendre polynomials.
Hammer and sensor stand on the centre line y = 0, so only motion even in y is needed: w and psi_x even, psi_y odd.
SI units.

A point force on a Mindlin plate sinks without limit (logarithmically): under the hammer itself there is no answer that
does not depend on the basis. Away from it a transverse wavenumber k fades as exp(-k |x - x_0|), so TERMS_Y settles
the answer from NEAREST on, where the cases keep their hammer.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse
from numpy.polynomial import legendre
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from . import beam
from .modes import BEYOND, Modes

TERMS_Y = 10  # of each parity used
NEAREST = 0.1  # m between hammer and sensor
CUT = 14e3  # Hz: modes below stay as they are
ELEMENT = 0.1  # m, the longest along x: nine nodes in the shortest wave at CUT
SHIFT = -((2.0 * np.pi * 300.0) ** 2)  # 1/s2, below all modes: the rigid ones make K itself singular
ORDERS = 3  # of the upper modes' answer to a force, in omega^2


@dataclass(frozen=True)
class Across:
    """What the plate has beyond the beam: E_y, G_xy, G_yz [Pa] and nu_xy."""

    e_y: float
    nu_xy: float
    g_xy: float
    g_yz: float


def solve(panel, across, points, zeta, terms=TERMS_Y):
    """Modes seen from `points` [m] along y = 0."""
    line = beam.boundaries(panel, points, ELEMENT)
    stiffness, mass = _matrices(panel, across, line, terms)
    nodes = beam.node_places(line)
    middle = np.concatenate([_values(panel.width, 2 * np.arange(terms), 0.0), np.zeros(2 * terms)])
    seen = np.zeros((len(points), len(nodes), 3 * terms))
    for row, x in enumerate(points):
        seen[row, int(np.argmin(np.abs(nodes - x)))] = middle
    seen = seen.reshape(len(points), -1)
    symmetric = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factor = splu((stiffness - SHIFT * mass).tocsc(), **symmetric)
    square, vectors = _modes_below(stiffness, mass, factor)
    upper = _answers(seen, vectors, mass, factor)
    pseudo, turn = eigh(upper.T @ (stiffness @ upper))
    shape = np.vstack([(seen @ vectors).T, (seen @ upper @ turn).T])
    turning = panel.mass * panel.length**2 / 12.0 + panel.rotary_inertia * panel.length
    shape[0], shape[1] = panel.mass**-0.5, np.asarray(points) * turning**-0.5
    damping = np.full(len(shape), BEYOND)
    damping[:2] = 0.0
    count = min(len(zeta), len(square) - 2)
    damping[2 : 2 + count] = zeta[:count]
    return Modes(np.sqrt(np.concatenate([[0.0, 0.0], square[2:], pseudo])), damping, shape, 2)


def _modes_below(stiffness, mass, factor):
    """omega^2 and vectors (phi' M phi = 1) of all modes below CUT, rising."""
    inverse = LinearOperator(stiffness.shape, matvec=factor.solve)
    count = 100
    start = np.ones(stiffness.shape[0])  # a start of its own choice would differ from run to run
    while True:
        square, vectors = eigsh(stiffness, k=count, M=mass, sigma=SHIFT, OPinv=inverse, v0=start)
        if square.max() > (2.0 * np.pi * CUT) ** 2:
            break
        count *= 2
    order = np.argsort(square)[: int(np.sum(square <= (2.0 * np.pi * CUT) ** 2))]
    return square[order], vectors[:, order]


def _answers(seen, vectors, mass, factor):
    """An orthonormal basis of what the modes above CUT answer to a force at each point."""
    basis, load = [], seen.T
    for _ in range(ORDERS):
        answer = factor.solve(load)
        answer = answer - vectors @ (vectors.T @ (mass @ answer))
        basis.append(answer / np.sqrt(np.sum(answer * (mass @ answer), axis=0)))
        load = mass @ basis[-1]
    basis = np.hstack(basis)
    for _ in range(2):  # once more for what rounding left
        basis = basis - vectors @ (vectors.T @ (mass @ basis))
        size, turn = eigh(basis.T @ (mass @ basis))
        useful = size > 1e-9 * size[-1]
        basis = basis @ (turn[:, useful] / np.sqrt(size[useful]))
    return basis


def _matrices(panel, across, line, terms):
    """Stiffness and mass, sparse; unknowns node by node along x: w, psi_x, psi_y, each by its terms across y."""
    cube = panel.thickness**3 / 12.0
    law = cube / (1.0 - across.nu_xy**2 * across.e_y / panel.e_x)
    d11, d22, d12 = panel.e_x * law, across.e_y * law, across.nu_xy * across.e_y * law
    d66 = across.g_xy * cube
    a55 = beam.SHEAR_COEFFICIENT * panel.g_zx * panel.thickness
    a44 = beam.SHEAR_COEFFICIENT * across.g_yz * panel.thickness
    even = 2 * np.arange(terms)
    odd = even + 1
    width = panel.width
    ee, ed_ed = (_integral(width, even, even, s, s) for s in (0, 1))  # d: the slope of the polynomial
    oo, od_od = (_integral(width, odd, odd, s, s) for s in (0, 1))
    e_od, ed_o = _integral(width, even, odd, 0, 1), _integral(width, even, odd, 1, 0)
    nn, nd, dd = beam.line_matrices(line)  # integrals along x of value value, value slope, slope slope
    none = np.zeros((terms, terms))

    def along(matrix, blocks):
        return sparse.kron(matrix, np.block(blocks), format="csr")

    slopes = [[a55 * ee, none, none], [none, d11 * ee, none], [none, none, d66 * oo]]
    values = [
        [a44 * ed_ed, none, a44 * ed_o],
        [none, d66 * ed_ed + a55 * ee, none],
        [a44 * ed_o.T, none, d22 * od_od + a44 * oo],
    ]
    # Rows as value, columns as slope: psi_x w_x, psi_y,x psi_x,y and psi_x,x psi_y,y.
    mixed = [[none, none, none], [a55 * ee, none, d66 * ed_o], [none, d12 * e_od.T, none]]
    cross = along(nd, mixed)
    stiffness = along(dd, slopes) + along(nn, values) + cross + cross.T
    inertia = panel.mass_per_area * panel.rotary * panel.thickness**2 / 12.0
    own = [[panel.mass_per_area * ee, none, none], [none, inertia * ee, none], [none, none, inertia * oo]]
    return stiffness.tocsc(), along(nn, own).tocsc()


def _values(side, degrees, place, slope=0):
    """Legendre polynomials of the given degrees over a side, or their slopes, at `place` from its middle."""
    series = [legendre.legder(row, slope) if slope else row for row in np.eye(degrees[-1] + 1)[degrees]]
    return np.stack([legendre.legval(2.0 * place / side, row) for row in series], axis=-1) * (2.0 / side) ** slope


def _integral(side, left, right, left_slope, right_slope):
    """Integrals over the side of the polynomials of degrees `left` times those of degrees `right`, each as value (0)
    or slope (1)."""
    point, weight = legendre.leggauss(int(max(left[-1], right[-1])) + 1)
    place = side / 2.0 * point
    one, other = _values(side, left, place, left_slope), _values(side, right, place, right_slope)
    return side / 2.0 * one.T @ (weight[:, None] * other)
