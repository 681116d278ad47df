"""Lists of a plate's natural frequencies that tell no shapes: `orthopanel identify` finds the constants from sizes and mass alone."""

import json
import os
import subprocess

import numpy as np
import pytest

from .whole_plate import WholePanel, frequencies

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
