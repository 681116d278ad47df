"""Wide plates, whose E_y is far from E_x, from accelerances: the mode across the width lies a third beside a usual panel's."""

import json
import os
import subprocess

import numpy as np
import pytest
from conftest import ROOT
from plate_by_scikit_fem import shapes_at
from plate_record_files import write

TRUTH = {"e_x": 1.07e10, "e_y": 6.2e9, "nu_xy": 0.25, "g_xy": 3.4e9, "g_yz": 2.6e8, "g_zx": 5.1e8}
# Width, end of the band, force places as parts of half the length and half the width.
CASES = {
    "0.4 m": (0.4, 2000.0, [(-0.92, -0.85), (-0.52, 0.75), (0.05, -0.25), (0.42, 0.6), (-0.75, 0.0)]),
    "0.4 m, a short band": (0.4, 1300.0, [(-0.92, -0.85), (-0.52, 0.75), (0.05, -0.25), (0.42, 0.6), (-0.75, 0.0)]),
    "0.4 m, the corners": (0.4, 2000.0, [(-0.95, -0.95), (0.95, -0.95), (-0.95, 0.95), (0.5, 0.5)]),
    "0.3 m": (0.3, 2000.0, [(-0.92, -0.8), (-0.52, 0.73), (0.05, -0.33), (0.42, 0.6), (-0.75, 0.0)]),
}


def piece(width):
    return {"length": 0.8, "width": width, "thickness": 0.03, "mass_per_area": 6.88}


@pytest.fixture(scope="module", params=CASES)
def case(request, tmp_path_factory):
    width, band, parts = CASES[request.param]
    forces = [(round(0.4 * x, 3), round(0.5 * width * y, 3)) for x, y in parts]
    response = (0.31, round(0.35 * width, 3))
    shapes = shapes_at({"piece": piece(width), "constants": TRUTH}, (16, 8), 300, [response, *forces])
    random = np.random.default_rng(4)
    zetas = 2e-3 * np.exp(0.2 * random.standard_normal(len(shapes[0])))
    folder = tmp_path_factory.mktemp("wide-plate")
    write(folder, piece(width), shapes, zetas, forces, response, np.arange(40.0, band, 1.25), 1e-2, random)
    return folder, shapes[0]


def identified(path):
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    return subprocess.run([command, "identify", str(path), "--json"], capture_output=True, text=True)


def test_constants_of_a_wide_plate_come_from_its_accelerances(case):
    folder, frequencies = case
    done = identified(folder / "test.toml")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["error"]["chi_square"] < 1.3, found["error"]
    unseen = {entry["name"] for entry in found["not_identified"]}
    assert unseen <= {"nu_xy"}, unseen
    for name, truth in TRUTH.items():
        constant = found["constants"][name]
        if name not in unseen:
            # Poisson's ratio shows least: the interval judges it alone.
            assert name == "nu_xy" or constant["value"] == pytest.approx(truth, rel=0.02), (name, constant)
            assert abs(constant["value"] - truth) < 3.5 * constant["std"], (name, constant)
    for mode in found["modes"]:
        assert mode["measured_hz"] == pytest.approx(frequencies[2 + mode["mode"]], rel=3e-4), mode


def test_a_resonance_that_no_mode_took_is_named(case):
    """Five constants held, one of them at twice its value: no plate has the resonance across the width. In more than a short band the value is
    named with the right one, which is half of it, and no other value is."""
    folder, _ = case
    held = {**TRUTH, "e_y": 2.0 * TRUTH["e_y"]}
    del held["g_zx"]
    lines = (folder / "test.toml").read_text().split("[[measurement]]", 1)
    text = lines[0] + "[constants]\n" + "".join(f"{key} = {value}\n" for key, value in held.items())
    (folder / "held.toml").write_text(text + "[[measurement]]" + lines[1])
    done = identified(folder / "held.toml")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert any("resonances that are no mode of the plate" in note for note in found["notes"]), found["notes"]
    blamed = [note for note in found["notes"] if "the frequencies contradict" in note]
    assert blamed or len(found["modes"]) < 6, found["notes"]
    assert all("contradict e_y = 1.240e10, free 6.200e9 " in note and note.count("free") == 1 for note in blamed), blamed
