"""One hammer test as it truly is: the piece, what hangs on it, the chain that measures it, and where people hit."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from . import beam, core, plate
from .contour import Sampling
from .modes import Modes

GRID = 1e-3  # m: places are measured to a millimetre
# Hits lie this far apart or on the same spot [m]: an element boundary stands at each, and a shorter element spoils
# the eigensolution's rounding.
SPOT = 0.25e-3
SPANS_UP_TO = 12e3  # Hz
CONTACT = (1.3e-4, 2.2e-4)  # s: a metal or hard plastic tip on an aluminium face


@dataclass
class Bench:
    """What is true of a test. Effects change it, and `records` plays it.

    `forces` [m] are the places as the tester notes them, `off` (places, hits) [m] by how much the hammer misses them,
    `response` and `response_off` [m] likewise. `attachments` are pairs (x, Z(s)), `core` the shear modulus over its
    static value as a function of s, `restoring` a law f(y, dy/dt) at the points `restoring_at`, or on the
    mean shear strain of the `restoring_spans`. `chain` are factors on the acceleration, `record_gain` (places) and
    `gain` multiply it.
    `hanging` are the damping ratios of the panel's two motions on its cords, `declared` the ids of effects that the test file tells
    without their numbers. `own` is by how much each mode is off: its frequency's share (modes), and complex factors on its residues
    (modes, places). `unit` is that of the accelerations in files.
    `drift` (places, hits) is a factor on all stiffness. `window` [s] is the decay of an exponential window on both
    channels; `saturation` is the amplifier's limit over the test's median peak; `hum` is 50 Hz over the rms.
    """

    panel: beam.Panel
    zeta: np.ndarray
    forces: np.ndarray
    response: float
    suspension: tuple
    hits: int
    noise: float
    sampling: Sampling = field(default_factory=Sampling)
    across: plate.Across | None = None
    core: Callable | None = None
    attachments: list = field(default_factory=list)
    restoring: Callable | None = None
    restoring_at: tuple = ()
    restoring_spans: tuple = ()
    chain: list = field(default_factory=list)
    gain: float = 1.0
    response_off: float = 0.0
    window: float | None = None
    saturation: float | None = None
    hum: float = 0.0
    hanging: tuple = ()
    declared: tuple = ()
    own: tuple | None = None
    unit: str = "m/s2"
    contact: tuple = CONTACT
    structure: ClassVar[None] = None  # what a test file names none for

    def __post_init__(self):
        self.record_gain = np.ones(len(self.forces))
        self.off = np.zeros((len(self.forces), self.hits))
        self.drift = np.ones((len(self.forces), self.hits))

    def change_panel(self, **what):
        """The same bench with another panel."""
        self.panel = replace(self.panel, **what)

    def struck(self):
        """Where the hammer truly falls (places, hits) [m], on the piece and on the SPOT grid."""
        half = self.panel.length / 2.0
        return np.clip(self.forces[:, None] + np.round(self.off / SPOT) * SPOT, -half, half)

    def sensed(self):
        """Where the sensor truly sits, m."""
        half = self.panel.length / 2.0
        return float(np.clip(self.response + self.response_off, -half, half))

    def constants(self):
        """What an identification should find."""
        return {"e_x": self.panel.e_x, "g_zx": self.panel.g_zx, "shear_coefficient": beam.SHEAR_COEFFICIENT}

    def modes(self, points):
        """Modes of the panel seen from `points`, and after those as the mean shear strain of `restoring_spans`."""
        if self.core is not None:
            return core.solve(self.panel, points, self.zeta, self.core, self.sampling)
        if self.across is not None:
            return plate.solve(self.panel, self.across, points, self.zeta)
        modes = beam.solve(self.panel, points, [*self.hanging, *self.zeta], self.restoring_spans)
        # A span softens in the motion that the records show; a force on strains above it would need far finer steps.
        modes.shape[modes.omega > 2.0 * np.pi * SPANS_UP_TO, len(points) :] = 0.0
        return modes

    def off_by_itself(self, modes, places, sensor):
        """The modes as `own` has them, seen from points of which the first are struck in these `places`, one is the sensor's."""
        if self.own is None:
            return modes
        loose, (shares, factors) = 2 if self.panel.left == "free" else 0, self.own
        count = min(len(modes) - loose, len(shares))
        share, factor = np.zeros(len(modes)), np.ones((len(modes), modes.points), dtype=complex)
        flexible = slice(loose, loose + count)
        share[flexible] = shares[:count]
        factor[flexible, : len(places)] = factors[:count, places]
        if isinstance(modes, Modes):
            # What is in quadrature begins with a jump of the place; together the modes have none where the sensor is.
            jump = (modes.shape[:, [sensor]] * modes.shape / np.maximum(modes.omega, 1.0)[:, None])[flexible]
            whole = np.sum(factor[flexible].imag * jump, axis=0) / np.sum(np.abs(jump), axis=0)
            factor[flexible, : len(places)] -= 1.0j * (np.sign(jump) * whole)[:, : len(places)]
        return modes.of_its_own(share, factor)


# Length, width, thickness [m], E_x and G_zx [Pa]: pieces 1 to 4 of the seed's tables 3 and 9.
PIECES = (
    (0.8, 0.1, 0.03, 1.067e10, 5.304e8),
    (0.8, 0.2, 0.03, 1.085e10, 5.390e8),
    (0.8, 0.1, 0.06, 4.954e9, 2.922e8),
    (0.8, 0.2, 0.06, 4.974e9, 3.013e8),
)
MASS_PER_AREA = 6.880
ROVING = (-0.375, -0.2625, -0.0625, 0.1625, 0.375)  # of the length
SINGLE = (-0.375,)
SUSPENDED = 0.2242  # of the length: the nodes of a free beam's first mode
DAMPING = (0.002, 0.015)
DAMPED = 16  # flexible modes that get a damping ratio of their own: all those in the band


def draw(random, places="roving", sampling=None, cantilever=False):
    """A test with no effect: a piece of the seed or one near it, five places or one, and noise of 0.1 to 1 %."""
    length, width, thickness, e_x, g_zx = PIECES[random.integers(len(PIECES))]
    mass = MASS_PER_AREA
    if random.random() < 0.5:
        length = round(length * random.uniform(0.75, 1.25), 3)
        width = round(width * random.uniform(0.8, 1.2), 3)
        mass = round(mass * random.uniform(0.95, 1.05), 3)
    e_x, g_zx = e_x * random.uniform(0.9, 1.1), g_zx * random.uniform(0.9, 1.1)
    panel = beam.Panel(length, width, thickness, mass, e_x, g_zx, left="clamped" if cantilever else "free")
    side = random.choice([-1.0, 1.0])
    of_length = np.array(ROVING if places == "roving" else SINGLE)
    shift = random.uniform(-0.02, 0.02, len(of_length))
    if cantilever:
        # The same spread over the part that moves: from a fifth of the length to the tip.
        of_length, side = 0.1 + 0.8 * of_length, 1.0
    forces = side * of_length * length + np.clip(shift, -0.02, 0.02)
    forces = np.clip(np.round(forces / GRID) * GRID, -length / 2 + 0.01, length / 2 - 0.01)
    response = side * (0.4 if cantilever else 0.375) * length + random.uniform(-0.02, 0.02)
    response = float(np.round(np.clip(response, -length / 2 + 0.01, length / 2 - 0.01) / GRID) * GRID)
    if places == "roving" and random.random() < 0.5:
        forces[-1] = response  # the driving point: the hammer behind the sensor
    strings = np.round(SUSPENDED * length / GRID) * GRID
    return Bench(
        panel=panel,
        zeta=np.exp(random.uniform(*np.log(DAMPING), DAMPED)),
        forces=forces,
        response=response,
        suspension=() if cantilever else (-float(strings), float(strings)),
        hits=3 if places == "roving" else 5,
        noise=float(np.exp(random.uniform(np.log(1e-3), np.log(1e-2)))),
        sampling=sampling or Sampling(),
    )
