r"""The free-free Timoshenko beam of the seed's section 2.3 as a finite element model of high order.

$$ (E I \psi')' - k' G A (w' + \psi) = \rho I \ddot\psi $$
$$ (k' G A (w' + \psi))' + f \delta(x - l_1) = \rho A \ddot w $$

(equation 5; I = b t^3/12, A = b t, k' = 2/3, shear strain w' + psi, x from the centre of the piece). Elements are
Lagrange polynomials of order 8 on Gauss-Lobatto nodes with a consistent mass, and an element boundary stands at every
force and response place: a force bends the slope of w there, and only a boundary follows that exactly. Source of the
equations: Saito, Parbery, Okuno, Kawano, J. Sound Vib. 208(2), 1997; nothing here is shared with the Rust crates. SI
units.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

SHEAR_COEFFICIENT = 2.0 / 3.0  # k'
ORDER = 8  # of the polynomial in an element


@dataclass(frozen=True)
class Panel:
    """One test piece and its constants: m, m, m, kg/m2, Pa, Pa. Defaults: piece 1 of the seed's table 3, table 9's
    constants."""

    length: float = 0.8
    width: float = 0.1
    thickness: float = 0.03
    mass_per_area: float = 6.880
    e_x: float = 1.067e10
    g_zx: float = 5.304e8

    def __post_init__(self):
        for name, value in vars(self).items():
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} = {value}: give a positive number")

    @property
    def bending(self):
        """E_x I_z, N m2."""
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
        """rho I_z, kg m."""
        return self.mass_per_length * self.thickness**2 / 12.0


@dataclass(frozen=True)
class Modes:
    """Modes of a piece seen from `places`, mass-normalised by equation 18.

    `frequency` [Hz] (M) and `shape` W_m(x) [kg^-1/2] (M, places) are the flexible modes up to the limit asked; `rigid`
    (2, places) holds translation and rotation. `remainder` [m/N] (places, places) is the static part of all flexible
    modes above, sum W_m(l_1) W_m(l_x) / omega_m^2. Without it a driving point would lack 0.7 (m/s2)/N at 4.5 kHz, with
    the limit at 65 kHz, where the rigid piece alone has 1.8 (m/s2)/N and more.
    """

    places: tuple
    frequency: np.ndarray
    shape: np.ndarray
    rigid: np.ndarray
    remainder: np.ndarray

    @property
    def omega(self):
        """Natural angular frequencies, rad/s."""
        return 2.0 * np.pi * self.frequency

    def index(self, place):
        """Where `place` stands among the places."""
        return self.places.index(place)


def solve(panel, places, up_to):
    """The modes of `panel` at `places` [m from the centre]; flexible modes up to `up_to` Hz stay dynamic, the rest
    static."""
    places = tuple(places)
    for place in places:
        if abs(place) > panel.length / 2.0:
            raise ValueError(f"place x = {place} m lies off the piece: |x| <= {panel.length / 2.0} m")
    # The shortest wave is the shear wave, c = sqrt(k'GA / rho A). Ten nodes in it keep the frequencies within 1e-8.
    shortest = np.sqrt(panel.shear / panel.mass_per_length) / up_to
    nodes, stiffness, mass = _assemble(panel, _boundaries(panel, places, element=shortest * ORDER / 10.0))
    square, vectors = eigh(stiffness, mass)
    at = [int(np.argmin(np.abs(nodes - place))) for place in places]
    # The first two are the rigid modes, whose zero the eigensolver knows only to rounding: their shapes are written
    # down below.
    square, shape = square[2:], vectors[: len(nodes)][at, 2:].T
    kept = square <= (2.0 * np.pi * up_to) ** 2
    above = shape[~kept]
    return Modes(
        places=places,
        frequency=np.sqrt(square[kept]) / (2.0 * np.pi),
        shape=shape[kept],
        rigid=_rigid_shapes(panel, np.array(places)),
        remainder=above.T @ (above / square[~kept, None]),
    )


def accelerance(modes, zeta, force_at, response_at, frequency):
    r"""Equation 21 with the static remainder R, complex, (m/s2)/N, for e^{+j omega t}, at `frequency` [Hz].

    $$ G = \sum_{rigid} W W
         - \omega^2 \Big( \sum_m \frac{W_m(l_1) W_m(l_x)}{\omega_m^2 - \omega^2 + 2 j \zeta_m \omega_m \omega} + R \Big)
         $$
    """
    i, j = modes.index(force_at), modes.index(response_at)
    omega = 2.0 * np.pi * np.asarray(frequency, dtype=float)[:, None]
    products = modes.shape[:, i] * modes.shape[:, j]
    receptance = products / (modes.omega**2 - omega**2 + 2.0j * zeta * modes.omega * omega)
    rigid = float(modes.rigid[:, i] @ modes.rigid[:, j])
    return rigid - omega[:, 0] ** 2 * (receptance.sum(axis=1) + modes.remainder[i, j])


def damping(modes, ratios, beyond):
    """One damping ratio a flexible mode: `ratios` for the first, `beyond` for the others."""
    zeta = np.full(len(modes.frequency), float(beyond))
    count = min(len(ratios), len(zeta))
    zeta[:count] = ratios[:count]
    return zeta


def _boundaries(panel, places, element):
    """Element boundaries: both ends, every place, and equal parts between them no longer than `element`."""
    fixed = np.unique([-panel.length / 2.0, *places, panel.length / 2.0])
    parts = [np.linspace(a, b, int(np.ceil((b - a) / element)) + 1)[:-1] for a, b in zip(fixed[:-1], fixed[1:])]
    return np.concatenate([*parts, fixed[-1:]])


def _assemble(panel, boundaries):
    """Node places, stiffness and mass; unknowns are w at all nodes, then psi at all nodes."""
    lobatto = np.concatenate([[-1.0], np.sort(legendre.legroots(legendre.legder([0.0] * ORDER + [1.0])).real), [1.0]])
    point, weight = legendre.leggauss(ORDER + 1)  # exact to degree 2 ORDER + 1: full integration
    modal = np.linalg.inv(legendre.legvander(lobatto, ORDER))
    value = legendre.legvander(point, ORDER) @ modal
    slope = np.stack([legendre.legval(point, legendre.legder(row)) for row in np.eye(ORDER + 1)], axis=1) @ modal
    vv, vd, dd = (a.T @ (weight[:, None] * b) for a, b in ((value, value), (value, slope), (slope, slope)))

    count = ORDER * (len(boundaries) - 1) + 1
    nodes = np.empty(count)
    stiffness, mass = np.zeros((2 * count, 2 * count)), np.zeros((2 * count, 2 * count))
    for e, (left, right) in enumerate(zip(boundaries[:-1], boundaries[1:])):
        half = (right - left) / 2.0
        w = np.arange(ORDER * e, ORDER * (e + 1) + 1)
        psi = w + count
        nodes[w] = left + half * (lobatto + 1.0)
        stiffness[np.ix_(w, w)] += panel.shear * dd / half
        stiffness[np.ix_(psi, w)] += panel.shear * vd
        stiffness[np.ix_(w, psi)] += panel.shear * vd.T
        stiffness[np.ix_(psi, psi)] += panel.bending * dd / half + panel.shear * vv * half
        mass[np.ix_(w, w)] += panel.mass_per_length * vv * half
        mass[np.ix_(psi, psi)] += panel.rotary_inertia * vv * half
    return nodes, stiffness, mass


def _rigid_shapes(panel, x):
    """Translation, w = 1, and rotation, w = x with psi = -1, each normalised by equation 18."""
    mass = panel.mass_per_length * panel.length
    inertia = mass * panel.length**2 / 12.0 + panel.rotary_inertia * panel.length
    return np.stack([np.full(len(x), 1.0 / np.sqrt(mass)), x / np.sqrt(inertia)])
