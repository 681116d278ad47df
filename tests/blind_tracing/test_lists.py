"""The lists of natural frequencies against closed forms and the exact transfer matrices, and what stands in a case's folder."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, newton

from . import attachments, beam, exact, judge, lists, make, sets
from . import bench as benches
from .test_structure import PIECE, SLENDER, loss_at

SEEN = (-0.31, 0.27)  # m: on no node of the modes below
TABLE = {
    "none": (PIECE, ()),
    "clamped": (replace(PIECE, left="clamped"), ()),
    "sensor mass": (PIECE, ((0.3, attachments.mass(0.02)),)),
    "missing mass": (PIECE, ((-0.111, attachments.mass(-0.02)),)),
    "edge mass": (PIECE, tuple((x, attachments.mass(0.06)) for x in (-0.4, 0.4))),
    "suspension": (PIECE, tuple((x, attachments.spring(4e4, 20.0)) for x in (-0.37, 0.37))),
    "stiffness loss": (replace(PIECE, shear_along=loss_at, steps=(0.05, 0.13)), ()),
    "resonator": (PIECE, ((0.07, attachments.resonator(0.03, 900.0, 0.05)),)),
    "low resonator": (PIECE, ((0.28, attachments.resonator(0.014, 205.0, 0.01)),)),
    "rotary inertia": (replace(PIECE, rotary=2.4), ()),
    "support": (replace(PIECE, left=(1e7, 1e5)), ()),
}


def a_bench(panel, attached=(), zeta=0.0):
    """A test of this panel with these things on it."""
    damping = np.full(benches.DAMPED, zeta)
    return benches.Bench(panel, damping, np.array([0.3]), 0.3, (), 1, 0.0, attachments=list(attached))


@pytest.mark.parametrize("name", TABLE)
def test_val_poles_are_the_exact_ones(name, monkeypatch):
    """Where the exact receptance has its poles, damped or not, within 2e-6: a five hundredth of the scatter. Each is looked for
    from the one found."""
    monkeypatch.setattr("blind_tracing.modes.BEYOND", 0.0)
    panel, attached = TABLE[name]
    found = lists.poles(lists.coupled(a_bench(panel, attached))[0])[0][::2]
    rigid = 2 if panel.left == "free" else 0
    assert len(found) >= rigid + lists.COUNT
    for pole in found[rigid : rigid + lists.COUNT]:
        inverse = lambda s: 1.0 / exact.receptance(panel, s, *SEEN, attached)  # noqa: E731
        pole = pole.real + 1.0j * abs(pole.imag)
        wanted = newton(inverse, pole * (1.0 + 1e-5), x1=pole * (1.0 - 1e-5), tol=1e-7 * abs(pole), maxiter=30)
        assert abs(pole - wanted) < 2e-6 * abs(pole), (pole, wanted)


@pytest.mark.parametrize("name", ["none", "resonator", "low resonator", "support"])
def test_val_no_natural_frequency_is_left_out(name):
    """Struck and seen at an end, which no mode leaves at rest, an undamped panel turns from + to - at each pole, and there alone."""
    panel, attached = TABLE[name]
    attached = tuple((x, replace(what, zeta=0.0)) for x, what in attached)
    frequency, end = np.arange(20.3, 6000.0), panel.length / 2.0
    sign = [exact.receptance(panel, 2.0j * np.pi * f, end, end, attached).real > 0.0 for f in frequency]
    turns = [(a, b) for a, b, before, after in zip(frequency, frequency[1:], sign, sign[1:]) if before and not after]
    found = lists.natural_frequencies(a_bench(panel, attached))
    found = found[found < frequency[-1]]
    assert len(turns) == len(found)
    assert all(low < f < high for f, (low, high) in zip(found, turns))


def test_val_a_cantilever_with_a_tip_mass_is_eulers():
    """1 + cosh cos = m z (sin cosh - cos sinh), m the tip mass over the beam's, modes 1 to 4 of a slender beam."""
    panel, ratio = replace(SLENDER, left="clamped"), 0.3
    # Over cosh, which else grows past all bounds.
    load = lambda z: ratio * z * (np.sin(z) - np.cos(z) * np.tanh(z))  # noqa: E731
    equation = lambda z: 1.0 / np.cosh(z) + np.cos(z) - load(z)  # noqa: E731
    grid = np.linspace(0.1, 12.0, 400)
    roots = [brentq(equation, a, b) for a, b in zip(grid, grid[1:]) if equation(a) * equation(b) < 0.0][:4]
    wanted = np.square(roots) * np.sqrt(panel.bending / panel.mass_per_length) / 2.0 / np.pi
    bench = a_bench(panel, ((panel.length / 2.0, attachments.mass(ratio * panel.mass)),))
    np.testing.assert_allclose(lists.natural_frequencies(bench, 4), wanted, rtol=4e-4)


def test_a_heavily_damped_suspension_keeps_the_numbering():
    """Motions as a whole that only creep back are two all the same; the flexible ones are as good as free."""
    free = lists.natural_frequencies(a_bench(PIECE))
    creeping = tuple((x, attachments.spring(500.0, 60.0)) for x in (-0.37, 0.37))
    np.testing.assert_allclose(lists.natural_frequencies(a_bench(PIECE, creeping)), free, rtol=2e-2)


def test_val_what_other_constants_undo_is_not_left_over():
    """A stiffer panel is no effect: its frequencies are met to rounding. A mass of 20 g is not undone."""
    stiffer = a_bench(replace(PIECE, e_x=1.3 * PIECE.e_x, g_zx=0.8 * PIECE.g_zx))
    assert lists.left_over(stiffer, a_bench(PIECE)) < 1e-6
    loaded = a_bench(PIECE, ((0.1, attachments.mass(0.02)),))
    assert lists.left_over(loaded, a_bench(PIECE)) > lists.VISIBLE * lists.SCATTER


def test_a_case_is_a_list_and_tells_nothing_else(tmp_path):
    """One file, ten frequencies with a permille of scatter about the true ones, the sensor's place; no truth in it."""
    make.make(tmp_path / "set", "lists", 1, 1000, only=["local-mass", "none, clamped"])
    truth = json.loads((tmp_path / "set" / "truth.json").read_text())
    for case in truth["cases"]:
        folder = tmp_path / "set" / case["case"]
        assert [path.name for path in folder.iterdir()] == ["test.toml"]
        given = tomllib.loads((folder / "test.toml").read_text())
        (told,) = given["measurement"]
        assert set(given) == {"piece", "measurement", "boundary" if case["kind"] == "none, clamped" else "suspension"}
        assert set(told) == {"kind", "values", "scatter", "response_at"}
        true, read = np.array(case["frequencies"]), np.array(told["values"])
        assert len(read) == 10
        np.testing.assert_allclose(told["scatter"], 1e-3 * read, rtol=1e-5)
        off = (read / true - 1.0) / 1e-3
        assert 0.3 < np.sqrt(np.mean(off**2)) < 2.0
        assert not case["effects"] or case["left_over_scatter"] >= 5.0


def test_a_place_counts_by_its_distance_from_the_middle():
    """A free piece turned round has the same frequencies; a clamped one has not."""
    truth = {"case": "case-000", "kind": "local-mass", "rough": False}
    truth["effects"] = [{"id": "local-mass", "parameters": {"x": -0.2}}]
    effects = [{"id": "local-mass", "parameters": {"x": {"value": 0.201, "std": 1e-3}}}]
    answer = {"verdict": "explained", "effects": effects, "alternatives": []}
    assert [judge.case(truth | {"mirrored": of}, answer)["inside"] for of in (True, False)] == [[True], [False]]


def test_a_list_with_an_effect_asks_for_a_name_and_one_without_for_silence():
    """Each counts in its own rate only."""
    loaded = {"case": "case-000", "kind": "edge-mass", "rough": False, "effects": [{"id": "edge-mass", "parameters": {}}]}
    bare = {"case": "case-001", "kind": "none", "rough": False, "effects": []}
    named = {"verdict": "ambiguous", "effects": [{"id": "local-mass"}], "alternatives": ["edge-mass"]}
    silent = {"verdict": "nothing-missing", "effects": [], "alternatives": []}
    rates = judge.summary("lists", [judge.case(loaded, named), judge.case(bare, silent)])["rates"][:2]
    assert [(rate["reached"], rate["of"]) for rate in rates] == [(1.0, 1), (1.0, 1)]
    wrong = judge.summary("lists", [judge.case(loaded, silent), judge.case(bare, named)])
    assert [rate["reached"] for rate in wrong["rates"][:2]] == [0.0, 0.0]
    assert all(case["faults"] for case in wrong["judged"])


def test_the_older_sets_keep_their_seeds():
    """A set's place in the list is in its seed: new sets stand at the end. A mass as it was drawn before lists were."""
    older = ("clean", "rough", "rough-none", "single-place", "none", "pairs", "outside")
    assert sets.SETS[: len(older)] == older
    _, truth, _ = sets.build(sets.cases("clean", 1)[0], np.random.default_rng([1000, 0, 0]))
    assert truth == [{"id": "sensor-mass", "parameters": {"mass": pytest.approx(0.01683754949376963, rel=1e-12)}}]
