r"""The Timoshenko beam of the test cases, by finite elements: what a sandwich beam is where it is not uniform or free.

$$ (E I\, e(x) \psi')' - k' G A\, g(x) (w' + \psi) = r \rho I\, m(x) \ddot\psi, \qquad
   (k' G A\, g(x) (w' + \psi) + N w')' + f = \rho A\, m(x) \ddot w $$

with e(x), g(x), m(x) the bending stiffness, shear stiffness and mass along the beam over their nominal ones, r a factor on the rotary
inertia, N a tension, and a left end that is free, clamped, or held by springs. I = b t^3/12, A = b t, k' = 2/3, x from the centre
of the piece.
Elements are Lagrange polynomials of order 8 on Gauss-Lobatto nodes; an element boundary stands at every point and at
every step of e, g and m. Source of the equations: Saito, Parbery, Okuno, Kawano, J. Sound Vib. 208(2), 1997. SI units.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

from .modes import reduced

SHEAR_COEFFICIENT = 2.0 / 3.0
ORDER = 8
ELEMENT = 0.04  # m, the longest element: seven nodes in the shortest wave at modes.CUT


@dataclass(frozen=True)
class Panel:
    """A piece and its constants (m, m, m, kg/m2, Pa, Pa), and where it departs from the uniform free beam.

    `bending_along(x)`, `shear_along(x)`, `mass_along(x)` are e, g and m, `steps` the places where one jumps; `rotary` is r; `tension`
    is N [N]; `left` is "free", "clamped", or the pair (translation [N/m], rotation [N m/rad]) of the springs that hold the left end.
    `turning` are pairs (x, J): a moment of inertia J [kg m2] that turns with the section at x. `cords` are pairs (x, k): a
    spring k [N/m] to ground, part of the panel's own modes.
    """

    length: float
    width: float
    thickness: float
    mass_per_area: float
    e_x: float
    g_zx: float
    shear_along: Callable | None = None
    bending_along: Callable | None = None
    mass_along: Callable | None = None
    steps: tuple = ()
    rotary: float = 1.0
    tension: float = 0.0
    left: str | tuple = "free"
    turning: tuple = ()
    cords: tuple = ()

    @property
    def bending(self):
        """E_x I, N m2."""
        return self.e_x * self.width * self.thickness**3 / 12.0

    @property
    def shear(self):
        """k' G_zx A, N."""
        return SHEAR_COEFFICIENT * self.g_zx * self.width * self.thickness

    @property
    def mass_per_length(self):
        """rho A, kg/m."""
        return self.mass_per_area * self.width

    @property
    def rotary_inertia(self):
        """r rho I, kg m."""
        return self.rotary * self.mass_per_length * self.thickness**2 / 12.0

    @property
    def mass(self):
        """Of the whole piece, kg."""
        return self.mass_per_length * self.length


def solve(panel, points, zeta, spans=()):
    """Modes seen from `points` [m] and, after those, as the mean shear strain w' + psi over each of `spans` [m, m]."""
    ends = boundaries(panel, points)
    mesh = Mesh(panel, ends)
    stiffness = mesh.bending + mesh.shear + mesh.tension
    held = _hold(panel, stiffness, mesh.nodes)
    free = np.setdiff1d(np.arange(len(stiffness)), held)
    square, vectors = lowest_first(stiffness[np.ix_(free, free)], mesh.mass[np.ix_(free, free)])
    seen = np.vstack([*(mesh.deflection(x) for x in points), *(mesh.mean_strain(*span) for span in spans)])
    loose = 0 if panel.left != "free" or panel.cords else 1 if panel.tension else 2  # a tension turns the panel back
    return reduced(square, vectors, seen[:, free], (seen @ mesh.rigid()[:, :loose]).T, zeta)


SHIFT = (2.0 * np.pi * 30.0) ** 2  # 1/s2, of the size of a hung panel's lowest modes


def lowest_first(stiffness, mass):
    """Eigenvalues, rising, and mass-normalised vectors of the pencil, the lowest to rounding of themselves.

    Hits a fraction of a millimetre apart make elements whose own eigenvalues are 1e13 times those of a panel on cords. Solved as it is, the
    pencil errs by rounding of the largest: by 8 % of such a frequency. The inverse errs by rounding of the lowest.
    """
    flexibility, vectors = eigh(mass, stiffness + SHIFT * mass)
    flexibility, vectors = np.maximum(flexibility[::-1], np.finfo(float).tiny), vectors[:, ::-1]
    return 1.0 / flexibility - SHIFT, vectors / np.sqrt(flexibility)


def boundaries(panel, points, element=ELEMENT):
    """Both ends, every point, every step of the shear stiffness, and equal parts no longer than `element` between."""
    half = panel.length / 2.0
    outside = [x for x in points if abs(x) > half]
    if outside:
        raise ValueError(f"x = {outside[0]} m lies off the piece: |x| <= {half} m")
    inner = [x for x in panel.steps if abs(x) < half]
    fixed = np.unique(np.round([-half, half, *points, *inner, *(x for x, _ in [*panel.turning, *panel.cords])], 9))
    parts = [np.linspace(a, b, int(np.ceil((b - a) / element)) + 1)[:-1] for a, b in zip(fixed[:-1], fixed[1:])]
    return np.concatenate([*parts, fixed[-1:]])


def _hold(panel, stiffness, nodes):
    """Put the cords and the left end's springs into `stiffness`; the unknowns that a clamp takes away."""
    for x, spring in panel.cords:
        at = int(np.argmin(np.abs(nodes - x)))
        stiffness[at, at] += spring
    count = len(nodes)
    if panel.left == "free":
        return []
    if panel.left == "clamped":
        return [0, count]
    translation, rotation = panel.left
    stiffness[0, 0] += translation
    stiffness[count, count] += rotation
    return []


# The interior Gauss-Lobatto nodes are the roots of the Legendre polynomial's slope.
LOBATTO = np.concatenate([[-1.0], np.sort(legendre.legroots(legendre.legder([0.0] * ORDER + [1.0])).real), [1.0]])
NODAL = np.linalg.inv(legendre.legvander(LOBATTO, ORDER))


def node_places(ends):
    """x of all nodes of elements with these ends."""
    inner = [left + (right - left) / 2.0 * (LOBATTO[:-1] + 1.0) for left, right in zip(ends[:-1], ends[1:])]
    return np.concatenate([*inner, ends[-1:]])


def line_matrices(ends):
    """Integrals along x of the shape functions: value times value, value times slope, slope times slope."""
    count = ORDER * (len(ends) - 1) + 1
    whole = np.zeros((3, count, count))
    point, weight = legendre.leggauss(ORDER + 1)
    value, slope = _shape_functions(point)
    for element, half in enumerate(np.diff(ends) / 2.0):
        at = slice(ORDER * element, ORDER * (element + 1) + 1)
        whole[0, at, at] += half * value.T @ (weight[:, None] * value)
        whole[1, at, at] += value.T @ (weight[:, None] * slope)
        whole[2, at, at] += slope.T @ (weight[:, None] * slope) / half
    return whole


def _shape_functions(point):
    """An element's shape functions and their slopes at `point` in -1..1."""
    slope = np.stack([legendre.legval(point, legendre.legder(row)) for row in np.eye(ORDER + 1)], axis=1)
    return legendre.legvander(point, ORDER) @ NODAL, slope @ NODAL


class Mesh:
    """Node places and matrices; unknowns are w at all nodes, then psi at all nodes."""

    def __init__(self, panel, ends):
        self.ends, self.nodes = ends, node_places(ends)
        count = len(self.nodes)
        value, mixed, slope = line_matrices(ends)
        none = np.zeros((count, count))
        self.mass = np.block([[panel.mass_per_length * value, none], [none, panel.rotary_inertia * value]])
        if panel.mass_along is not None:
            self.mass = self._uneven(panel.mass_along, w=(panel.mass_per_length**0.5, 0.0))
            self.mass += self._uneven(panel.mass_along, psi=(panel.rotary_inertia**0.5, 0.0))
        for x, inertia in panel.turning:
            at = count + int(np.argmin(np.abs(self.nodes - x)))
            self.mass[at, at] += inertia
        self.bending = np.block([[none, none], [none, panel.bending * slope]])
        if panel.bending_along is not None:
            self.bending = self._uneven(panel.bending_along, psi=(0.0, panel.bending**0.5))
        self.tension = np.block([[panel.tension * slope, none], [none, none]])
        self.shear = panel.shear * np.block([[slope, mixed.T], [mixed, value]])
        if panel.shear_along is not None:
            root = panel.shear**0.5
            self.shear = self._uneven(panel.shear_along, w=(0.0, root), psi=(root, 0.0))

    def _uneven(self, along, w=(0.0, 0.0), psi=(0.0, 0.0)):
        """The integral of along(x) times a square: of the sum of w, w', psi and psi', each times its factor. More points, as along(x)
        is no polynomial."""
        point, weight = legendre.leggauss(ORDER + 5)
        value, slope = _shape_functions(point)
        whole, count = np.zeros((2 * len(self.nodes),) * 2), len(self.nodes)
        for element, (left, right) in enumerate(zip(self.ends[:-1], self.ends[1:])):
            half = (right - left) / 2.0
            nodes = np.arange(ORDER * element, ORDER * (element + 1) + 1)
            at = np.concatenate([nodes, nodes + count])
            factor = half * weight * along(left + half * (point + 1.0))
            row = np.hstack([one * value + other * slope / half for one, other in (w, psi)])
            whole[np.ix_(at, at)] += row.T @ (factor[:, None] * row)
        return whole

    def rigid(self):
        """Translation, and rotation (w = x, psi = -1) about the centre of mass (unknowns, 2), mass-normalised."""
        count = len(self.nodes)
        shapes = np.zeros((2 * count, 2))
        shapes[:count, 0], shapes[:count, 1], shapes[count:, 1] = 1.0, self.nodes, -1.0
        carried = self.mass @ shapes[:, 0]
        shapes[:, 1] -= shapes[:, 0] * (carried @ shapes[:, 1]) / (carried @ shapes[:, 0])
        return shapes / np.sqrt(np.sum(shapes * (self.mass @ shapes), axis=0))

    def mean_strain(self, left, right):
        """The row that reads the mean of w' + psi from `left` to `right`."""
        point, weight = legendre.leggauss(40)
        places = (left + right) / 2.0 + (right - left) / 2.0 * point
        turned = sum(part / 2.0 * np.roll(self.deflection(x), len(self.nodes)) for x, part in zip(places, weight))
        return (self.deflection(right) - self.deflection(left)) / (right - left) + turned

    def deflection(self, x):
        """The row that reads w(x)."""
        element = int(np.clip(np.searchsorted(self.ends, x, side="right") - 1, 0, len(self.ends) - 2))
        left, right = self.ends[element : element + 2]
        value, _ = _shape_functions(np.array([(2.0 * x - left - right) / (right - left)]))
        row = np.zeros(len(self.mass))
        row[ORDER * element : ORDER * (element + 1) + 1] = value[0]
        return row
