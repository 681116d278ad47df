"""What the command says of whole panels: constants that the test file holds, places off along y, roving sensors, and what stands on the panel."""

import json
import os
import subprocess
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from . import attachments, files, records, whole, whole_plate
from .test_whole import SMALL, bench_with_places, few  # noqa: F401
from .whole_plate import Foot

ORTHOPANEL = os.environ.get("ORTHOPANEL")
pytestmark = pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")


def told(command, test, *further):
    """What the command says of a test, as JSON."""
    ran = subprocess.run([ORTHOPANEL, command, test, *further, "--json"], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


def made(folder, bench, random):
    """The test file of a bench's records."""
    files.write_case(folder, bench, records.play(bench, random))
    return folder / "test.toml"


def holding(test, constants):
    """The same test with constants held, in a file beside it."""
    held = test.with_name("held.toml")
    lines = "".join(f"{name} = {value:.6e}\n" for name, value in constants.items())
    held.write_text(test.read_text(encoding="utf-8") + f"\n[constants]\n{lines}", encoding="utf-8")
    return held


def test_val_constants_that_are_held_leave_the_others_of_a_real_panel(tmp_path, few):  # noqa: F811
    """Five of six, of a panel whose modes lie 0.3 % off those of a plate: the sixth is found, and one that is wrong is told with its value."""
    random = np.random.default_rng(17)
    bench = bench_with_places(6, 2000.0, random)
    bench.own = 3e-3 * random.standard_normal(whole_plate.FLEXIBLE), np.ones((whole_plate.FLEXIBLE, 6))
    test = made(tmp_path / "case", bench, random)
    five = {name: value for name, value in SMALL.constants.items() if name != "g_zx"}
    found = told("identify", holding(test, five))
    g_zx = found["constants"]["g_zx"]
    assert abs(g_zx["value"] - SMALL.g_zx) < 3.0 * g_zx["std"] < 0.1 * SMALL.g_zx, g_zx
    assert all(found["constants"][name]["value"] == pytest.approx(value, rel=1e-6) for name, value in five.items())
    assert "e_x, e_y, nu_xy, g_xy, g_yz as the test file holds them" in found["notes"][0], found["notes"]
    assert not any("contradict" in note for note in found["notes"]), found["notes"]
    wrong = told("identify", holding(test, {"e_y": 1.2 * SMALL.e_y}))
    assert any("the frequencies contradict e_y = 9.600e9, free 7." in note for note in wrong["notes"]), wrong["notes"]


def small_test(folder, change=lambda bench: None, count=6, seed=12, highest=800.0):
    """The test file of the small panel's records up to 800 Hz (four modes), at so many places, with what `change` puts into it."""
    random = np.random.default_rng(seed)
    bench = bench_with_places(count, highest, random)
    change(bench)
    return made(folder, bench, random)


def named(found):
    """The verdict, and each effect's parameters by its id."""
    effects = {effect["id"]: {name: of["value"] for name, of in effect["parameters"].items()} for effect in found["effects"]}
    return found["verdict"], effects


def test_val_a_sensor_that_sits_off_along_y_is_told_so(tmp_path, few):  # noqa: F811
    """12 mm beside its mark."""

    def misplaced(bench):
        bench.response_off = np.array([0.0, -0.012])

    verdict, effects = named(told("trace", small_test(tmp_path / "case", misplaced, count=4)))
    assert (verdict, list(effects)) == ("explained", ["position-error"])
    offset = effects["position-error"]
    assert abs(offset["offset"]) < 5e-4 and abs(offset["offset_y"] + 0.012) < 1e-3, offset


def test_val_a_hammer_that_strikes_off_along_y_is_told_so(tmp_path, few):  # noqa: F811
    """In each record by its own, two of them by 30 mm and more; the constants are held."""
    off = np.array([0.031, -0.034, 0.006, -0.008, -0.007, -0.003])

    def misplaced(bench):
        bench.off[..., 1] = off[:, None]

    test = holding(small_test(tmp_path / "case", misplaced), SMALL.constants)
    _, effects = named(told("trace", test))
    # Not always clearly: six offsets either way of six records say little of anything else.
    assert list(effects) == ["hammer-offset"]
    offset = effects["hammer-offset"]
    # They are drawn back towards the marks, beside which 6 mm are usual, and 35 mm the most.
    np.testing.assert_allclose(offset["offset_y"], off, atol=6e-3)
    np.testing.assert_allclose(offset["offset"], 0.0, atol=1e-3)


def test_val_masses_along_front_and_back_are_named(tmp_path, few):  # noqa: F811
    """12 g along each, and none along left and right; declared, they are identified. The constants are held."""
    filled = lambda bench: setattr(bench, "panel", replace(bench.panel, edge_mass=0.012))  # noqa: E731
    test = holding(small_test(tmp_path / "case", filled, count=4, highest=1000.0), SMALL.constants)
    verdict, effects = named(told("trace", test))
    assert (verdict, list(effects), effects["edge-mass"]["mass"]) == ("explained", ["edge-mass"], 0.0)
    assert effects["edge-mass"]["mass_y"] == pytest.approx(0.012, rel=0.03)
    test.write_text(test.read_text(encoding="utf-8") + '\n[[effect]]\nid = "edge-mass"\nmass = 0.0\n', encoding="utf-8")
    mass = told("identify", test)["effects"][0]["parameters"]["mass_y"][0]
    assert abs(mass["value"] - 0.012) < 3.0 * mass["std"] < 1e-3, mass


def test_val_a_resonator_on_a_plate_is_named(tmp_path, few):  # noqa: F811
    """25 g on a spring, at 420 Hz, with its place; the constants are held."""
    truth = {"mass": 0.025, "frequency": 420.0, "zeta": 0.02, "x": -0.11, "y": 0.06}

    def hung(bench):
        own = attachments.resonator(truth["mass"], truth["frequency"], truth["zeta"])
        bench.attachments.append((Foot(truth["x"], truth["y"], whole.FOOT), own))

    verdict, effects = named(told("trace", holding(small_test(tmp_path / "case", hung), SMALL.constants)))
    assert (verdict, list(effects)) == ("explained", ["resonator"])
    found = effects["resonator"]
    assert np.hypot(found["x"] - truth["x"], found["y"] - truth["y"]) < 0.005, found
    assert [found[name] for name in ("mass", "frequency", "zeta")] == pytest.approx([truth[name] for name in ("mass", "frequency", "zeta")], rel=0.05)


def test_val_a_high_pass_in_the_records_of_a_plate_is_named(tmp_path, few):  # noqa: F811
    """First order, at 8 Hz."""
    corner = 8.0
    slow = lambda bench: bench.chain.append(lambda s: s / (s + 2.0 * np.pi * corner))  # noqa: E731
    verdict, effects = named(told("trace", holding(small_test(tmp_path / "case", slow, count=4), SMALL.constants)))
    assert (verdict, list(effects)) == ("explained", ["high-pass"])
    assert effects["high-pass"]["corner"] == pytest.approx(corner, rel=0.05)


def test_val_a_sensor_that_roves_gives_the_constants_of_a_hammer_that_does(tmp_path, few):  # noqa: F811
    """By reciprocity the same records, with force and response exchanged."""
    test = small_test(tmp_path / "case", count=10, highest=2000.0)
    hammer = told("identify", test)["constants"]
    text = test.read_text(encoding="utf-8")
    test.write_text(text.replace("force_at", "there").replace("response_at", "force_at").replace("there", "response_at"), encoding="utf-8")
    sensor = told("identify", test)["constants"]
    for name, value in SMALL.constants.items():
        assert sensor[name]["value"] == pytest.approx(hammer[name]["value"], rel=1e-6), name
        assert abs(sensor[name]["value"] - value) < max(0.01 * value, 3.0 * (sensor[name]["std"] or np.inf)), (name, sensor[name])


def test_val_a_real_panel_has_the_constants_of_its_mean(tmp_path, few):  # noqa: F811
    """Its core wanders by 3 %, its modes, hits and gains are off as in `whole-real`: by how much its frequencies miss a plate is said, and the constants
    are those of its mean within three deviations, which are a few per cent."""
    random = np.random.default_rng(23)
    off = {}
    test = small_test(tmp_path / "case", lambda bench: off.update(whole._real(bench, random)), count=10, highest=2000.0)
    found = told("identify", test)
    assert off["wander"] == whole.WANDER and "which the nearest plate misses by 0." in found["notes"][0], found["notes"]
    for name in ("e_x", "e_y", "g_xy", "g_yz", "g_zx"):
        value, truth = found["constants"][name], getattr(SMALL, name)
        assert abs(value["value"] - truth) < 3.0 * value["std"] < 0.15 * truth, (name, value, truth)


def with_mass(bench):
    """30 g on the panel that the file does not tell."""
    bench.attachments.append((Foot(0.13, -0.07, whole.FOOT), attachments.mass(0.03)))


def test_a_run_of_a_plate_with_a_mass_writes_model_fmu_and_report(tmp_path, few):  # noqa: F811
    """The mass stands in the model at its place, and in the FMU's description; the constants are held."""
    test, out = holding(small_test(tmp_path / "case", with_mass), SMALL.constants), tmp_path / "out"
    told("run", test, "-o", out)
    model = json.loads((out / "model.json").read_text(encoding="utf-8"))
    (effect,) = model["effects"]
    assert (model["structure"], effect["id"]) == ("mindlin-plate", "local-mass")
    assert np.hypot(effect["x"]["value"] - 0.13, effect["y"]["value"] + 0.07) < 0.005, effect
    with zipfile.ZipFile(out / "panel.fmu") as packed:
        assert "local_mass" in packed.read("modelDescription.xml").decode()
    report = (out / "report.html").read_text(encoding="utf-8")
    assert "local-mass" in report and "A mass around x = 0.13" in report


def test_val_a_sound_plate_shows_what_the_model_error_hides(tmp_path, few):  # noqa: F811
    """4 g on one of two panels of a make, both of whose modes lie 0.3 % off those of a plate with the constants that are held."""
    shares = 3e-3 * np.random.default_rng(8).standard_normal(whole_plate.FLEXIBLE), np.ones((whole_plate.FLEXIBLE, 6))

    def off(bench):
        bench.own = shares

    def loaded(bench):
        off(bench)
        bench.attachments.append((Foot(0.13, -0.07, whole.FOOT), attachments.mass(0.004)))

    good, suspect = (holding(small_test(tmp_path / name, change, highest=1600.0), SMALL.constants) for name, change in (("good", off), ("suspect", loaded)))
    against = told("trace", suspect, "--reference", good)
    shared = against["shared_model_error"]
    assert shared["suspect_less_reference"] < shared["suspect"] / 2.0, shared
    _, effects = named(against)
    assert list(effects) == ["local-mass"], against["candidates"][:3]
    assert np.hypot(effects["local-mass"]["x"] - 0.13, effects["local-mass"]["y"] + 0.07) < 0.02, effects
