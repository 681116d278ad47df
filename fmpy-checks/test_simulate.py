"""`orthopanel simulate MODEL` against the FMU of the same model, driven by FMPy: one panel, one motion."""

import csv
import json
import os
import subprocess

import numpy as np
import pytest
from conftest import model as beam
from exported import ROOT, run_export
from masters import panel
from plate_panel import model as plate

STEP = 2e-5
# A blow, then a force that stays: what the modes left out add follows both at once.
FORCE = np.concatenate([np.sin(np.pi * np.arange(12) / 12), np.full(28, 0.4)])
CANTILEVER = {"left": "clamped"}
CARRYING = {"effects": [{"id": "local-mass", "owner": "panel", "mass": 0.05, "x": 0.1}]}


@pytest.mark.parametrize("content, force, response", [
    (beam(), "0.39", "0.39"),
    (beam() | {"boundary": CANTILEVER}, "0.39", "0.2"),
    (beam() | CARRYING, "0.39", "0.39"),
    (plate(), "0.3,0.1", "0.3,0.1"),
    (plate() | {"boundary": CANTILEVER}, "0.39,0.1", "0.2,-0.1"),
], ids=["beam", "cantilever", "mass", "plate", "cantilever-plate"])
def test_simulate_moves_as_the_fmu_does(content, force, response, tmp_path):
    ports = {"forces": [force], "responses": [response]}
    words = {kind: [tuple(float(x) for x in place.split(",")) for place in places] for kind, places in ports.items()}
    fmu = tmp_path / "panel.fmu"
    done = run_export(content, fmu, "--modes", "4", **words)
    assert done.returncode == 0, done.stderr
    history = tmp_path / "force.csv"
    history.write_text("time_s,force_n\n" + "".join(f"{n * STEP!r},{value!r}\n" for n, value in enumerate(FORCE.tolist())))
    source, moved = tmp_path / "model.json", tmp_path / "moved.csv"
    source.write_text(json.dumps(content))
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    done = subprocess.run([command, "simulate", str(source), "--force-file", str(history), "-o", str(moved), "--modes", "4",
                           "--hold", "held", f"--force={force}", f"--response={response}"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader(moved.open()))
    found = np.array([[float(row[name]) for row in rows] for name in ("displacement_m", "velocity_m_s", "acceleration_m_s2")])
    expected = np.empty_like(found)
    with panel(fmu) as instance:
        instance.initialize()
        for n, value in enumerate(FORCE):
            instance.set("force_1", value)
            expected[:, n] = instance.get("displacement_1", "velocity_1", "acceleration_1")
            instance.step(n * STEP, STEP)
    size = np.max(np.abs(expected), axis=1, keepdims=True)
    assert np.all(np.abs(found - expected) < 1e-9 * size)


def test_an_fmu_of_arrays_is_stepped_as_one_of_scalars(tmp_path):
    history = tmp_path / "force.csv"
    history.write_text("time_s,force_n\n" + "".join(f"{n * STEP!r},{value!r}\n" for n, value in enumerate(FORCE.tolist())))
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    moved = []
    for name, options in (("scalars", ()), ("arrays", ("--arrays",))):
        fmu = tmp_path / f"{name}.fmu"
        done = run_export(beam(), fmu, "--modes", "4", "--fmi", "3", *options, forces=[(0.39, 0.0)], responses=[(0.2, 0.0), (0.39, 0.0)])
        assert done.returncode == 0, done.stderr
        words = [command, "simulate", str(fmu), "--force-file", str(history), "-o", str(tmp_path / f"{name}.csv")]
        done = subprocess.run(words, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        moved.append((tmp_path / f"{name}.csv").read_text())
    assert moved[0] == moved[1] and moved[0].count("\n") == len(FORCE) + 1
