r"""A free sandwich plate with faces and core apart: solid elements, a core that carries shear and thickness, and a patch without.

Nothing of a plate's theory is in it: displacements (u, v, w) of three-dimensional hexahedra of the second degree (scikit-fem), in the upper
half of the sandwich. Bending is odd about the middle plane, so that u = v = 0 there; energy and mass of the lower half are the same. The
faces are isotropic; the core has Young's modulus through the thickness, two shear moduli, and next to nothing along the plate. SI units.
"""

from dataclasses import dataclass
from functools import cache
from typing import ClassVar

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from skfem import Basis, BilinearForm, ElementHex2, ElementVector, MeshHex, asm

from .modes import BEYOND, Modes

RIGID = 3
SOFT = 1e6  # Pa: what a core has of the moduli that it is said to lack
ELEMENT = 0.02  # m
SHIFT = 1e5  # 1/s2, below which no omega^2 lies
LEFT = 0.01  # of the core's shear stiffness in a patch that has lost it


@dataclass(frozen=True)
class Sandwich:
    """Sizes [m], a face's modulus [Pa], Poisson's ratio and density [kg/m3], the core's moduli [Pa] and density; `patch` is what
    has lost its core's shear stiffness: x and y of the middle and the side [m]."""

    length: float = 0.48
    width: float = 0.36
    core: float = 0.010
    face: float = 0.0004
    e_face: float = 70e9
    nu_face: float = 0.33
    face_density: float = 2700.0
    e_z: float = 1e9
    g_zx: float = 1.5e8
    g_yz: float = 0.9e8
    core_density: float = 80.0
    patch: tuple | None = None
    left: ClassVar[str] = "free"

    @property
    def thickness(self):
        """Of faces and core."""
        return self.core + 2.0 * self.face

    @property
    def mass_per_area(self):
        """kg/m2."""
        return 2.0 * self.face * self.face_density + self.core * self.core_density


def laws(panel, at):
    """The moduli (6, 6, elements) at the middles of elements `at` (3, elements): xx, yy, zz, yz, zx, xy."""
    x, y, z = at
    in_face = z > 0.5 * panel.core
    lame = panel.e_face * panel.nu_face / (1.0 + panel.nu_face) / (1.0 - 2.0 * panel.nu_face)
    shear = 0.5 * panel.e_face / (1.0 + panel.nu_face)
    left = np.ones_like(x)
    if panel.patch is not None:
        middle_x, middle_y, side = panel.patch
        left[(abs(x - middle_x) < 0.5 * side) & (abs(y - middle_y) < 0.5 * side)] = LEFT
    core = np.zeros((6, 6, len(x)))
    for k, modulus in enumerate((SOFT, SOFT, panel.e_z, panel.g_yz * left, panel.g_zx * left, SOFT)):
        core[k, k] = modulus
    face = np.diag([2.0 * shear] * 3 + [shear] * 3)
    face[:3, :3] += lame
    return np.where(in_face, face[:, :, None], core)


@cache
def lowest(panel, element, flexible):
    """Of elements so long [m]: omega^2 of the rigid and the first flexible modes, mass-normalised w (nodes, modes) on the upper side, and
    x and y (2, nodes) of these nodes."""
    even = lambda side: np.linspace(-0.5 * side, 0.5 * side, round(side / element) + 1)  # noqa: E731
    mesh = MeshHex.init_tensor(even(panel.length), even(panel.width), np.array([0.0, 0.5 * panel.core, 0.5 * panel.thickness]))
    basis = Basis(mesh, ElementVector(ElementHex2()), intorder=4)
    middles = mesh.p[:, mesh.t].mean(axis=1)
    law = laws(panel, middles)
    density = np.where(middles[2] > 0.5 * panel.core, panel.face_density, panel.core_density)

    def strains(u):
        g = u.grad
        return [g[0, 0], g[1, 1], g[2, 2], g[1, 2] + g[2, 1], g[0, 2] + g[2, 0], g[0, 1] + g[1, 0]]

    @BilinearForm
    def energy(u, v, w):
        one, other = strains(u), strains(v)
        # Of an element's row of the law those that are not zero.
        pairs = [(i, j) for i in range(6) for j in range(6) if np.any(law[i, j] != 0.0)]
        return sum(law[i, j][:, None] * one[i] * other[j] for i, j in pairs)

    @BilinearForm
    def inertia(u, v, w):
        return density[:, None] * sum(u[k] * v[k] for k in range(3))

    stiffness, mass = asm(energy, basis), asm(inertia, basis)
    of_component = [
        np.concatenate([dofs[k].ravel() for dofs in (basis.nodal_dofs, basis.edge_dofs, basis.facet_dofs, basis.interior_dofs)])
        for k in range(3)
    ]
    along = np.concatenate(of_component[:2])
    free = np.setdiff1d(np.arange(basis.N), along[basis.doflocs[2, along] < 1e-9])
    stiffness, mass = (matrix[free][:, free].tocsc() for matrix in (stiffness, mass))
    # The shifted matrix is definite: its factor wants no pivots, and is a tenth as full in the order of a symmetric one.
    factor = splu(stiffness + SHIFT * mass, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = LinearOperator(stiffness.shape, matvec=factor.solve)
    square, vectors = eigsh(stiffness, k=RIGID + flexible, M=mass, sigma=-SHIFT, OPinv=inverse)
    order = np.argsort(square)
    whole = np.zeros((basis.N, len(order)))
    # The lower half has as much mass.
    whole[free] = vectors[:, order] / np.sqrt(2.0)
    up = of_component[2]
    top = up[basis.doflocs[2, up] > 0.5 * panel.thickness - 1e-9]
    return square[order], whole[top], basis.doflocs[:2, top]


def solve(panel, struck, fixed, zeta, element=ELEMENT, flexible=80):
    """Modes seen from the points `struck` (n, 2) [m], then from the middles of `fixed`, which must be nodes."""
    square, shapes, at = lowest(panel, element, flexible)
    points = np.array([*map(tuple, struck), *((foot.x, foot.y) for foot in fixed)])
    away = np.hypot(*(at[:, :, None] - points.T[:, None, :]))
    nearest = np.argmin(away, axis=0)
    if np.max(away[nearest, np.arange(len(points))]) > 1e-6:
        raise ValueError("a place that is no node")
    damping = np.full(len(square), BEYOND)
    damping[:RIGID] = 0.0
    count = min(len(zeta), flexible)
    damping[RIGID : RIGID + count] = zeta[:count]
    square[:RIGID] = 0.0
    return Modes(np.sqrt(square), damping, shapes[nearest].T, RIGID)
