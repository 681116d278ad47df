"""Which tests stand in which set, and how each is drawn from its seed."""

from dataclasses import dataclass

import numpy as np

from . import bench as benches
from . import real, whole
from .catalogue import CANTILEVER, EFFECTS, FURTHER, LISTED, NOT_ANALYSED, NOT_SINGLE, PAIRS
from .draw import Draw
from .outside import OUTSIDE

SETS = ("clean", "rough", "rough-none", "single-place", "none", "pairs", "outside", "lists", "accelerances", "further", "real", *whole.SETS)
HIT_SPREAD = 0.7e-3  # m, of each hit about its place (rough)
GAIN_SPREAD = 3e-3  # of each record's gain (rough)
CORE_SPREAD = 5e-3  # rms of the core's shear stiffness along the piece (rough)


@dataclass(frozen=True)
class Case:
    """A test to make: the name of its kind and what is in it."""

    kind: str
    effects: tuple
    places: str = "roving"
    rough: bool = False
    cantilever: bool = False
    analysed: bool = False  # only accelerances are kept of the hits
    further: bool = False  # with what the catalogue keeps unless it pays


def cases(name, count, seed=0):
    """The cases of a set, `count` of each kind; of the set `real`, whose kinds are drawn by `seed`, `count` in all."""
    if name == "real":
        return real.cases(count, seed)
    if name in whole.SETS:
        return whole.cases(name, count)
    if name in ("clean", "rough"):
        kinds = [Case(e, (e,), rough=name == "rough", cantilever=e in CANTILEVER) for e in EFFECTS]
    elif name == "single-place":
        kinds = [Case(e, (e,), "single", cantilever=e in CANTILEVER) for e in EFFECTS if e not in NOT_SINGLE]
    elif name == "none":
        kinds = [Case("none", ()), Case("none, one place", (), "single"), Case("none, clamped", (), cantilever=True)]
    elif name == "rough-none":
        kinds = [Case("none", (), rough=True)]
    elif name == "pairs":
        kinds = [Case(" + ".join(pair), pair) for pair in PAIRS]
    elif name == "outside":
        kinds = [Case(kind, (kind,)) for kind in OUTSIDE]
    elif name == "further":
        kinds = [Case(kind, (kind,), further=True) for kind in FURTHER]
    elif name == "lists":
        kinds = [Case(e, (e,), "list", cantilever=e in CANTILEVER) for e in LISTED]
        kinds += [Case("none", (), "list"), Case("none, clamped", (), "list", cantilever=True)]
    elif name == "accelerances":
        kinds = [Case(e, (e,), cantilever=e in CANTILEVER, analysed=True) for e in EFFECTS if e not in NOT_ANALYSED]
        kinds += [Case("none", (), analysed=True), Case("none, clamped", (), cantilever=True, analysed=True)]
    else:
        raise ValueError(f'set "{name}": one of {", ".join(SETS)}')
    return [case for _ in range(count) for case in kinds]


def build(case, random, sampling=None):
    """The bench of a case and its truth: a list of effects with their parameters, and what else is true of it."""
    if isinstance(case, real.Case):
        return real.build(case, random, sampling)
    if isinstance(case, whole.Case):
        return whole.build(case, random)
    bench = benches.draw(random, case.places, sampling, case.cantilever)
    truth = []
    for name in case.effects:
        change = FURTHER[name] if case.further else EFFECTS.get(name) or OUTSIDE[name]
        truth.append({"id": name, "parameters": change(bench, Draw(random, strong=len(case.effects) > 1))})
    if case.rough:
        roughen(bench, random)
    return bench, truth, {}


def roughen(bench, random):
    """What every test by hand has: hits beside their place, gains that differ, a core that is not even."""
    bench.off = bench.off + HIT_SPREAD * random.standard_normal(bench.off.shape)
    bench.record_gain = bench.record_gain * (1.0 + GAIN_SPREAD * random.standard_normal(len(bench.forces)))
    if bench.across is not None:
        return  # the plate is even: its core cannot vary here
    length, before = bench.panel.length, bench.panel.shear_along
    waves = random.standard_normal((2, 6))
    waves *= CORE_SPREAD / np.sqrt(np.sum(waves**2) / 2.0)

    def uneven(x):
        turns = 2.0 * np.pi * np.outer(x, np.arange(1, 7)) / length
        field = 1.0 + np.cos(turns) @ waves[0] + np.sin(turns) @ waves[1]
        return field * (before(x) if before else 1.0)

    bench.change_panel(shear_along=uneven)
