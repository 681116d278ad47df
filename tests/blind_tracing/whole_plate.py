r"""A whole panel, free or held along its left edge: an orthotropic Mindlin plate by spectral elements along x and y, whose core may differ from place to place.

Strain energy, with psi the rotations so that the shear strains are w,x + psi_x and w,y + psi_y:

$$ U = \tfrac12 \int D_{11}\psi_{x,x}^2 + 2 D_{12}\psi_{x,x}\psi_{y,y} + D_{22}\psi_{y,y}^2 + D_{66}(\psi_{x,y}+\psi_{y,x})^2
   + g\,[A_{55}(w_{,x}+\psi_x)^2 + A_{44}(w_{,y}+\psi_y)^2]\;dx\,dy , $$

D_11 = E_x t^3/12/(1 - nu_xy nu_yx), D_22 and D_12 = nu_xy E_y t^3/12/(1 - nu_xy nu_yx) alike, D_66 = G_xy t^3/12, A_55 = k' G_zx t,
A_44 = k' G_yz t, k' = 2/3, nu_yx = nu_xy E_y/E_x; g(x, y) is the core's share of its mean. Kinetic energy rho t w^2 + rho t^3/12
(psi_x^2 + psi_y^2). Rectangles of degree DEGREE on Lobatto's nodes, full Gauss quadrature; lines stand where g jumps, and close to
what is small: feet, and edges and jumps, where the rotations have a layer of about t/3.

What is fixed to a panel stands on a foot of finite size: a point load sinks without limit into a Mindlin plate, logarithmically, so a mass on
a point is a different mass on each basis. SI units.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sparse
from numpy.polynomial import legendre
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from .core import CoreModes, orthonormal
from .modes import BEYOND, Modes

SHEAR_COEFFICIENT = 2.0 / 3.0
CONSTANTS = ("e_x", "e_y", "nu_xy", "g_xy", "g_yz", "g_zx")
RIGID = 3
DEGREE = 7
ELEMENT, FEWEST = 0.16, 6.0  # m, the longest; at least so many over the longer side
LAYER = 0.5  # of the thickness: the first element at an edge and beside a jump of the core
SECOND = 3.0  # of the thickness: where the second one at an edge ends if that is less than a third of the longest
GROWTH = 3.0  # of elements away from a foot
FLEXIBLE = 120  # modes that stay as they are; at most a third of them lie inside a band
ORDERS = 4  # of the other modes' answer to a force, in omega^2


@dataclass(frozen=True)
class WholePanel:
    """Size [m], mass per area [kg/m2], the six constants [Pa, 1], and the core's share of its shear stiffness over x and y (`core`)
    with the lines [m] where that jumps. `left` is "free" or the springs, over the whole edge against deflection [N/m] and against either
    rotation [N m/rad], that hold the left edge. `edge_mass` [kg] lies evenly along each of front and back, y = -b/2 and b/2."""

    length: float
    width: float
    thickness: float
    mass_per_area: float
    e_x: float
    e_y: float
    nu_xy: float
    g_xy: float
    g_yz: float
    g_zx: float
    core: Callable | None = None
    lines_x: tuple = ()
    lines_y: tuple = ()
    left: str | tuple = "free"
    edge_mass: float = 0.0

    @property
    def rigid(self):
        """How many motions as a whole nothing holds."""
        return RIGID if self.left == "free" else 0

    @property
    def mass(self):
        """kg."""
        return self.mass_per_area * self.length * self.width

    @property
    def constants(self):
        """By their names."""
        return {name: getattr(self, name) for name in CONSTANTS}


@dataclass(frozen=True)
class Foot:
    """A square of `side` [m] about (x, y) that moves as its mean deflection; a side of 0 is a point."""

    x: float
    y: float
    side: float = 0.0


class Mesh:
    """Stiffness and mass over the unknowns w, psi_x, psi_y of each node."""

    def __init__(self, panel, feet=(), degree=None, element=None):
        self.panel, self.degree = panel, degree or DEGREE
        longest = element or min(ELEMENT, max(panel.length, panel.width) / FEWEST)
        self.x = _lines(panel.length, panel.thickness, panel.lines_x, [(f.x, f.side) for f in feet if f.side], longest)
        self.y = _lines(panel.width, panel.thickness, panel.lines_y, [(f.y, f.side) for f in feet if f.side], longest)
        self.nodes_x, self.nodes_y = ((len(line) - 1) * self.degree + 1 for line in (self.x, self.y))
        self.reference = _lobatto(self.degree)
        self.stiffness, self.mass = self._assembled()

    def _assembled(self):
        """Both matrices, element by element."""
        panel, count = self.panel, self.degree + 1
        point, weight = legendre.leggauss(self.degree + 2)
        value, slope = _lagrange(self.reference, point)
        both = lambda one, other: np.einsum("qi,rj->qrij", one, other).reshape(len(point) ** 2, count**2)  # noqa: E731
        w, along, across = both(value, value), both(slope, value), both(value, slope)
        weights = np.outer(weight, weight).ravel()
        hx, hy = np.diff(self.x), np.diff(self.y)
        area = panel.mass_per_area, panel.mass_per_area * panel.thickness**2 / 12.0
        shear, bend = _laws(panel)
        gram = w.T @ (weights[:, None] * w)
        row, entries, masses = [], [], []
        for i, size_x in enumerate(hx):
            x = (self.x[i] + size_x * (1.0 + point) / 2.0)[:, None]
            for j, size_y in enumerate(hy):
                y = (self.y[j] + size_y * (1.0 + point) / 2.0)[None, :]
                here = weights * size_x * size_y / 4.0
                core = np.ones((len(point),) * 2) if panel.core is None else np.broadcast_to(panel.core(x, y), (len(point),) * 2)
                by_x, by_y, none = along * 2.0 / size_x, across * 2.0 / size_y, np.zeros_like(w)
                strain = np.block([[none, by_x, none], [none, none, by_y], [none, by_y, by_x]])
                slip = np.block([[by_x, w, none], [by_y, none, w]])
                stress = np.kron(bend, np.eye(len(here))) @ strain
                own = (np.tile(here, 3)[:, None] * strain).T @ stress
                own += (np.concatenate([shear[0] * here * core.ravel(), shear[1] * here * core.ravel()])[:, None] * slip).T @ slip
                inertia = gram * size_x * size_y / 4.0
                own_mass = np.zeros_like(own)
                for part, heavy in enumerate((area[0], area[1], area[1])):
                    own_mass[part * count**2 : (part + 1) * count**2, part * count**2 : (part + 1) * count**2] = heavy * inertia
                row.append(self._unknowns(i, j))
                entries.append(own)
                masses.append(own_mass)
        rows = np.array(row)
        size, own = 3 * self.nodes_x * self.nodes_y, rows.shape[1]
        at = (np.repeat(rows, own, axis=1).ravel(), np.tile(rows, (1, own)).ravel())
        build = lambda blocks: sparse.csc_matrix((np.array(blocks).ravel(), at), (size, size))  # noqa: E731
        mass, stiffness = build(masses), build(entries)
        mass.eliminate_zeros()
        return stiffness + self._springs(value, weight), mass + self._along_front_and_back(value, weight)

    def _springs(self, value, weight):
        """What holds the nodes of the left edge, which are the first."""
        springs = sparse.lil_matrix((3 * self.nodes_x * self.nodes_y,) * 2)
        if self.panel.left == "free":
            return springs.tocsc()
        translation, rotation = np.array(self.panel.left) / self.panel.width
        for j, size in enumerate(np.diff(self.y)):
            own = value.T @ (weight[:, None] * value) * size / 2.0
            nodes = 3 * (np.arange(self.degree + 1) + self.degree * j)
            for part, spring in enumerate((translation, rotation, rotation)):
                springs[np.ix_(nodes + part, nodes + part)] += spring * own
        return springs.tocsc()

    def _along_front_and_back(self, value, weight):
        """What w of the first and of the last node of each line across carries."""
        mass = sparse.lil_matrix((3 * self.nodes_x * self.nodes_y,) * 2)
        for i, size in enumerate(np.diff(self.x) if self.panel.edge_mass else ()):
            own = self.panel.edge_mass / self.panel.length * value.T @ (weight[:, None] * value) * size / 2.0
            for edge in (0, self.nodes_y - 1):
                nodes = 3 * ((np.arange(self.degree + 1) + self.degree * i) * self.nodes_y + edge)
                mass[np.ix_(nodes, nodes)] += own
        return mass.tocsc()

    def _unknowns(self, i, j):
        """Of element (i, j): w of all its nodes, then psi_x, then psi_y."""
        along, across = (np.arange(self.degree + 1) + self.degree * k for k in (i, j))
        nodes = (along[:, None] * self.nodes_y + across).ravel()
        return np.concatenate([3 * nodes + part for part in range(3)])

    def deflection(self, foot):
        """The row over all unknowns that reads w at a foot."""
        along, across = (self._row(line, at, foot.side) for line, at in ((self.x, foot.x), (self.y, foot.y)))
        return np.kron(np.kron(along, across), [1.0, 0.0, 0.0])

    def _row(self, line, place, side):
        """One direction's values over its nodes: at a place, or their mean over a foot."""
        if not line[0] - 1e-12 <= place <= line[-1] + 1e-12:
            raise ValueError(f"{place:g} m lies off the panel: between {line[0]:g} and {line[-1]:g} m")
        row = np.zeros((len(line) - 1) * self.degree + 1)
        point, weight = (np.zeros(1), np.array([2.0])) if side == 0.0 else legendre.leggauss(self.degree + 2)
        for at, share in zip(place + side / 2.0 * point, weight / 2.0):
            element = int(np.clip(np.searchsorted(line, at) - 1, 0, len(line) - 2))
            low, high = line[element], line[element + 1]
            values = _lagrange(self.reference, np.array([2.0 * (at - low) / (high - low) - 1.0]))[0][0]
            row[element * self.degree : (element + 1) * self.degree + 1] += share * values
        return row

    def nodes_at(self, axis):
        """Where the nodes lie along x (0) or y (1), m."""
        line = (self.x, self.y)[axis]
        within = [low + (high - low) * (1.0 + self.reference[:-1]) / 2.0 for low, high in zip(line[:-1], line[1:])]
        return np.concatenate([*within, line[-1:]])

    def rigid(self, seen):
        """The motions as a whole at rows of places (places, 2), phi' M phi = 1."""
        panel = self.panel
        turning = [panel.mass * (side**2 + panel.thickness**2) / 12.0 for side in (panel.length, panel.width)]
        edges = 2.0 * panel.edge_mass
        turning = [turning[0] + edges * panel.length**2 / 12.0, turning[1] + edges * panel.width**2 / 4.0]
        return np.stack([np.full(len(seen), (panel.mass + edges) ** -0.5), seen[:, 0] * turning[0] ** -0.5, seen[:, 1] * turning[1] ** -0.5])


def solve(panel, struck, fixed, zeta, flexible=None, **mesh):
    """Modes seen from the points `struck` (n, 2) [m], then from the feet `fixed`, of which each pair's compliance is complete: what
    the other modes answer to a force on a foot, to ORDERS orders in omega^2, is a few pseudo-modes."""
    mesh, flexible = Mesh(panel, fixed, **mesh), flexible or FLEXIBLE
    rigid, feet, seen = panel.rigid, *_seen(mesh, struck, fixed)
    square, vectors, factor, shift = lowest(mesh, flexible)
    upper = _answers(seen[len(struck) :], vectors, mesh.mass, factor)
    pseudo, turn = eigh(upper.T @ (mesh.stiffness @ upper))
    shape = np.vstack([(seen @ vectors).T, (seen @ upper @ turn).T])
    shape[:rigid] = mesh.rigid(feet)[:rigid]
    damping = np.full(len(shape), BEYOND)
    damping[:rigid] = 0.0
    count = min(len(zeta), flexible)
    damping[rigid : rigid + count] = zeta[:count]
    return Modes(np.sqrt(np.concatenate([np.zeros(rigid), square[rigid:], pseudo])), damping, shape, rigid)


def relaxing(panel, struck, fixed, zeta, core, sampling, flexible=None, **mesh):
    """The same of a panel whose core's modulus follows core(s): the basis holds the modes at the least and at the greatest modulus, and
    what the others answer to a force at each place. CUT is where its modes end."""
    whole, flexible = Mesh(panel, fixed, **mesh), flexible or FLEXIBLE
    before = panel.core or (lambda x, y: np.ones(np.broadcast(x, y).shape))
    stiffer = lambda modulus: replace(panel, core=lambda x, y: modulus * before(x, y))  # noqa: E731
    feet, seen = _seen(whole, struck, fixed)
    highest = sampling.lines()[0][-1]
    shear = Mesh(stiffer(2.0), fixed, **mesh).stiffness - whole.stiffness
    basis = []
    for modulus in (1.0, abs(core(2.0j * np.pi * highest))):
        part = Mesh(stiffer(modulus), fixed, **mesh)
        _, vectors, factor, _ = lowest(part, flexible)
        basis += [vectors[:, panel.rigid :], _answers(seen, vectors, part.mass, factor)]
    nodes = np.array([[x, y] for x in whole.nodes_at(0) for y in whole.nodes_at(1)])
    turned = whole.rigid(nodes)[: panel.rigid]
    first = np.zeros((whole.stiffness.shape[0], panel.rigid))
    for mode, row in enumerate(turned):
        first[0::3, mode] = row
        if mode:  # psi_x of the turn about y, psi_y of that about x
            first[mode::3, mode] = -(row[-1] - row[0]) / (nodes[-1] - nodes[0])[mode - 1]
    basis = orthonormal(np.hstack([first, *basis]), whole.mass, panel.rigid)
    stiffness, shear = (basis.T @ (part @ basis) for part in (whole.stiffness, shear))
    return CoreModes(stiffness, shear, (seen @ basis).T, panel.rigid, zeta, core, sampling.sigma, highest)


def _seen(mesh, struck, fixed):
    """Where the points and the feet are (n, 2), and the rows that read their deflections."""
    feet = [*(Foot(x, y) for x, y in struck), *fixed]
    return np.array([(foot.x, foot.y) for foot in feet]), np.array([mesh.deflection(foot) for foot in feet])


def frequencies(panel, flexible, **mesh):
    """Of the flexible modes, Hz."""
    return np.sqrt(lowest(Mesh(panel, **mesh), flexible)[0][panel.rigid :]) / 2.0 / np.pi


def lowest(mesh, flexible):
    """omega^2 and vectors (phi' M phi = 1) of the rigid and the first flexible modes, and the factor that found them."""
    panel = mesh.panel
    stiff = np.sqrt(panel.e_x * panel.thickness**3 / 12.0 / panel.mass_per_area) * np.pi**2 / (panel.length * panel.width)
    shift = -((0.3 * stiff) ** 2)  # below all modes: the rigid ones make the stiffness itself singular
    symmetric = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factor = splu((mesh.stiffness - shift * mesh.mass).tocsc(), **symmetric)
    inverse = LinearOperator(mesh.stiffness.shape, matvec=factor.solve)
    start = np.random.default_rng(1).standard_normal(mesh.stiffness.shape[0])  # one of its own choice would differ from run to run
    square, vectors = eigsh(mesh.stiffness, k=panel.rigid + flexible, M=mesh.mass, sigma=shift, OPinv=inverse, v0=start)
    order = np.argsort(square)
    return square[order], vectors[:, order], factor, shift


def _answers(loads, vectors, mass, factor):
    """An orthonormal basis of what the modes beside `vectors` answer to the loads."""
    basis, load = [], loads.T
    for _ in range(ORDERS):
        answer = factor.solve(np.ascontiguousarray(load))
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


def _laws(panel):
    """Stiffness against shear (A_55, A_44) [N/m] and the matrix of that against bending [N m]."""
    cube = panel.thickness**3 / 12.0
    law = cube / (1.0 - panel.nu_xy**2 * panel.e_y / panel.e_x)
    d12 = panel.nu_xy * panel.e_y * law
    bend = np.array([[panel.e_x * law, d12, 0.0], [d12, panel.e_y * law, 0.0], [0.0, 0.0, panel.g_xy * cube]])
    return [SHEAR_COEFFICIENT * g * panel.thickness for g in (panel.g_zx, panel.g_yz)], bend


def _lines(side, thickness, jumps, feet, longest):
    """Element boundaries over a side, from its middle: at edges, jumps and feet, with elements that grow away from what is small."""
    half = side / 2.0
    wanted = [-half, half, *(at for at in jumps if abs(at) < half - 1e-9)]
    near = [at + sign * LAYER * thickness for at in wanted for sign in (-1.0, 1.0)]
    if SECOND * thickness < longest / 3.0:
        near += [SECOND * thickness - half, half - SECOND * thickness]
    for at, size in feet:
        near += [at - size / 2.0, at + size / 2.0]
        reach = size * (0.5 + GROWTH)
        while reach < longest:
            near += [at - reach, at + reach]
            reach *= GROWTH
    lines = sorted(wanted)
    for at in near:  # what comes close to a line already there adds nothing
        least = 0.3 * min([thickness, *(size for _, size in feet)])
        if abs(at) < half and np.min(np.abs(np.array(lines) - at)) > least:
            lines.append(at)
    lines = np.sort(lines)
    parts = [np.linspace(a, b, int(np.ceil((b - a) / longest)) + 1)[:-1] for a, b in zip(lines[:-1], lines[1:])]
    return np.concatenate([*parts, [half]])


def _lobatto(degree):
    """The Gauss-Lobatto points of a degree, on [-1, 1]."""
    inner = legendre.legroots(legendre.legder(np.eye(degree + 1)[degree]))
    return np.concatenate([[-1.0], inner, [1.0]])


def _lagrange(nodes, at):
    """Values and slopes (points, nodes) of the polynomials that are 1 at one node and 0 at the others."""
    order = len(nodes) - 1
    turn = np.linalg.inv(legendre.legvander(nodes, order))
    slopes = np.stack([legendre.legval(at, legendre.legder(row)) for row in np.eye(order + 1)], axis=-1)
    return legendre.legvander(at, order) @ turn, slopes @ turn
