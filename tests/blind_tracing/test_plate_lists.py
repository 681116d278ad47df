"""Lists of a plate's natural frequencies: constants from sizes and mass alone without shapes, and what the plate lacks."""

import json
import os
import subprocess

import numpy as np
import pytest
import scipy.sparse as sparse

from .whole_plate import RIGID, Foot, Mesh, WholePanel, frequencies, lowest

ORTHOPANEL = os.environ.get("ORTHOPANEL")
pytestmark = pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
LINES = 12
SCATTER = 2e-3  # of each frequency
PLATES = {
    "honeycomb": WholePanel(1.2, 0.8, 0.03, 6.2, 1.1e10, 0.9e10, 0.3, 3.7e9, 2.4e8, 4.1e8),
    "nearly square": WholePanel(0.6, 0.5, 0.02, 5.0, 0.8e10, 0.7e10, 0.33, 2.8e9, 2e8, 3.5e8),
    "spruce along its grain": WholePanel(0.58, 0.22, 0.005, 2.1, 1.1e10, 0.95e9, 0.35, 7.5e8, 8e8, 1e9),
    "spruce across its grain": WholePanel(0.22, 0.58, 0.005, 2.1, 0.95e9, 1.1e10, 0.03, 7.5e8, 1e9, 8e8),
}


@pytest.mark.parametrize("name", PLATES)
def test_val_a_plates_list_without_shapes_gives_its_constants(tmp_path, name):
    """Those that twelve frequencies show, and which modes they are is told."""
    panel = PLATES[name]
    random = np.random.default_rng(41)
    values = frequencies(panel, LINES)[:LINES] * (1.0 + SCATTER * random.standard_normal(LINES))
    values = np.sort(values)
    test = tmp_path / "test.toml"
    test.write_text(
        f'structure = "mindlin-plate"\n[piece]\nlength = {panel.length}\nwidth = {panel.width}\n'
        f"thickness = {panel.thickness}\nmass_per_area = {panel.mass_per_area}\n"
        f'[[measurement]]\nkind = "natural-frequencies"\nvalues = [{", ".join(f"{value:.5g}" for value in values)}]\n',
        encoding="utf-8",
    )
    ran = subprocess.run([ORTHOPANEL, "identify", test, "--json"], capture_output=True, text=True, timeout=300)
    assert ran.returncode == 0, ran.stderr
    found = json.loads(ran.stdout)
    assert any("read by frequency alone" in note for note in found["notes"]), found["notes"]
    for constant in ("e_x", "e_y", "g_xy"):
        value, truth = found["constants"][constant], getattr(panel, constant)
        assert abs(value["value"] / truth - 1.0) < 0.05, (constant, value, truth)
        assert value["std"] is None or abs(value["value"] - truth) < 3.0 * value["std"], (constant, value, truth)


SHAPES = [[1, 1], [2, 0], [0, 2], [2, 1], [1, 2], [3, 0], [2, 2], [3, 1], [0, 3], [1, 3], [3, 2], [2, 3], [4, 0], [4, 1]]
MASS, X, Y = 0.03, 0.17, 0.11


def with_mass(panel, count):
    """Frequencies in Hz with a mass on its foot."""
    foot = Foot(X, Y, 0.012)
    mesh = Mesh(panel, [foot], degree=6)
    row = sparse.csr_matrix(mesh.deflection(foot))
    mesh.mass = (mesh.mass + MASS * row.T @ row).tocsc()
    return np.sqrt(lowest(mesh, count)[0][RIGID:]) / 2.0 / np.pi


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    """A list with shapes of a plate with a mass that the test file does not tell."""
    panel, random = PLATES["nearly square"], np.random.default_rng(0)
    values = with_mass(panel, len(SHAPES)) * (1.0 + 1e-3 * random.standard_normal(len(SHAPES)))
    assert np.all(np.diff(values) > 0.0)
    test = tmp_path_factory.mktemp("loaded") / "test.toml"
    test.write_text(
        f'structure = "mindlin-plate"\n[piece]\nlength = {panel.length}\nwidth = {panel.width}\n'
        f"thickness = {panel.thickness}\nmass_per_area = {panel.mass_per_area}\n"
        f'[[measurement]]\nkind = "natural-frequencies"\nvalues = [{", ".join(f"{value:.6g}" for value in values)}]\n'
        f"scatter = [{', '.join(f'{1e-3 * value:.3g}' for value in values)}]\nshape = {SHAPES}\n",
        encoding="utf-8",
    )
    return test


def told(command, test):
    """What the command says of a test."""
    ran = subprocess.run([ORTHOPANEL, command, test, "--json"], capture_output=True, text=True, timeout=300)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


def test_val_a_mass_is_named_from_a_plates_list(loaded):
    """And where it sits, in the quarter that frequencies leave open."""
    found = told("trace", loaded)
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["local-mass"])
    for name, truth in {"mass": MASS, "x": X, "y": Y}.items():
        of = found["effects"][0]["parameters"][name]
        assert abs(of["value"] - truth) < 3.0 * of["std"], (name, of)
    assert found["error"]["after"]["fitted"] < 0.1 < 0.5 < found["error"]["before"]["fitted"]


def test_val_a_declared_mass_beside_a_plates_list_is_found(loaded):
    """With the constants that the plate has without it."""
    declared = loaded.with_name("declared.toml")
    declared.write_text(loaded.read_text(encoding="utf-8") + f'[[effect]]\nid = "local-mass"\nx = {X}\ny = {Y}\n', encoding="utf-8")
    found = told("identify", declared)
    mass = found["effects"][0]["parameters"]["mass"][0]
    assert abs(mass["value"] - MASS) < 3.0 * mass["std"] < 0.2 * MASS, mass
    for name, value in found["constants"].items():
        assert abs(value["value"] - getattr(PLATES["nearly square"], name)) < 3.0 * value["std"], (name, value)
    assert [mode["nodes"] for mode in found["modes"]][:3] == SHAPES[:3]
