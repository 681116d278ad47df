"""Two panels in one container (fmu-manipulation-toolbox, FMI 2.0): each moves in it as it does alone."""

import dataclasses
import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import BEAM, model
from exported import run_export
from fmpy import simulate_fmu
from masters import panel, worst

STEP, COUNT = 1e-4, 100
PANELS = {"floor": BEAM, "roof": dataclasses.replace(BEAM, length=0.9)}


def test_each_panel_moves_as_alone(tmp_path):
    pytest.importorskip("fmu_manipulation_toolbox", reason="fmpy-checks/requirements.txt brings it")
    plan = {"name": "vehicle.fmu", "step_size": STEP, "fmu": [], "input": [], "output": []}
    for name, beam in PANELS.items():
        ports = {"forces": [-0.3], "responses": [0.3]}
        done = run_export(model(beam), tmp_path / f"{name}.fmu", "--name", name, "--modes", "6", **ports)
        assert done.returncode == 0, done.stderr
        plan["fmu"].append(f"{name}.fmu")
        plan["input"].append([f"force_{name}", f"{name}.fmu", "force_1"])
        plan["output"].append([f"{name}.fmu", "acceleration_1", f"acceleration_{name}"])
    (tmp_path / "vehicle.json").write_text(json.dumps(plan))
    module = "from fmu_manipulation_toolbox.cli.fmucontainer import fmucontainer; fmucontainer()"
    words = [sys.executable, "-c", module, "-fmu-directory", str(tmp_path), "-container", "vehicle.json"]
    built = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert (tmp_path / "vehicle.fmu").exists(), built.stdout + built.stderr
    forces = {"floor": np.full(COUNT, 1.0), "roof": np.full(COUNT, -2.0)}
    result = simulate_fmu(
        str(tmp_path / "vehicle.fmu"), stop_time=COUNT * STEP, output_interval=STEP,
        start_values={f"force_{name}": values[0] for name, values in forces.items()},
        output=[f"acceleration_{name}" for name in PANELS],
    )
    for name in PANELS:
        with panel(tmp_path / f"{name}.fmu") as alone:
            expected = alone.initialize().run(forces[name], STEP)[2:]
        found = np.array([result[f"acceleration_{name}"][1:]])
        assert found.shape == expected.shape and worst(found, expected) < 1e-12, worst(found, expected)
