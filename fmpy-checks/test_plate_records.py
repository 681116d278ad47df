"""A plate from accelerances at places off its centre line: scikit-fem's modes, damped and noisy, in; constants out."""

import json
import os
import subprocess
import zipfile

import numpy as np
import pytest
from conftest import ROOT
from plate_by_scikit_fem import shapes_at
from plate_record_files import write

TRUTH = {"e_x": 1.07e10, "e_y": 8.6e9, "nu_xy": 0.34, "g_xy": 3.2e9, "g_yz": 2.6e8, "g_zx": 5.363e8}
PIECE = {"length": 0.8, "width": 0.2, "thickness": 0.03, "mass_per_area": 6.880}
RESPONSE = (0.31, 0.07)
FORCES = [(-0.37, -0.08), (-0.21, 0.09), (0.02, -0.05), (0.17, 0.06), (-0.30, 0.0)]
LINES = np.arange(40.0, 2700.0, 1.25)
NOISE = 1e-2  # of each record's rms: well above what either basis leaves, 1e-4 of a frequency


@pytest.fixture(scope="module")
def modes():
    # Far above the band: with 90 modes the end of the sum moved E_y by 1 to 2 %, which hardly shows in these records.
    return shapes_at({"piece": PIECE, "constants": TRUTH}, (16, 5), 300, [RESPONSE, *FORCES])


@pytest.fixture(scope="module", params=[7, 8, 9])
def test_folder(request, modes, tmp_path_factory):
    folder = tmp_path_factory.mktemp("plate-records")
    random = np.random.default_rng(request.param)
    frequencies, _ = modes
    zetas = 2e-3 * np.exp(0.3 * random.standard_normal(len(frequencies)))
    write(folder, PIECE, modes, zetas, FORCES, RESPONSE, LINES, NOISE, random)
    inside = (frequencies > 1.0) & (frequencies < LINES[-1])
    return folder, zetas[inside], frequencies[inside]


def test_constants_and_damping_of_a_plate_come_from_its_accelerances(test_folder):
    folder, zetas, frequencies = test_folder
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    done = subprocess.run([command, "identify", str(folder / "test.toml"), "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    for name, truth in TRUTH.items():
        constant = found["constants"][name]
        assert constant["value"] == pytest.approx(truth, rel=0.01), (name, constant)
        assert abs(constant["value"] - truth) < 3.5 * constant["std"], (name, constant)
    modes = found["modes"]
    assert [mode["nodes"] for mode in modes] == [[2, 0], [1, 1], [3, 0], [2, 1], [4, 0], [3, 1], [5, 0], [4, 1]][: len(modes)]
    assert len(modes) >= 7
    for mode in modes:
        index = mode["mode"] - 1
        assert mode["measured_hz"] == pytest.approx(frequencies[index], rel=2e-4)
        assert mode["zeta"] == pytest.approx(zetas[index], rel=0.05), mode


@pytest.mark.parametrize("test_folder", [7], indirect=True)
def test_what_is_written_of_a_plates_records_is_the_plate(test_folder, tmp_path):
    folder, _, _ = test_folder
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    test = str(folder / "test.toml")
    done = subprocess.run([command, "run", test, "-o", str(tmp_path / "out"), "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert answer["trace"]["verdict"] == "nothing-missing" and "not_traced" not in answer
    model = json.loads((tmp_path / "out/model.json").read_text())
    assert model["structure"] == "mindlin-plate" and not model.get("effects")
    for name, truth in TRUTH.items():
        assert model["constants"][name]["value"] == pytest.approx(truth, rel=0.01), name
    with zipfile.ZipFile(tmp_path / "out/panel.fmu") as fmu:
        resource = fmu.read("resources/panel.json").decode()
    assert "mindlin-plate" in resource
    page = (tmp_path / "out/report.html").read_text()
    assert "Not traced: " not in page and "The model lacked" not in page
