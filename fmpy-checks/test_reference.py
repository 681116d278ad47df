"""The reference solution inside each FMU: FMPy, told what stands beside it, gives its numbers."""

import csv
import io
import zipfile

import numpy as np
import pytest
from conftest import BEAM, FORCES, RESPONSES, ZETAS
from fmpy import simulate_fmu
from modal_sum import modes_at, staircase


def reference(fmu):
    """Columns by name, and the settings."""
    with zipfile.ZipFile(fmu) as archive:
        rows = list(csv.reader(io.StringIO(archive.read("documentation/Reference.csv").decode())))
        lines = archive.read("documentation/Reference.opt").decode().splitlines()
    columns = {name: np.array(values, dtype=float) for name, *values in zip(*rows)}
    return columns, dict(line.split(", ", 1) for line in lines)


@pytest.mark.parametrize("residual", ["attachment", "none"])
@pytest.mark.parametrize("version", ["2", "3"])
def test_fmpy_gives_the_reference(export, version, residual):
    fmu = export(f"reference-{version}-{residual}.fmu", "--fmi", version, "--residual", residual)
    columns, settings = reference(fmu)
    step, count = float(settings["StepSize"]), len(columns["time"])
    assert step * (count - 1) == pytest.approx(float(settings["StopTime"]), rel=1e-12)
    outputs = [name for name in columns if name not in ("time", "force_1")]
    assert len(outputs) == 3 * len(RESPONSES)
    signals = np.array(list(zip(columns["time"], columns["force_1"])), dtype=[("time", float), ("force_1", float)])
    result = simulate_fmu(
        str(fmu), stop_time=float(settings["StopTime"]), output_interval=step, input=signals, output=outputs,
        fmi_type="CoSimulation",
    )
    for name in outputs:
        found, expected = result[name][1:count], columns[name][1:]
        assert np.max(np.abs(found - expected)) < 1e-9 * np.max(np.abs(expected)), name


def test_val_the_reference_is_the_modal_sum(export):
    columns, settings = reference(export("reference-of-modes.fmu"))
    expected = staircase(modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[1]), columns["force_1"][:-1], float(settings["StepSize"]))
    for row, name in enumerate(("displacement_2", "velocity_2", "acceleration_2")):
        assert np.max(np.abs(columns[name][1:] - expected[row])) < 1e-9 * np.max(np.abs(expected[row])), name
    assert np.max(columns["force_1"]) == 100.0
