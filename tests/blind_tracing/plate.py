r"""The orthotropic Mindlin plate, by Ritz on Legendre products: the panel that a beam cannot follow across its width.

Strain energy with D_11 = E_x t^3/12/(1 - nu_xy nu_yx), D_22, D_12 = nu_xy E_y t^3/12/(1 - nu_xy nu_yx),
D_66 = G_xy t^3/12, A_55 = k' G_zx t, A_44 = k' G_yz t, k' = 2/3, nu_yx = nu_xy E_y / E_x; kinetic energy
rho t w^2 + rho t^3/12 (psi_x^2 + psi_y^2); all edges free. Hammer and sensor stand on the centre line y = 0, so only
motion even in y is needed: w and psi_x even, psi_y odd. SI units.

A point force on a Mindlin plate sinks without limit (logarithmically): a place of the hammer within some 30 mm of the
sensor has no answer here that does not depend on the basis. The cases keep away from that.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

from .beam import SHEAR_COEFFICIENT
from .modes import reduced

TERMS_X = 32
TERMS_Y = 8  # of each parity used


@dataclass(frozen=True)
class Across:
    """What the plate has beyond the beam: E_y, G_xy, G_yz [Pa] and nu_xy."""

    e_y: float
    nu_xy: float
    g_xy: float
    g_yz: float


def solve(panel, across, points, zeta, terms=(TERMS_X, TERMS_Y)):
    """Modes seen from `points` [m] along y = 0."""
    x, even = np.arange(terms[0]), 2 * np.arange(terms[1])
    odd = even + 1
    cube = panel.thickness**3 / 12.0
    law = cube / (1.0 - across.nu_xy**2 * across.e_y / panel.e_x)
    d11, d22, d12 = panel.e_x * law, across.e_y * law, across.nu_xy * across.e_y * law
    d66 = across.g_xy * cube
    a55 = SHEAR_COEFFICIENT * panel.g_zx * panel.thickness
    a44 = SHEAR_COEFFICIENT * across.g_yz * panel.thickness
    length, width = panel.length, panel.width
    xv, xd, dd = (_integral(length, x, x, *s) for s in ((0, 0), (0, 1), (1, 1)))  # d: the slope of the polynomial
    ee, ed_ed = (_integral(width, even, even, s, s) for s in (0, 1))
    oo, od_od = (_integral(width, odd, odd, s, s) for s in (0, 1))
    e_od, ed_o = _integral(width, even, odd, 0, 1), _integral(width, even, odd, 1, 0)
    ww = a55 * np.kron(dd, ee) + a44 * np.kron(xv, ed_ed)
    wx = a55 * np.kron(xd.T, ee)
    wy = a44 * np.kron(xv, ed_o)
    xx = d11 * np.kron(dd, ee) + d66 * np.kron(xv, ed_ed) + a55 * np.kron(xv, ee)
    xy = d12 * np.kron(xd.T, e_od) + d66 * np.kron(xd, ed_o)
    yy = d22 * np.kron(xv, od_od) + d66 * np.kron(dd, oo) + a44 * np.kron(xv, oo)
    stiffness = np.block([[ww, wx, wy], [wx.T, xx, xy], [wy.T, xy.T, yy]])
    inertia = panel.mass_per_area * panel.rotary * panel.thickness**2 / 12.0
    blocks = ((panel.mass_per_area, ee), (inertia, ee), (inertia, oo))
    mass = np.concatenate([rho * np.diag(np.kron(xv, y)) for rho, y in blocks])
    # The Legendre basis is orthogonal, so the mass is a diagonal and the problem an ordinary one.
    root = np.sqrt(mass)
    square, vectors = eigh(stiffness / root[:, None] / root)
    middle = _values(width, even, 0.0)
    row = [np.kron(_values(length, x, place), middle) for place in points]
    seen = np.hstack([np.array(row), np.zeros((len(points), len(mass) - len(row[0])))])
    turning = panel.mass * panel.length**2 / 12.0 + panel.rotary_inertia * panel.length
    rigid = np.stack([np.full(len(points), panel.mass**-0.5), np.asarray(points) * turning**-0.5])
    return reduced(square, vectors / root[:, None], seen, rigid, zeta)


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
