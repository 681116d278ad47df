"""Whole panels: a free plate, hit at a dozen places and more, with what its test file does not tell."""

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from . import attachments, catalogue
from .bench import GRID
from .contour import Sampling
from .draw import Draw
from .whole_plate import FLEXIBLE, SHEAR_COEFFICIENT, Foot, WholePanel, frequencies, relaxing, solve
from .whole_visible import Seen

SETS = ("whole", "whole-real")
# A set's round: the last ones are of one kind each, as the places and the core are what a panel's maker asks about.
KINDS = (
    *("none", "local-mass", "stiffness-loss", "sensor-mass", "none", "local-mass", "stiffness-loss", "sensor-mass"),
    *("suspension", "record-gain", "gain", "channel-delay"),
)
PLACES = (12, 20, 30)
LENGTH, WIDTH, THICKNESS, MASS_PER_AREA = (0.5, 1.3), (0.3, 0.9), (0.010, 0.040), (3.0, 9.0)
E_X, E_Y, NU, G_XY = (0.5e10, 2e10), (0.6, 1.1), (0.25, 0.45), (0.3, 0.45)  # E_y, G_xy over E_x
G_ZX, G_YZ = (1e8, 6e8), (0.45, 0.8)  # G_yz over G_zx
DAMPING = (0.002, 0.01)
NOISE = (1e-3, 5e-3)
HITS = 3
IN_BAND = (20, 40)  # flexible modes
BANDS = (315.0, 400.0, 500.0, 630.0, 800.0, 1000.0, 1250.0, 1600.0, 2000.0, 2500.0, 3150.0, 4000.0, 5000.0)  # Hz
SAMPLES = 16384
CONTACT = (0.3, 0.5)  # of 1/band: the pulse's spectrum falls by 1 to 4 dB over the band
EDGE = 0.012  # m: no place lies nearer to an edge
APART = 0.1  # m between sensor and hammer: a point force on a plate has no finite answer under itself
FOOT = 0.012  # m: the side of what a mass stands on
# How a real panel differs, and a real test.
WANDER = 0.03  # rms of the core's shear stiffness over the panel
ALIKE_OVER = (0.08, 0.4)  # m: what lies nearer is alike
SHARE = (1e-4, 3e-3)  # of a frequency, standard deviation over a test's modes
RESIDUE = 3e-3  # of each residue, of itself
MARK, HIT = 1.2e-3, 0.9e-3  # m, along x and along y: a record's place beside its mark, each hit beside that: together 1.5 mm
SENSOR = 0.3e-3  # m, along x and along y
GAIN = 3e-3  # of each record
TRIES = 200
# What moves frequencies, and is drawn until it shows in a real panel; the others of these ranges all do.
BY_FREQUENCIES = ("local-mass", "sensor-mass", "stiffness-loss")
PLAIN, HARD = 8.0, 0.15  # standard deviations that it moves them by; the part of the tests where it moves them by less
DRAWS = 40


@dataclass(frozen=True)
class Case:
    """A test of a whole panel to make."""

    kind: str
    places: int
    real: bool
    analysed: bool = False

    @property
    def effects(self):
        """The effects in it, by their ids."""
        return () if self.kind == "none" else (self.kind,)

    @property
    def rough(self):
        """Whether places and gains are off by themselves."""
        return self.real


@dataclass
class WholeBench:
    """What is true of a test, as `bench.Bench` has it of a strip: `forces` (places, 2), `response` (2) and `suspension` are places
    (x, y) [m], `off` (places, hits, 2) and `response_off` (2) what they are missed by; `attachments` are pairs (Foot, Z(s))."""

    structure: ClassVar[str] = "mindlin-plate"
    across: ClassVar[None] = None
    restoring: ClassVar[None] = None
    saturation: ClassVar[None] = None
    window: ClassVar[None] = None
    hum: ClassVar[float] = 0.0
    declared: ClassVar[tuple] = ()
    unit: ClassVar[str] = "m/s2"

    panel: WholePanel
    zeta: np.ndarray
    forces: np.ndarray
    response: np.ndarray
    suspension: tuple
    hits: int
    noise: float
    sampling: Sampling
    contact: tuple
    attachments: list = field(default_factory=list)
    chain: list = field(default_factory=list)
    gain: float = 1.0
    own: tuple | None = None
    core: Callable | None = None

    def __post_init__(self):
        self.record_gain = np.ones(len(self.forces))
        self.off = np.zeros((len(self.forces), self.hits, 2))
        self.response_off = np.zeros(2)

    def struck(self):
        """Where the hammer truly falls (places, hits, 2), m."""
        return self.forces[:, None] + self.off

    def sensed(self):
        """Where the sensor truly sits (2), m."""
        return self.response + self.response_off

    def constants(self):
        """Those that the panel has in the mean."""
        return self.panel.constants | {"shear_coefficient": SHEAR_COEFFICIENT}

    def motion(self, s, blows):
        """The acceleration's transform (hits, lines) where the sensor sits."""
        hits = np.column_stack([np.repeat(np.arange(len(self.forces)), self.hits), self.struck().reshape(-1, 2)])
        spots, of = np.unique(hits, axis=0, return_inverse=True)
        fixed = [foot for foot, _ in self.attachments]
        sensor = Foot(*self.sensed())
        # A sensor that is fixed with its mass moves as its foot does.
        sensor = next((foot for foot in fixed if (foot.x, foot.y) == (sensor.x, sensor.y)), sensor)
        feet = list(dict.fromkeys([sensor, *fixed]))
        if self.core is None:
            modes = solve(self.panel, spots[:, 1:], feet, self.zeta)
        else:
            modes = relaxing(self.panel, spots[:, 1:], feet, self.zeta, self.core, self.sampling)
        if self.own is not None:
            shares, factors = self.own
            share, factor = np.zeros(len(modes)), np.ones((len(modes), modes.points))
            rigid = self.panel.rigid
            own = slice(rigid, min(rigid + len(shares), len(modes)))
            share[own] = shares[: own.stop - rigid]
            factor[own, : len(spots)] = factors[: own.stop - rigid, spots[:, 0].astype(int)]
            modes = modes.of_its_own(share, factor)
        index = lambda foot: len(spots) + feet.index(foot)  # noqa: E731
        bare = lambda rows, columns: modes.receptance(s, rows, columns)  # noqa: E731
        at, stiffnesses = [index(foot) for foot in fixed], [stiffness for _, stiffness in self.attachments]
        answer = attachments.coupled(bare, s, [index(sensor)], list(range(len(spots))), at, stiffnesses)[:, 0].T
        return answer[of.ravel()] * blows * s**2


def cases(name, count):
    """`count` rounds of KINDS, with numbers of places that go round beside them."""
    if name not in SETS:
        raise ValueError(f'set "{name}": one of {", ".join(SETS)}')
    return [Case(KINDS[i % len(KINDS)], PLACES[(i + i // len(KINDS)) % 3], name == "whole-real") for i in range(count * len(KINDS))]


def build(case, random):
    """The bench of a case, its effects with their parameters, and what else is true of it."""
    bench, modes_in_band = _draw(case.places, random)
    hung = case.kind == "suspension" or random.random() < 0.5
    bench.suspension = _strings(bench.panel, random) if hung else ()
    told = {"group": "one" if case.effects else "none", "modes_in_band": modes_in_band, "places": case.places}
    even = bench.panel
    if case.real:
        told |= _real(bench, random)
    if case.real and case.kind in BY_FREQUENCIES:
        bench, parameters, told["amplitude"] = _shown(bench, even, case.kind, told, random)
        told["hard"] = told["amplitude"] < PLAIN
        effects = [{"id": case.kind, "parameters": parameters}]
    else:
        effects = [{"id": name, "parameters": EFFECTS[name](bench, Draw(random))} for name in case.effects]
    panel = bench.panel
    told["piece"] = {name: getattr(panel, name) for name in ("length", "width", "thickness", "mass_per_area")}
    told |= {"force_at": bench.forces.tolist(), "response_at": bench.response.tolist(), "sensed_at": bench.sensed().tolist()}
    told |= {"suspension_at": [list(at) for at in bench.suspension], "foot_m": FOOT}
    return bench, effects, told


def _draw(places, random):
    """A panel and its places, with nothing in it, and how many flexible modes its band holds."""
    even = lambda bounds: float(random.uniform(*bounds))  # noqa: E731
    rising = lambda bounds: float(np.exp(random.uniform(*np.log(bounds))))  # noqa: E731
    for _ in range(TRIES):
        e_x, g_zx = rising(E_X), rising(G_ZX)
        panel = WholePanel(
            *(round(even(bounds), 3) for bounds in (LENGTH, WIDTH, THICKNESS)),
            round(even(MASS_PER_AREA), 3),
            *(e_x, e_x * even(E_Y), even(NU), e_x * even(G_XY), g_zx * even(G_YZ), g_zx),
        )
        # Coarse elements: 1e-3 off at mode 40, which moves hardly a mode across a band's end.
        counts = np.searchsorted(frequencies(panel, IN_BAND[1] + 8, degree=5, element=0.25), BANDS)
        fitting = [i for i, count in enumerate(counts) if IN_BAND[0] <= count <= IN_BAND[1]]
        if fitting:
            break
    else:
        raise ValueError(f"none of {TRIES} panels has {IN_BAND[0]} to {IN_BAND[1]} modes in a band up to {BANDS[-1]:g} Hz")
    which = fitting[random.integers(len(fitting))]
    band = BANDS[which]
    response = _corner(panel, random)
    forces = _spread(panel, response, places, random)
    contact = tuple(part / band for part in CONTACT)
    zeta = np.exp(random.uniform(*np.log(DAMPING), FLEXIBLE))
    bench = WholeBench(panel, zeta, forces, response, (), HITS, rising(NOISE), Sampling(2.56 * band, SAMPLES), contact)
    return bench, int(counts[which])


def _corner(panel, random):
    """A sensor near one of the corners: 6 to 16 % of the sides from it."""
    sides = np.array([panel.length, panel.width])
    at = random.choice([-1.0, 1.0], 2) * sides * (0.5 - random.uniform(0.06, 0.16, 2))
    return _on_grid(np.clip(at, EDGE - sides / 2.0, sides / 2.0 - EDGE))


def _spread(panel, response, count, random):
    """Hammer places over the panel, each the farthest from the others of a few random ones (Mitchell), in a tester's order: by
    columns, rows up."""
    half = np.array([panel.length, panel.width]) / 2.0 - EDGE
    places = []
    while len(places) < count:
        drawn = _on_grid(random.uniform(-half, half, (12, 2)))
        drawn = drawn[np.linalg.norm(drawn - response, axis=1) >= APART]
        if len(drawn):
            others = np.array([*places, response])
            nearest = np.min(np.linalg.norm(drawn[:, None] - others, axis=2), axis=1)
            places.append(drawn[np.argmax(nearest)])
    places = np.array(places)
    return places[np.lexsort((places[:, 1], np.floor(places[:, 0] / 0.15)))]


def _on_grid(places):
    """To the millimetre, as places are measured."""
    return np.round(np.asarray(places) / GRID) * GRID


def _strings(panel, random):
    """Four suspension points, mirrored in both axes."""
    x, y = (round(float(random.uniform(0.2, 0.4)) * side, 3) for side in (panel.length, panel.width))
    return tuple((a * x, b * y) for a in (-1.0, 1.0) for b in (-1.0, 1.0))


def _real(bench, random):
    """All that a real panel and a test by hand are off by, and what that is."""
    rising = lambda bounds: float(np.exp(random.uniform(*np.log(bounds))))  # noqa: E731
    reach, share = rising(ALIKE_OVER), rising(SHARE)
    bench.panel = replace(bench.panel, core=wandering(bench.panel, WANDER, reach, random))
    normal = random.standard_normal
    bench.off = MARK * normal((len(bench.forces), 1, 2)) + HIT * normal(bench.off.shape)
    bench.response_off = SENSOR * normal(2)
    bench.record_gain = 1.0 + GAIN * normal(len(bench.forces))
    shares = share * normal(FLEXIBLE)
    bench.own = shares, 1.0 + RESIDUE * normal((FLEXIBLE, len(bench.forces)))
    return {"wander": WANDER, "alike_over_m": reach, "share": share, "shares": shares.tolist()}


def _shown(bench, even, name, told, random):
    """The bench with an effect, its parameters and how plainly it shows: PLAIN or more, below that in HARD of the tests and where none of
    DRAWS is that plain, of which it is then the plainest."""
    hard, seen, best = random.random() < HARD, Seen(even, bench.panel, told["share"], told["modes_in_band"]), None
    for _ in range(DRAWS):
        tried = copy(bench)
        tried.attachments = []
        parameters = EFFECTS[name](tried, Draw(random))
        masses = [(foot, parameters["mass"]) for foot, _ in tried.attachments]
        amplitude = seen.amplitude(tried.panel, masses)
        if best is None or (amplitude > best[2]) != hard:
            best = tried, parameters, amplitude
        if (best[2] < PLAIN) == hard:
            break
    return best


def wandering(panel, size, reach, random):
    """1 and a smooth random field over the panel: mean 0 and rms `size`, a correlation of exp(-(d/reach)^2/2) any way."""
    turns, phase = random.standard_normal((2, 64)) / reach, random.uniform(0.0, 2.0 * np.pi, 64)
    wave = lambda x, y: sum(np.cos(a * x + b * y + p) for a, b, p in zip(*turns, phase))  # noqa: E731
    x, y = (np.linspace(-side / 2.0, side / 2.0, 81) for side in (panel.length, panel.width))
    field_ = wave(x[:, None], y[None, :])
    mean, rms = float(np.mean(field_)), float(np.std(field_))
    return lambda x, y: 1.0 + size * (wave(x, y) - mean) / rms


def _somewhere(bench, draw, from_edges):
    """A place on the panel, at least so far from its edges."""
    return tuple(round(draw.even(-1.0, 1.0) * (side / 2.0 - from_edges), 3) for side in (bench.panel.length, bench.panel.width))


def _local_mass(bench, draw):
    mass, (x, y) = draw.rising(20e-3, 150e-3), _somewhere(bench, draw, EDGE)
    bench.attachments.append((Foot(x, y, FOOT), attachments.mass(mass)))
    return {"mass": mass, "x": x, "y": y}


def _sensor_mass(bench, draw):
    mass = draw.rising(3e-3, 25e-3)
    bench.attachments.append((Foot(*bench.sensed(), FOOT), attachments.mass(mass)))
    return {"mass": mass}


def _stiffness_loss(bench, draw):
    loss, span = draw.rising(0.3, 0.8), draw.rising(0.06, 0.16)
    x, y = _somewhere(bench, draw, span / 2.0)
    bench.panel = disbonded(bench.panel, loss, span, x, y)
    return {"loss": loss, "span": span, "x": x, "y": y}


def disbonded(panel, loss, span, x, y):
    """A panel with a disbond under a square of the faces."""
    before = panel.core or (lambda x, y: 1.0)
    sides = [(at - span / 2.0, at + span / 2.0) for at in (x, y)]

    def weakened(x, y):
        inside = (x > sides[0][0]) & (x < sides[0][1]) & (y > sides[1][0]) & (y < sides[1][1])
        return before(x, y) * np.where(inside, 1.0 - loss, 1.0)

    return replace(panel, core=weakened, lines_x=sides[0], lines_y=sides[1])


def _suspension(bench, draw):
    """Springs and dashpots at the points. A spring's point needs no foot: under 20 kN/m a plate gives way by a few thousandths more
    where its mesh is finer."""
    stiffness, damping = draw.rising(500.0, 2e4), draw.rising(0.5, 20.0)
    bench.attachments += [(Foot(x, y), attachments.spring(stiffness, damping)) for x, y in bench.suspension]
    return {"stiffness": stiffness, "damping": damping}


def _record_gain(bench, draw):
    record, gain = int(draw.random.integers(len(bench.forces))), 1.0 + draw.sign() * draw.rising(0.08, 0.2)
    bench.record_gain[record] *= gain
    return {"gain": gain, "record": record}


def _gain(bench, draw):
    bench.gain = 1.0 + draw.sign() * draw.rising(0.04, 0.2)
    return {"gain": bench.gain}


def _channel_delay(bench, draw):
    delay = draw.rising(5e-6, 1e-4)
    bench.chain.append(lambda s: np.exp(-s * delay))
    return {"delay": delay}


def _support_compliance(bench, draw):
    """Springs along the left edge, over the whole of it: some 0.3 to 10 % of the first frequency of a panel that is clamped there."""
    panel = bench.panel
    bending = panel.e_x * panel.thickness**3 * panel.width / 12.0
    rotation = bending / panel.length * draw.falling(8.0, 300.0)
    translation = bending / panel.length**3 * draw.falling(300.0, 3e4)
    bench.panel = replace(panel, left=(translation, rotation))
    return {"rotation": rotation, "translation": translation}


def _edge_mass(bench, draw):
    """Along front and back alone: a beam's tests have those of its ends."""
    mass = draw.rising(2e-3, 20e-3)
    bench.panel = replace(bench.panel, edge_mass=mass)
    return {"mass": 0.0, "mass_y": mass}


EFFECTS = {
    "local-mass": _local_mass,
    "sensor-mass": _sensor_mass,
    "stiffness-loss": _stiffness_loss,
    "suspension": _suspension,
    "record-gain": _record_gain,
    "gain": _gain,
    "channel-delay": _channel_delay,
    "support-compliance": _support_compliance,
    "edge-mass": _edge_mass,
    "viscoelastic-core": catalogue.viscoelastic_core,
}
