"""The whole panel's plate against Navier's solution, published frequencies and finer meshes; its tests as they are played."""

import json
import os
import re
import subprocess
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import pyuff
import scipy.sparse as sparse
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from . import attachments, beam, files, plate, records, sets, whole, whole_plate, whole_visible
from .contour import Sampling, half_sine
from .draw import Draw
from .whole_plate import CONSTANTS, Foot, Mesh, WholePanel

ORTHOPANEL = os.environ.get("ORTHOPANEL")
PANEL = WholePanel(1.1, 0.7, 0.02, 5.0, 1.0e10, 8.0e9, 0.31, 3.7e9, 2.0e8, 3.5e8)
SMALL = replace(PANEL, length=0.5, width=0.35)
COARSE = {"degree": 6, "element": 0.12}
NO_DAMPING = np.zeros(whole_plate.FLEXIBLE)


def square_of(panel, **mesh):
    """omega^2 of a panel whose core a test changes, rising."""
    return (2.0 * np.pi * whole_plate.frequencies(panel, 20, **mesh)) ** 2


def navier(panel, count):
    r"""Frequencies [Hz] of the panel on hard simple supports: w = sin sin, psi_x = cos sin, psi_y = sin cos, each pair of half waves a
    matrix of 3 x 3 of its own, which all six constants enter in closed form."""
    law = panel.thickness**3 / 12.0 / (1.0 - panel.nu_xy**2 * panel.e_y / panel.e_x)
    d11, d22, d12, d66 = panel.e_x * law, panel.e_y * law, panel.nu_xy * panel.e_y * law, panel.g_xy * panel.thickness**3 / 12.0
    a55, a44 = 2.0 / 3.0 * panel.g_zx * panel.thickness, 2.0 / 3.0 * panel.g_yz * panel.thickness
    turning = panel.mass_per_area * panel.thickness**2 / 12.0
    found = []
    for m in range(1, 16):
        for n in range(1, 16):
            a, b = m * np.pi / panel.length, n * np.pi / panel.width
            stiffness = [
                [a55 * a**2 + a44 * b**2, a55 * a, a44 * b],
                [a55 * a, d11 * a**2 + d66 * b**2 + a55, (d12 + d66) * a * b],
                [a44 * b, (d12 + d66) * a * b, d22 * b**2 + d66 * a**2 + a44],
            ]
            found += list(eigh(stiffness, np.diag([panel.mass_per_area, turning, turning]), eigvals_only=True))
    return np.sqrt(np.sort(found)[:count]) / 2.0 / np.pi


def test_val_all_six_constants_act_as_in_naviers_solution():
    """Simply supported, 30 modes, to 1e-6; free edges need what is between the edges and nothing more."""
    mesh = Mesh(PANEL, element=0.2)
    x, y = np.divmod(np.arange(mesh.nodes_x * mesh.nodes_y), mesh.nodes_y)
    at_x, at_y = (x == 0) | (x == mesh.nodes_x - 1), (y == 0) | (y == mesh.nodes_y - 1)
    held = np.stack([at_x | at_y, at_y, at_x], axis=1).ravel()
    free = np.flatnonzero(~held)
    stiffness, mass = (part[free][:, free] for part in (mesh.stiffness, mesh.mass))
    square = np.sort(eigsh(stiffness, k=30, M=mass, sigma=0.0, return_eigenvectors=False))
    np.testing.assert_allclose(np.sqrt(square) / 2.0 / np.pi, navier(PANEL, 30), rtol=1e-6)


def test_val_a_thin_free_square_plate_is_the_published_one():
    """NAFEMS R0015, test FV12: 10 m square, 0.05 m thick: 1.622, 2.360, 2.922 Hz, given to 1e-3 Hz; and Barton's (J. Appl. Mech. 18,
    1951) omega a^2 (rho t / D)^(1/2) by a series of beam functions, which is an upper bound, some 1 % high. Here at a tenth of the size.
    The reference bends and does not shear: G through the thickness 300-fold."""
    shear = 2e11 / 2.6
    panel = WholePanel(1.0, 1.0, 0.005, 40.0, 2e11, 2e11, 0.3, shear, 300.0 * shear, 300.0 * shear)
    found = whole_plate.frequencies(panel, 5)
    np.testing.assert_allclose(found[:3], [16.22, 23.60, 29.22], atol=1e-2)
    bending = 2e11 * panel.thickness**3 / 12.0 / (1.0 - 0.3**2)
    bound = np.array([13.49, 19.79, 24.43, 35.02, 35.02])
    over = found * 2.0 * np.pi * np.sqrt(panel.mass_per_area / bending) / bound
    assert np.all((over < 1.0) & (over > 0.985)), over


def test_val_another_basis_has_the_same_modes(monkeypatch):
    """`plate`: elements along, Legendre's polynomials across, the motions that are even in y. Each of its modes up to that of number 40
    is one of these."""
    monkeypatch.setattr(plate, "CUT", 2500.0)
    strip = beam.Panel(PANEL.length, PANEL.width, PANEL.thickness, PANEL.mass_per_area, PANEL.e_x, PANEL.g_zx)
    across = plate.Across(PANEL.e_y, PANEL.nu_xy, PANEL.g_xy, PANEL.g_yz)
    other = plate.solve(strip, across, (0.1, 0.4), NO_DAMPING).omega[2:] / 2.0 / np.pi
    found = whole_plate.frequencies(PANEL, 40)
    other = other[other < found[-1]]
    assert len(other) > 15
    nearest = found[np.argmin(np.abs(found[:, None] - other), axis=0)]
    np.testing.assert_allclose(nearest, other, rtol=3e-6)


def test_a_core_that_is_stiffer_everywhere_is_one_of_greater_moduli():
    """And a patch over one half, with one over the other, is that too."""
    even = square_of(replace(SMALL, g_zx=0.6 * SMALL.g_zx, g_yz=0.6 * SMALL.g_yz), **COARSE)
    np.testing.assert_allclose(square_of(replace(SMALL, core=lambda x, y: 0.6), **COARSE), even, rtol=1e-9)
    halves = replace(SMALL, core=lambda x, y: np.where(x > 0.03, 0.6, 0.6) + 0.0 * y, lines_x=(0.03,))
    np.testing.assert_allclose(square_of(halves, **COARSE), even, rtol=1e-5)


def test_a_patch_has_converged():
    """Two degrees more move the frequencies by 1e-6 at most and what the modes are at a few places by 3e-4 of their rms."""
    bench = bench_of(SMALL)
    told = whole.EFFECTS["stiffness-loss"](bench, Draw(np.random.default_rng(3), strong=True))
    places = np.array([[-0.2, -0.1], [0.1, 0.1], [told["x"], told["y"]]])
    coarse, seen = {"element": 0.13, "flexible": 10}, []
    for degree in (whole_plate.DEGREE, whole_plate.DEGREE + 2):
        modes = whole_plate.solve(bench.panel, places, [Foot(0.21, 0.14)], NO_DAMPING, degree=degree, **coarse)
        seen.append((modes.omega[3:13], modes.shape[3:13]))
    sign = np.sign(np.sum(seen[0][1] * seen[1][1], axis=1))[:, None]
    np.testing.assert_allclose(seen[0][0], seen[1][0], rtol=1e-6)
    assert np.max(np.abs(seen[0][1] * sign - seen[1][1])) < 3e-4 * np.sqrt(np.mean(seen[1][1] ** 2))


def test_a_mass_by_receptances_is_one_in_the_mass_matrix():
    """Where the inner factor of the coupling passes through zero is a frequency of the panel whose mass matrix has the foot's mass in it:
    modes 1 to 8 of the loaded panel to 1e-6. Complete only if the upper modes' part at the foot itself is."""
    foot, mass = Foot(0.12, 0.05, whole.FOOT), 0.08
    mesh = Mesh(SMALL, [foot], degree=5)
    row = sparse.csr_matrix(mesh.deflection(foot))
    loaded = (mesh.mass + mass * row.T @ row).tocsc()
    wanted = np.sqrt(np.sort(eigsh(mesh.stiffness, k=11, M=loaded, sigma=-1e4, return_eigenvectors=False))[3:])
    modes = whole_plate.solve(SMALL, np.zeros((0, 2)), [foot], NO_DAMPING, flexible=40, degree=5)
    modes = replace(modes, zeta=np.zeros_like(modes.zeta))
    inner = lambda omega: 1.0 - mass * omega**2 * modes.receptance(1.0j * omega[..., None], [0], [0])[..., 0, 0, 0].real  # noqa: E731
    low, high = (np.array([inner(np.array(one)) for one in wanted * (1.0 + step)]) for step in (-1e-6, 1e-6))
    assert np.all(low * high < 0.0), (low, high)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_a_mass_on_a_plate_of_the_command_is_this_one(tmp_path):
    """Twelve modes of a model file's plate with a mass on its foot of 10 mm, to a tenth of what two millimetres more change."""
    x, y, mass = 0.12, 0.05, 0.03

    def loaded(side):
        mesh = Mesh(SMALL, [Foot(x, y, side)], degree=6)
        row = sparse.csr_matrix(mesh.deflection(Foot(x, y, side)))
        square = eigsh(mesh.stiffness, k=15, M=(mesh.mass + mass * row.T @ row).tocsc(), sigma=-1e4, return_eigenvectors=False)
        return np.sqrt(np.sort(square)[3:]) / 2.0 / np.pi

    model = tmp_path / "loaded.json"
    piece = {name: getattr(SMALL, name) for name in ("length", "width", "thickness", "mass_per_area")}
    fields = {"schema": "orthopanel.model/1", "piece": piece, "structure": "mindlin-plate", "constants": SMALL.constants}
    fields |= {"damping": {"beyond": 0.003}, "ports": {"forces": [[0.2, 0.1]], "responses": [[-0.2, 0.1]]}}
    effects = [{"id": "local-mass", "owner": "panel", "mass": mass, "x": x, "y": y}]
    model.write_text(json.dumps(fields | {"effects": effects}))
    told = subprocess.run([ORTHOPANEL, "modes", model, "--count", "18", "--json"], capture_output=True, check=True)
    found = np.array([mode["frequency_hz"] for mode in json.loads(told.stdout)["modes"]])[:12]
    exact, wider = loaded(0.010), loaded(0.012)
    assert np.max(wider / exact - 1.0) > 1e-5
    assert np.all(np.abs(found / exact - 1.0) < 0.1 * (wider / exact - 1.0) + 2e-7), (found / exact - 1.0, wider / exact - 1.0)


def test_a_spring_on_a_point_needs_no_foot():
    """A plate's compliance under a point grows with every finer mesh: by what moves the stiffest cord's answer by less than 1 %."""
    point = Foot(0.1, 0.08)
    seen = []
    for degree in (5, 9):
        modes = whole_plate.solve(SMALL, np.zeros((0, 2)), [point], NO_DAMPING, flexible=15, degree=degree, element=0.13)
        upper = modes.omega > modes.omega[12]
        seen.append(np.sum(modes.shape[upper, 0] ** 2 / modes.omega[upper] ** 2))
    assert 0.0 < (seen[1] - seen[0]) * 2e4 < 0.01


def test_more_modes_change_no_accelerance():
    """What modes above the kept ones do at the sensor is carried by pseudo-modes: half as many give the same accelerance up to a third of
    them, which is what a band holds at most."""
    places, sensor = np.array([[-0.2, -0.1], [0.1, 0.1]]), [Foot(0.21, 0.14)]
    answers, kept = [], 60
    for flexible in (kept, 2 * kept):
        modes = whole_plate.solve(SMALL, places, sensor, np.full(flexible, 0.005), flexible, **COARSE)
        s = 5.0 + 1.0j * np.linspace(100.0, modes.omega[3 + kept // 3], 1000)
        answers.append(modes.receptance(s, [2], [0, 1])[:, 0] * s[:, None] ** 2)
    size = np.maximum(np.abs(answers[1]), np.median(np.abs(answers[1]), axis=0))
    assert np.max(np.abs(answers[1] - answers[0]) / size) < 1e-4


def test_the_core_wanders_as_said():
    """Mean 1 and rms 3 % over the panel; what lies nearer than its reach is alike, what lies three times as far is not."""
    drawn = [whole.wandering(SMALL, whole.WANDER, 0.06, np.random.default_rng(seed)) for seed in range(40)]
    x, y = np.meshgrid(np.linspace(-0.25, 0.25, 101), np.linspace(-0.175, 0.175, 101), indexing="ij")
    fields = np.array([one(x, y) for one in drawn]) - 1.0
    assert np.max(np.abs(fields.mean(axis=(1, 2)))) < 1e-3
    np.testing.assert_allclose(fields.std(axis=(1, 2)), whole.WANDER, rtol=0.02)
    alike = lambda steps: np.mean(fields[:, :-steps] * fields[:, steps:]) / whole.WANDER**2  # noqa: E731
    assert alike(6) > 0.8 and abs(alike(36)) < 0.2  # over 30 and 180 mm


@pytest.fixture
def few(monkeypatch):
    """Coarser elements and fewer modes: where it is not their accuracy that a test is about."""
    monkeypatch.setattr(whole_plate, "DEGREE", 5)
    monkeypatch.setattr(whole_plate, "FLEXIBLE", 50)


def bench_of(panel, **what):
    """A test of a panel at one place, with no noise."""
    places = {"forces": np.array([[-0.15, 0.05]]), "response": np.array([0.2, 0.13])}
    zeta, sampling = np.full(whole_plate.FLEXIBLE, 0.004), Sampling(5120.0, 8192)
    return whole.WholeBench(panel, zeta, **places, suspension=(), hits=1, noise=0.0, sampling=sampling, contact=(1.5e-4, 2e-4), **what)


def test_val_records_are_the_sum_over_modes_in_time(few):
    """A blow's answer mode by mode in closed form, after the contact: rigid motions are uniform velocities, which accelerate nothing."""
    bench = bench_of(SMALL)
    played = records.play(bench, np.random.default_rng(2))
    modes = whole_plate.solve(SMALL, bench.forces, [Foot(*bench.response)], bench.zeta)
    pulse = records._pulses(bench, np.random.default_rng(2))[0]
    omega, decay = modes.omega[3:], modes.zeta[3:] * modes.omega[3:]
    pole = -decay + 1.0j * omega * np.sqrt(1.0 - modes.zeta[3:] ** 2)
    time = bench.sampling.time
    gain = bench.sampling.low_pass(pole.imag / 2.0 / np.pi)
    left = half_sine(pole, pulse[0], pulse[1], 0.0) * modes.shape[3:, 0] * modes.shape[3:, 1] * pole**2 / (1.0j * pole.imag) * gain
    late = (time > 0.2) & (time < 0.8)  # the filter has rung out; later the contour brings back 1e-9 of its cut at half the rate
    wanted = (left[:, None] * np.exp(np.outer(pole, time[late] - pulse[2]))).sum(axis=0).real
    found = played.acceleration[0, 0, late]
    assert np.sqrt(np.mean((found - wanted) ** 2)) < 1e-4 * np.sqrt(np.mean(wanted**2))


@pytest.mark.parametrize("kind", ["none", *whole.EFFECTS])
def test_every_effect_moves_the_records(kind, few):
    """By more than a tenth of the least noise, and truth names what it is."""
    plain, changed = bench_of(SMALL), bench_of(SMALL)
    for bench in (plain, changed):
        bench.suspension = ((-0.1, -0.1), (0.1, -0.1), (-0.1, 0.1), (0.1, 0.1))
    if kind != "none":
        whole.EFFECTS[kind](changed, Draw(np.random.default_rng(1)))
    if kind == "support-compliance":  # another than a clamp
        plain.panel = replace(plain.panel, left=(1e12, 1e9))
    one, other = (records.play(bench, np.random.default_rng(1)).acceleration for bench in (plain, changed))
    moved = np.sqrt(np.mean((one - other) ** 2) / np.mean(one**2))
    assert (moved > 1e-4) == (kind != "none"), moved


@pytest.mark.parametrize("name", whole.SETS)
def test_the_folder_and_the_truth(name, tmp_path, few):
    """A plate's test file with a place (x, y) a record, and in the truth all that was put in; what a tester sees tells nothing of it."""
    case = next(one for one in sets.cases(name, 1) if one.kind == "local-mass")
    random = np.random.default_rng(4)
    bench, effects, told = sets.build(case, random)
    bench.sampling = Sampling(bench.sampling.rate, 2048)
    played = records.play(bench, random)
    files.write_case(tmp_path / "case", bench, played)
    truth = files.truth_of("case", case, bench, effects, played) | told
    test = tomllib.loads((tmp_path / "case" / "test.toml").read_text(encoding="utf-8"))
    assert test["structure"] == "mindlin-plate" and len(test["measurement"]) == case.places
    assert {key: test["piece"][key] for key in truth["piece"]} == truth["piece"]
    assert len(pyuff.UFF(str(tmp_path / "case" / "point-0.uff")).get_set_types()) == 2 * whole.HITS
    places = np.array([one["force_at"] for one in test["measurement"]])
    np.testing.assert_allclose(places, truth["force_at"], atol=1e-9)
    away = np.linalg.norm(places - test["measurement"][0]["response_at"], axis=1)
    assert away.min() > whole.APART - 1e-9
    assert np.all(np.abs(places) <= np.array([bench.panel.length, bench.panel.width]) / 2.0 - whole.EDGE + 1e-3)
    assert set(truth["constants"]) == {*whole_plate.CONSTANTS, "shear_coefficient"}
    assert whole.IN_BAND[0] <= truth["modes_in_band"] <= whole.IN_BAND[1]
    off = np.array(truth["hits_off_m"]) - np.array(truth["force_at"])[:, None]
    assert 1e-3 < np.std(off) < 2e-3 if case.real else np.all(off == 0.0)


def test_a_set_holds_each_kind_at_each_number_of_places():
    """Over three rounds."""
    kinds = {(case.kind, case.places) for case in sets.cases("whole", 3)}
    assert kinds == {(kind, places) for kind in whole.KINDS for places in whole.PLACES}


def test_a_place_off_the_panel_is_refused():
    """The message gives the place and the limits."""
    with pytest.raises(ValueError, match="0.3 m lies off the panel: between -0.25 and 0.25 m"):
        Mesh(SMALL, degree=2).deflection(Foot(0.3, 0.0))


def test_an_effect_shows_by_what_it_moves_beyond_constants():
    """By finer solutions of the panel with and without a mass: the first order is right within a tenth. A core that is softer everywhere
    is another constant, and shows not at all."""
    share, count, foot, mass = 1e-4, 12, Foot(0.12, 0.05, whole.FOOT), 0.001
    seen = whole_visible.Seen(SMALL, SMALL, share, count)
    assert seen.amplitude(replace(SMALL, core=lambda x, y: 0.99)) < 0.1
    mesh = Mesh(SMALL, degree=5)
    row = sparse.csr_matrix(mesh.deflection(foot))
    squares = [
        np.sort(eigsh(mesh.stiffness, k=3 + count, M=(mesh.mass + extra * row.T @ row).tocsc(), sigma=-1e4, return_eigenvectors=False))[3:]
        for extra in (0.0, mass)
    ]
    moved = 0.5 * np.log(squares[1] / squares[0])
    shifts = [0.5 * np.log(square_of(replace(SMALL, **{name: getattr(SMALL, name) * 1.001}), degree=5)[:count] / squares[0]) for name in CONSTANTS]
    taken = np.linalg.lstsq(np.transpose(shifts), moved, rcond=None)[0]
    wanted = np.linalg.norm(moved - np.transpose(shifts) @ taken) / share
    assert seen.amplitude(SMALL, [(foot, mass)]) == pytest.approx(wanted, rel=0.1)


def bench_with_places(count, highest, random):
    """A test of the small panel at so many places, up to a frequency in Hz."""
    bench = bench_of(SMALL)
    bench.hits, bench.noise, bench.sampling = 2, 1e-3, Sampling(2.56 * highest, 8192)
    bench.forces = whole._spread(SMALL, bench.response, count, random)
    bench.__post_init__()
    return bench


def written(folder, places, highest, change=None):
    """The test file of the small panel's records at so many places, and what was changed in it."""
    random = np.random.default_rng(12)
    bench = bench_with_places(places, highest, random)
    bench.zeta = np.exp(random.uniform(*np.log(whole.DAMPING), whole_plate.FLEXIBLE))
    told = change(bench, random) if change else None
    files.write_case(folder, bench, records.play(bench, random))
    return folder / "test.toml", told


def said(command, test):
    """What the command says of a test."""
    told = subprocess.run([ORTHOPANEL, command, test, "--json"], capture_output=True, text=True, check=True)
    return json.loads(told.stdout)


def traced(folder, disbond=None):
    """The trace of the small panel's records at eight places, with a disbond (loss, span, x, y) or none."""

    def change(bench, _):
        if disbond:
            bench.panel = whole.disbonded(bench.panel, *disbond)

    return said("trace", written(folder, 8, 2000.0, change)[0])


def with_effect(kind):
    """A change that is a strong effect."""
    return lambda bench, random: whole.EFFECTS[kind](bench, Draw(random, strong=True))


def holds(found, truth, name):
    """Whether an estimate is within three of its deviations, and these are small."""
    assert abs(found["value"] - truth) < 3.0 * found["std"] < 0.5 * abs(truth), (name, found, truth)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_an_edge_that_yields_is_named_and_identified(tmp_path, monkeypatch):
    """Springs along a clamped edge, which the test file does not tell; and declared, beside the constants, which do not take them up."""
    monkeypatch.setattr(whole_plate, "FLEXIBLE", 60)
    test, truth = written(tmp_path / "case", 5, 1600.0, with_effect("support-compliance"))
    found = said("trace", test)
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["support-compliance"])
    for name, value in found["effects"][0]["parameters"].items():
        holds(value, truth[name], name)
    test.write_text(test.read_text(encoding="utf-8") + '\n[[effect]]\nid = "support-compliance"\n', encoding="utf-8")
    found = said("identify", test)
    for name, values in found["effects"][0]["parameters"].items():
        holds(values[0], truth[name], name)
    for name, value in found["constants"].items():
        holds(value, getattr(SMALL, name), name)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_a_clamped_panel_is_identified(tmp_path, monkeypatch):
    """All six constants from the records of five places, with as good as rigid springs along its left edge."""
    monkeypatch.setattr(whole_plate, "FLEXIBLE", 60)

    def clamped(bench, _):
        bench.panel = replace(bench.panel, left=(1e12, 1e9))

    found = said("identify", written(tmp_path / "case", 5, 1600.0, clamped)[0])
    for name, value in found["constants"].items():
        assert abs(value["value"] / getattr(SMALL, name) - 1.0) < 2e-3, (name, value)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_a_core_that_relaxes_is_named(tmp_path, monkeypatch):
    """In records of eight places up to 2 kHz."""
    monkeypatch.setattr(whole_plate, "FLEXIBLE", 60)
    test, truth = written(tmp_path / "case", 8, 2000.0, with_effect("viscoelastic-core"))
    found = said("trace", test)
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["viscoelastic-core"])
    for name, value in found["effects"][0]["parameters"].items():
        holds(value, truth[name], name)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_a_disbond_is_named_at_its_place(tmp_path, monkeypatch):
    """A square of 80 mm that has lost 60 % of its shear stiffness, in records of eight places."""
    monkeypatch.setattr(whole_plate, "FLEXIBLE", 50)
    x, y = 0.13, -0.07
    found = traced(tmp_path / "case", (0.6, 0.08, x, y))
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["stiffness-loss"])
    values = {name: of["value"] for name, of in found["effects"][0]["parameters"].items()}
    assert np.hypot(values["x"] - x, values["y"] - y) < 0.005, values


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_the_smallest_disbond_that_is_said_is_named_and_half_of_it_is_not(tmp_path, monkeypatch):
    """From records of a sound panel: of the side said to be named at all places, in a corner; of half the side said to be named at half of
    them, nothing."""
    monkeypatch.setattr(whole_plate, "FLEXIBLE", 50)
    least = traced(tmp_path / "sound")["detectable"]
    assert 0.01 <= least["at_half_of_the_places"] <= least["anywhere"] < least["largest"], least
    x, y = -0.2, 0.14  # in a corner
    found = traced(tmp_path / "corner", (least["loss"], least["anywhere"], x, y))
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["stiffness-loss"])
    place = found["effects"][0]["parameters"]
    # The smallest that is named is not told well: here it is 50 mm off.
    assert np.hypot(place["x"]["value"] - x, place["y"]["value"] - y) < 0.06, place
    small = traced(tmp_path / "small", (least["loss"], least["at_half_of_the_places"] / 2.0, 0.1, -0.07))
    assert (small["verdict"], small["effects"]) == ("nothing-missing", []), small["candidates"][:3]


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_two_sensors_load_a_panel_together(tmp_path, few):
    """Two of 6 g, seen one after the other from the same six places: one mass is found for both, with the constants of the panel."""
    random, kilograms, text = np.random.default_rng(7), 0.006, None
    sensors = [np.array([-0.21, -0.12]), np.array([0.17, 0.13])]
    feet = [(Foot(*at, whole.FOOT), attachments.Mass(kilograms)) for at in sensors]
    forces = None
    for number, sensor in enumerate(sensors):
        bench = bench_with_places(6, 2000.0, random)
        forces = bench.forces if forces is None else forces
        bench.response, bench.forces, bench.attachments = sensor, forces, feet
        folder = tmp_path / f"sensor-{number}"
        files.write_case(folder, bench, records.play(bench, random))
        own = (folder / "test.toml").read_text(encoding="utf-8").replace('file = "', f'file = "sensor-{number}/')
        text = own + '\n[[effect]]\nid = "sensor-mass"\n' if text is None else text + own[own.index("[[measurement]]") :]
    (tmp_path / "test.toml").write_text(text, encoding="utf-8")
    told = subprocess.run([ORTHOPANEL, "identify", tmp_path / "test.toml", "--json"], capture_output=True, text=True, check=True)
    found = json.loads(told.stdout)
    mass = found["effects"][0]["parameters"]["mass"][0]
    assert abs(mass["value"] - kilograms) < 4.0 * mass["std"] < 0.02 * kilograms, mass
    assert {name: found["constants"][name]["value"] for name in SMALL.constants} == pytest.approx(SMALL.constants, rel=0.01)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_places_that_are_wrong_are_told(tmp_path, few):
    """Of records of twelve places: as they are written constants are given; sensor and hammer mirrored against each other, a grid counted
    from a corner, x and y exchanged, two records exchanged and one turned round are each refused with what to write; of three places it is said
    that they do not tell."""
    random = np.random.default_rng(11)
    bench = bench_with_places(12, 3150.0, random)
    files.write_case(tmp_path / "case", bench, records.play(bench, random))
    path = tmp_path / "case" / "test.toml"
    written = path.read_text(encoding="utf-8")
    force = re.findall(r"force_at = .*", written)
    response = re.findall(r"response_at = .*", written)[0]
    x, y = bench.response
    assert len(set(force)) == 12 and written.count(response) == 12

    def moved(by):
        return re.sub(r"_at = \[(.*), (.*)\]", lambda at: f"_at = [{float(at[1]) + by[0]:.6f}, {float(at[2]) + by[1]:.6f}]", written)

    readings = {
        "": written,
        "x of response_at": written.replace(response, f"response_at = [{-x}, {y}]"),
        "x and y of response_at": written.replace(response, f"response_at = [{-x}, {-y}]"),
        "counted from the corner": moved((SMALL.length / 2.0, SMALL.width / 2.0)),
        "are exchanged": written.replace(force[2], "kept").replace(force[7], force[2]).replace("kept", force[7]),
        "with x and y exchanged": re.sub(r"_at = \[(.*), (.*)\]", r"_at = [\2, \1]", written),
        "turned round": written.replace(force[4], force[4] + "\ndirection = -1"),
    }
    for wanted, text in readings.items():
        path.write_text(text, encoding="utf-8")
        told = subprocess.run([ORTHOPANEL, "identify", path], capture_output=True, text=True, check=False)
        assert (told.returncode == 0) == (not wanted) and wanted in told.stderr, (wanted, told.returncode, told.stderr)

    path.write_text("[[measurement]]".join(written.split("[[measurement]]")[:4]), encoding="utf-8")
    told = subprocess.run([ORTHOPANEL, "identify", path], capture_output=True, text=True, check=False)
    assert "records of 3 pairs of places do not tell whether an axis is mirrored" in told.stderr, told.stderr

    path.write_text(written + '\n[[effect]]\nid = "local-mass"\nmass = 1e-5\nx = 0.1\ny = 0.05\n', encoding="utf-8")
    told = subprocess.run([ORTHOPANEL, "identify", path, "--json"], capture_output=True, text=True, check=True)
    found = json.loads(told.stdout)["constants"]
    assert {name: found[name]["value"] for name in SMALL.constants} == pytest.approx(SMALL.constants, rel=0.01)
