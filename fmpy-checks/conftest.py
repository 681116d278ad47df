"""The panel under test, exported once for each version of the standard."""

import json
import os
import subprocess
from pathlib import Path

import pytest

from timoshenko import Beam

ROOT = Path(__file__).resolve().parent.parent

# Test piece 1 of the paper: table 3, mass per area of section 3.1, constants and damping of table 9.
BEAM = Beam(length=0.8, width=0.1, thickness=0.03, mass_per_area=6.880, e_x=1.067e10, g_zx=5.304e8)
ZETAS = [2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3]

# Nine forces: FMPy 0.3.32 passes input derivatives of exactly nine inputs.
FORCES = [-0.3, -0.25, -0.15, -0.05, 0.0, 0.05, 0.15, 0.25, 0.4]
RESPONSES = [0.3, -0.3]


@pytest.fixture(scope="session")
def export(tmp_path_factory):
    """Exports the panel to a file of this name; returns its path."""
    folder = tmp_path_factory.mktemp("fmu")
    model = folder / "panel.json"
    model.write_text(
        json.dumps(
            {
                "schema": "orthopanel.model/1",
                "piece": {
                    "length": BEAM.length,
                    "width": BEAM.width,
                    "thickness": BEAM.thickness,
                    "mass_per_area": BEAM.mass_per_area,
                },
                "structure": "timoshenko-beam",
                "constants": {"e_x": BEAM.e_x, "g_zx": BEAM.g_zx},
                "damping": {"ratios": ZETAS, "beyond": 0.003},
            }
        )
    )
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))

    def export(name, *options):
        path = folder / name
        words = [command, "export", str(model), "-o", str(path), "--modes", str(len(ZETAS)), *options]
        words += [f"--force={x}" for x in FORCES] + [f"--response={x}" for x in RESPONSES]
        done = subprocess.run(words, capture_output=True, text=True, cwd=ROOT)
        assert done.returncode == 0, done.stderr
        return path

    return export


@pytest.fixture(scope="session", params=[2, 3], ids=["fmi2", "fmi3"])
def fmu(request, export):
    return export(f"v{request.param}.fmu", "--fmi", str(request.param))


@pytest.fixture(scope="session")
def fmu2(export):
    return export("default.fmu")
