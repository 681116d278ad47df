"""Panels as real ones are: uneven, hung on cords, each mode a little off, each hit beside its mark."""

from copy import deepcopy
from dataclasses import dataclass

import numpy as np

from . import bench as benches
from . import visible
from .attachments import mass
from .beam import Panel
from .catalogue import CANTILEVER, EFFECTS, PAIRS
from .draw import Draw
from .outside import OUTSIDE

# In this order again and again: an even share of each group among any number of cases.
GROUPS = (
    *("none", "one", "two", "one", "none", "one", "two", "one", "hung", "one"),
    *("none", "one", "two", "one", "none", "one", "two", "one", "outside", "outside"),
)
HARD = 0.15  # of the tests of one effect: one that barely shows
PLAIN = 8.0  # standard deviations that an effect moves a test by
BARE = 3.0  # the same of a hard one
TRIES = 500
PLACES = 9
HITS = (3, 5)
NOISE = (1e-3, 5e-3)
SHEAR = (1e-2, 4e-2)  # rms along the panel; that of bending stiffness and mass are parts of it
BENDING, MASS = (0.2, 0.5), (0.1, 0.3)
ALIKE_OVER = (0.04, 0.3)  # m: what lies nearer is alike
SHARE = (1e-4, 3e-3)  # of a frequency, standard deviation over a test's modes
RESIDUE, QUADRATURE = 3e-3, 1e-3  # standard deviations of each residue, of itself
MARK, HIT = 0.8e-3, 0.6e-3  # m: a record's place beside its mark, each hit beside that: together 1 mm
SENSOR = 0.3e-3  # m
GAIN = 3e-3
CORDS = (200.0, 5000.0)  # N/m each: motions on them of 3 to 25 Hz
HANGING = (0.02, 0.08)  # damping ratios of these
OWN = 40  # modes that are off
FIELDS = ("shear_along", "bending_along", "mass_along")
# What records tell but the modes of a beam do not: the stronger part of the range in place of an amplitude.
BY_RANGE = ("suspension", "resonator", "viscoelastic-core", "width-coupling", "cubic-stiffness", "high-pass", "exponential-window")
UNHUNG = ("viscoelastic-core", "width-coupling", "cubic-stiffness", "tension", "dry-friction", "softening-core")


@dataclass(frozen=True)
class Case:
    """A real test to make."""

    kind: str
    group: str
    effects: tuple = ()
    clamped: bool = False
    places: str = "real"
    analysed: bool = False
    rough: bool = False


def cases(count, seed):
    """`count` cases: groups in the order of GROUPS, kinds of a group each as often as another."""
    kinds = {
        "none": [Case("none", "none"), Case("none", "none"), Case("none, clamped", "none", clamped=True)],
        "one": [Case(name, "one", (name,), name in CANTILEVER) for name in EFFECTS],
        "two": [Case(" + ".join(pair), "two", pair) for pair in PAIRS],
        "outside": [Case(name, "outside", (name,)) for name in OUTSIDE],
        "hung": [Case("hung strip", "hung", ("sensor-mass", "suspension")), Case("hung strip, cords told", "hung", ("sensor-mass",))],
    }
    random, drawn = np.random.default_rng(seed), {group: [] for group in kinds}
    wanted = []
    for group in (GROUPS[i % len(GROUPS)] for i in range(count)):
        if not drawn[group]:
            drawn[group] = [kinds[group][i] for i in random.permutation(len(kinds[group]))]
        wanted.append(drawn[group].pop())
    return wanted


def build(case, random, sampling=None):
    """The bench of a case, its effects with their parameters, and what else is true of it."""
    if case.group == "hung":
        return _hung_strip(case, random, sampling)
    hard = case.group == "one" and random.random() < HARD
    for _ in range(TRIES):
        bare = _draw(case, random, sampling)
        uneven, told = _uneven(bare, random)
        seeds, amplitudes = random.integers(2**31, size=len(case.effects)), []
        for name, seed in zip(case.effects, seeds):
            if name in EFFECTS and name not in BY_RANGE:
                bench = deepcopy(bare)
                EFFECTS[name](bench, Draw(np.random.default_rng(seed)))
                amplitudes.append(visible.amplitude(bench, bare, uneven, told["share"]))
        if all(BARE <= one < PLAIN if hard else one >= PLAIN for one in amplitudes):
            break
    else:
        raise ValueError(f"{case.kind}: none of {TRIES} draws shows as it should")
    return _finish(case, uneven, seeds, hard, random, told | {"group": case.group, "hard": hard, "amplitudes": amplitudes})


def _draw(case, random, sampling):
    """A piece and its places, with nothing in it: one to nine places, and a sensor towards one end."""
    bench = benches.draw(random, "single", sampling, case.clamped)
    length, count = bench.panel.length, int(random.integers(1, PLACES + 1))
    if "record-gain" in case.effects:
        count = max(count, 2)  # with one record, one record's gain is the gain
    first, last = (-0.38, 0.48) if case.clamped else (-0.48, 0.48)
    apart = (last - first) / count
    forces = first + apart * (np.arange(count) + random.uniform(0.1, 0.9, count))
    on_grid = lambda part: np.round(part * length / benches.GRID) * benches.GRID  # noqa: E731
    side = 1.0 if case.clamped else random.choice([-1.0, 1.0])
    response = float(on_grid(side * random.uniform(0.3, 0.47)))
    forces = on_grid(forces)
    if count > 1 and random.random() < 0.5:
        forces[np.argmin(np.abs(forces - response))] = response  # the driving point
    noise = float(np.exp(random.uniform(*np.log(NOISE))))
    hits = int(random.integers(HITS[0], HITS[1] + 1))
    return benches.Bench(bench.panel, bench.zeta, forces, response, bench.suspension, hits, noise, bench.sampling)


def _uneven(bare, random):
    """The bench on an uneven panel, and what that is."""
    sizes = float(np.exp(random.uniform(*np.log(SHEAR)))) * np.array([1.0, random.uniform(*BENDING), random.uniform(*MASS)])
    reach = float(np.exp(random.uniform(*np.log(ALIKE_OVER))))
    share = float(np.exp(random.uniform(*np.log(SHARE))))
    bench = deepcopy(bare)
    fields = {name: wandering(bare.panel.length, size, reach, random) for name, size in zip(FIELDS, sizes)}
    bench.change_panel(**fields)
    return bench, {"wander": dict(zip(FIELDS, sizes.tolist())), "alike_over_m": reach, "share": share}


def wandering(length, size, reach, random):
    """1 and a smooth random field along the panel: mean 0 and rms `size` over it, a correlation of exp(-(d/reach)^2/2)."""
    turns, phase = random.standard_normal(64) / reach, random.uniform(0.0, 2.0 * np.pi, 64)
    wave = lambda x: np.sum(np.cos(np.multiply.outer(x, turns) + phase), axis=-1)  # noqa: E731
    along = wave(np.linspace(-length / 2.0, length / 2.0, 501))
    return lambda x: 1.0 + size * (wave(x) - np.mean(along)) / np.std(along)


def _finish(case, bench, seeds, hard, random, told):
    """Cords, what hits, gains and modes are off by, and the effects."""
    _beside(bench, random)
    if bench.suspension and not set(case.effects) & {*UNHUNG, "suspension"} and random.random() < 0.5:
        told["cords"] = _hang(bench, Draw(random))["stiffness"]
        bench.declared = ("suspension",)
    effects = []
    for name, seed in zip(case.effects, seeds):
        draw = Draw(np.random.default_rng(seed)) if name not in BY_RANGE else _Part(np.random.default_rng(seed), hard)
        change = _hang if name == "suspension" else EFFECTS.get(name) or OUTSIDE[name]
        effects.append({"id": name, "parameters": change(bench, draw)})
    if bench.across is not None:
        bench.change_panel(**dict.fromkeys(FIELDS))  # the plate is even
        told["wander"] = None
    _off_by_themselves(bench, told, random)
    return bench, effects, told


class _Part(Draw):
    """The weakest third of a range where the effect shall be hard to see, the others where not."""

    def __init__(self, random, hard):
        super().__init__(random)
        self.hard = hard

    def rising(self, low, high):
        third = np.exp(np.log(low) + np.log(high / low) / 3.0)
        return super().rising(low, third) if self.hard else super().rising(third, high)

    def falling(self, low, high):
        third = np.exp(np.log(high) - np.log(high / low) / 3.0)
        return super().falling(third, high) if self.hard else super().falling(low, third)


def _hang(bench, draw):
    """Cords at the suspension points, whose motions have damping ratios, not dashpots."""
    stiffness = draw.rising(*CORDS)
    bench.change_panel(cords=tuple((x, stiffness) for x in bench.suspension))
    bench.hanging = tuple(np.exp(draw.random.uniform(*np.log(HANGING), 2)))
    return {"stiffness": stiffness}


def _beside(bench, random):
    """Hits and sensor beside their marks, gains that differ."""
    bench.off = MARK * random.standard_normal((len(bench.forces), 1)) + HIT * random.standard_normal(bench.off.shape)
    bench.response_off = float(np.round(SENSOR * random.standard_normal() / benches.SPOT) * benches.SPOT)
    bench.record_gain = 1.0 + GAIN * random.standard_normal(len(bench.forces))


def _off_by_themselves(bench, told, random):
    """Each mode's frequency by a share of its own, each residue of each record by RESIDUE and QUADRATURE."""
    shares = told["share"] * random.standard_normal(OWN)
    residues = RESIDUE * random.standard_normal((OWN, len(bench.forces)))
    turned = QUADRATURE * random.standard_normal(residues.shape)
    bench.own = shares, 1.0 + residues + 1.0j * turned
    told["shares"], told["residues"] = shares.tolist(), residues.tolist()


def _hung_strip(case, random, sampling):
    """A narrow strip on two cords with an accelerometer of 4 g: even, its modes as they are, accelerations in g."""
    panel = Panel(0.6, 0.08, 0.02, 5.1, 1.05e10, 4.0e8)  # k' G of 3.2e8 Pa at a shear coefficient of 5/6
    zeta = np.exp(random.uniform(*np.log((4e-3, 9e-3)), benches.DAMPED))
    forces = np.array([-0.27, -0.18, -0.09, 0.0, 0.09, 0.18, 0.27])
    bench = benches.Bench(panel, zeta, forces, 0.27, (-0.165, 0.165), 5, 3e-3, sampling or benches.Sampling())
    bench.change_panel(cords=((-0.165, 150.0), (0.165, 150.0)))
    bench.hanging, bench.unit = (0.05, 0.05), "g"
    bench.attachments.append((0.27, mass(4e-3)))
    known = {"sensor-mass": {"mass": 4e-3}, "suspension": {"stiffness": 150.0}}
    effects = [{"id": name, "parameters": known[name]} for name in case.effects]
    if "suspension" not in case.effects:
        bench.declared = ("suspension",)
    return bench, effects, {"group": "hung", "hard": False, "amplitudes": [], "cords": 150.0}
