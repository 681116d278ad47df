"""Lists of a plate's frequencies that a search may end wrongly on: scikit-fem's frequencies in."""

import json
import os
import subprocess

import numpy as np
import pytest
from conftest import ROOT
from plate_by_scikit_fem import shapes_at

NOISE = 5e-4
NEAR_SQUARE = {"length": 0.4, "width": 0.4, "thickness": 0.02, "mass_per_area": 6.0}
NEAR_SQUARE_TRUTH = {"e_x": 1.0e10, "e_y": 9.85e9, "nu_xy": 0.3, "g_xy": 3.2e9, "g_yz": 4.0e8, "g_zx": 4.1e8}
# Near a square two modes share both products of a name; E_y being the less, the lower one is the one across.
NEAR_SQUARE_NAMES = [[1, 1], [0, 2], [2, 0], [1, 2], [2, 1], [2, 2], [0, 3], [3, 0], [1, 3], [3, 1]]


def identify(folder, piece, values, names):
    text = ['structure = "mindlin-plate"', "[piece]"] + [f"{key} = {value}" for key, value in piece.items()]
    text += ["[[measurement]]", 'kind = "natural-frequencies"', f"values = {[float(value) for value in values]}"]
    text += [f"shape = {names}"] if names else []
    (folder / "test.toml").write_text("\n".join(text) + "\n")
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    return subprocess.run([command, "identify", str(folder / "test.toml"), "--json"], capture_output=True, text=True)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_plate_that_is_nearly_a_square_is_met_under_its_names(tmp_path, seed):
    frequencies, _ = shapes_at({"piece": NEAR_SQUARE, "constants": NEAR_SQUARE_TRUTH}, (12, 12), 13, [(0.0, 0.0)])
    random = np.random.default_rng(seed)
    values = frequencies[3:13] * (1.0 + NOISE * random.standard_normal(10))
    done = identify(tmp_path, NEAR_SQUARE, sorted(values), NEAR_SQUARE_NAMES)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["error"]["frequency_rms_percent"] < 0.1 and not found["notes"], (found["error"], found["notes"])
    for name in ["e_x", "e_y", "g_xy"]:
        assert found["constants"][name]["value"] == pytest.approx(NEAR_SQUARE_TRUTH[name], rel=0.02), found["constants"]
