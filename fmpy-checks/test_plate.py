"""The plate's natural frequencies against scikit-fem, on both of the paper's widths."""

import json
import os
import subprocess

import pytest
from conftest import ROOT
from plate_by_scikit_fem import frequencies, matrices

COUNT = 20


def plate(width, boundary=None):
    return {
        "schema": "orthopanel.model/1",
        "piece": {"length": 0.8, "width": width, "thickness": 0.03, "mass_per_area": 6.880},
        "boundary": boundary or {},
        "structure": "mindlin-plate",
        # Table 4's E_x and G_zx of piece 1; the others such as a honeycomb has them, all apart.
        "constants": {"e_x": 1.07e10, "e_y": 9.6e9, "nu_xy": 0.31, "g_xy": 3.7e9, "g_yz": 2.9e8, "g_zx": 5.363e8},
    }


def ours(model, folder, count=COUNT):
    path = folder / "plate.json"
    path.write_text(json.dumps(model))
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    done = subprocess.run([command, "modes", str(path), "--count", str(count), "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["modes"]


@pytest.mark.parametrize("width", [0.1, 0.2])
@pytest.mark.parametrize("boundary", [{}, {"left": "clamped"}, {"left": "clamped", "right": "clamped", "front": "clamped"}])
def test_twenty_modes_agree_with_scikit_fem(width, boundary, tmp_path):
    model = plate(width, boundary)
    witness = frequencies(*matrices(model, (14, 4)), COUNT)
    found = ours(model, tmp_path)
    assert len(found) == COUNT
    for mode, expected in zip(found, witness):
        assert mode["frequency_hz"] == pytest.approx(expected, rel=1e-4), (mode, expected)


@pytest.mark.parametrize("width, thickness", [(0.2, 0.004), (0.4, 0.013)])
def test_wide_thin_panels_agree_with_scikit_fem(width, thickness, tmp_path):
    """30 to 50 times as wide as thick: the layers at free edges want more terms than the nodes of the modes do."""
    model = plate(width)
    model["piece"]["thickness"] = thickness
    # This mesh holds 2e-5 against one half as fine again.
    witness = frequencies(*matrices(model, (22, 12), graded=True), COUNT)
    for count in (3, COUNT):
        for mode, expected in zip(ours(model, tmp_path, count), witness[:count], strict=True):
            assert mode["frequency_hz"] == pytest.approx(expected, rel=1e-4), (mode, expected)


def test_a_free_plate_has_its_lowest_modes_in_bending_and_torsion(tmp_path):
    nodes = [mode["nodes"] for mode in ours(plate(0.2), tmp_path)[:4]]
    assert nodes == [[2, 0], [1, 1], [3, 0], [2, 1]]
