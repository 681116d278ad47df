"""What a tester reads off an analyser and writes down: natural frequencies, and how far each may be off.

A natural frequency is the size of a pole, damping of panel, suspension and resonator included. The list is complete: whatever
resonates above the motions as a whole stands in it, a loose bracket's own resonance too. SI units.
"""

from copy import copy
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.linalg import eig
from scipy.optimize import least_squares

from . import bench as benches
from . import files
from .catalogue import EFFECTS, edge_mass, suspension
from .draw import Draw

COUNT = 10
SCATTER = 1e-3  # standard deviation of each frequency, of itself
VISIBLE = 5.0  # times the scatter: rms of what an effect moves and no other constants undo
TRIES = 2000
# Weaker ones never reach VISIBLE: heavy edge profiles, and blocks of foam.
WIDER = {"edge-mass": partial(edge_mass, most=80e-3), "suspension": partial(suspension, most=5e4)}
BLOCKS = (0.4, 0.48)  # of the length: where blocks of foam lie under the ends
NOT_SEEN = ("damping", "zeta")  # parameters that frequencies do not show
UNIT = 2.0 * np.pi * 1e3  # rad/s: keeps the numbers of the eigenproblem near one


def make_case(folder, case, random):
    """Write one case into `folder`; its truth."""
    bench, effects, left = draw(case, random)
    true = natural_frequencies(bench)
    read = np.sort(true * (1.0 + SCATTER * random.standard_normal(len(true))))
    folder.mkdir(parents=True)
    (folder / "test.toml").write_text(f"{files.piece_text(bench)}\n{_measurement(bench, read)}", encoding="utf-8")
    panel = bench.panel
    return {
        "case": folder.name,
        "kind": case.kind,
        "effects": effects,
        "rough": False,
        "mirrored": panel.left == "free",  # a piece turned round has the same frequencies
        "constants": bench.constants(),
        "frequencies": true.tolist(),
        "left_over_scatter": left / SCATTER,
    }


def draw(case, random):
    """A bench, what it holds, and what of it no constants undo (relative rms); drawn anew until that is VISIBLE."""
    for _ in range(TRIES):
        bare = benches.draw(random, "single", cantilever=case.cantilever)
        if bare.suspension and random.random() < 0.5:
            x = round(random.uniform(*BLOCKS) * bare.panel.length, 3)
            bare.suspension = (-x, x)
        bench, effects = copy(bare), []
        bench.attachments = []
        for name in case.effects:
            drawn = (WIDER.get(name) or EFFECTS[name])(bench, Draw(random))
            shown = {key: value for key, value in drawn.items() if key not in NOT_SEEN}
            effects.append({"id": name, "parameters": shown, "all": drawn})
        if not effects:
            return bench, effects, 0.0
        left = left_over(bench, bare, enough=VISIBLE * SCATTER)
        if left >= VISIBLE * SCATTER:
            return bench, effects, left
    raise ValueError(f"{case.kind}: nothing of {TRIES} draws moves the frequencies by {VISIBLE:g} times their scatter")


def _measurement(bench, read):
    """The list as the tester writes it."""
    values, scatter = (", ".join(f"{number:.6g}" for number in column) for column in (read, SCATTER * read))
    return (
        f'[[measurement]]\nkind = "natural-frequencies"\nvalues = [{values}]\nscatter = [{scatter}]\n'
        f"response_at = [{bench.response:.4g}, 0.0]\n"
    )


def coupled(bench, places=()):
    """Mass, damping and stiffness of the panel's modes with what is fixed to it, and the row of each place and of the sensor."""
    points = np.unique(np.round([bench.sensed(), *places, *(x for x, _ in bench.attachments)], 9))
    at = {x: i for i, x in enumerate(points)}
    modes = bench.modes(points)
    fixed = [(modes.shape[:, at[np.round(x, 9)]], what.matrices()) for x, what in bench.attachments]
    count, size = len(modes.omega), len(modes.omega) + sum(len(parts[0]) - 1 for _, parts in fixed)
    whole = np.zeros((3, size, size))
    for part, diagonal in zip(whole, (np.ones(count), 2.0 * modes.zeta * modes.omega, modes.omega**2)):
        part[:count, :count] = np.diag(diagonal)
    last = count
    for shape, parts in fixed:
        own = len(parts[0]) - 1
        seen = np.zeros((1 + own, size))
        seen[0, :count] = shape
        seen[1:, last : last + own] = np.eye(own)
        whole += seen.T @ parts @ seen
        last += own
    rows = np.zeros((1 + len(places), size))
    rows[:, :count] = modes.shape[:, [at[x] for x in np.round([*places, bench.sensed()], 9)]].T
    return whole, rows


def poles(matrices):
    """All poles [1/s] of mass, damping and stiffness, by size, and the vector of each."""
    mass, damping, stiffness = matrices
    solved = np.linalg.solve(mass, np.hstack([stiffness / UNIT**2, damping / UNIT]))
    top = np.hstack([np.zeros_like(mass), np.eye(len(mass))])
    found, vectors = eig(np.vstack([top, -solved]))
    order = np.argsort(np.abs(found))
    return UNIT * found[order], vectors[: len(mass), order]


def natural_frequencies(bench, count=COUNT):
    """The first `count` [Hz] above the motions of the panel as a whole, to which a suspension gives frequencies of their own."""
    rigid = 2 if bench.panel.left == "free" else 0
    # A pole and its conjugate, or two real ones, are one motion.
    return np.abs(poles(coupled(bench)[0])[0][::2][rigid : rigid + count]) / (2.0 * np.pi)


def left_over(bench, bare, enough=0.0):
    """Relative rms by which the frequencies of `bench` miss those of `bare` at the best constants; a bound above it, at once, where
    it is less than `enough` with the constants as they are."""
    wanted = natural_frequencies(bench)

    def missed(logarithms):
        e_x, g_zx = np.exp(logarithms) * (bare.panel.e_x, bare.panel.g_zx)
        tried = replace(bare.panel, e_x=e_x, g_zx=g_zx)
        return natural_frequencies(_with(bare, tried)) / wanted - 1.0

    as_they_are = float(np.sqrt(np.mean(missed([0.0, 0.0]) ** 2)))
    if as_they_are < enough:
        return as_they_are
    found = least_squares(missed, [0.0, 0.0], method="lm", diff_step=1e-4, xtol=1e-6, ftol=1e-6)
    return float(np.sqrt(np.mean(found.fun**2)))


def _with(bench, panel):
    """The same bench with another panel."""
    other = copy(bench)
    other.panel = panel
    return other
