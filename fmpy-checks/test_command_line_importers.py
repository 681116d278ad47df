"""Importers that are programs: fmusim, OMSimulator and the FMU compliance checker give FMPy's numbers.

Each is named by an environment variable or stands on the PATH; without it its tests are skipped (README.md says how they were built).
"""

import csv
import json
import os
import shutil
import subprocess

import numpy as np
import pytest
from exported import ROOT, run_export
from masters import OUTPUTS, panel, worst

STEP, COUNT = 1e-4, 200
FORCES = np.sin(0.37 * np.arange(COUNT + 1)) + 0.3 * (np.arange(COUNT + 1) % 5 == 0)
NAMES = [f"{output}_1" for output in OUTPUTS]
# Sixteen or seventeen digits of numbers and of the sums of step sizes.
TOLERANCE = 1e-11


def program(name, variable):
    found = os.environ.get(variable) or shutil.which(name)
    if not found:
        pytest.skip(f"no {name}: neither on the PATH nor named by {variable}")
    return found


@pytest.fixture
def forces(tmp_path):
    path = tmp_path / "forces.csv"
    lines = [f"{n * STEP!r},{force!r}\n" for n, force in enumerate(FORCES.tolist())]
    path.write_text('"time","force_1"\n' + "".join(lines))
    return path


def ran(*words):
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def motion(path):
    """Rows of the outputs after each step."""
    header, *rows = csv.reader(path.read_text().splitlines())
    table = np.array(rows, dtype=float)
    assert len(table) == COUNT + 1
    return table[1:, [header.index(name) for name in NAMES]].T


def in_fmpy(fmu):
    with panel(fmu) as instance:
        return instance.initialize().run(FORCES[:-1], STEP)


def test_fmusim_agrees_with_fmpy(fmu, forces, tmp_path):
    fmusim, results = program("fmusim", "FMUSIM"), tmp_path / "results.csv"
    ran(fmusim, "--interface-type", "cs", "--stop-time", COUNT * STEP, "--output-interval", STEP, "--input-file", forces,
        "--output-file", results, fmu)
    found, expected = motion(results), in_fmpy(fmu)
    assert np.all(worst(found, expected) < TOLERANCE), worst(found, expected)


def test_fmusim_integrates_with_cvode(fmu, tmp_path):
    """A held force; steps of the solver at a tolerance of 1e-9 beside exact ones."""
    fmusim, results = program("fmusim", "FMUSIM"), tmp_path / "results.csv"
    ran(fmusim, "--interface-type", "me", "--solver", "cvode", "--tolerance", "1e-9", "--stop-time", COUNT * STEP,
        "--output-interval", STEP, "--start-value", "force_1", "1", "--output-file", results, fmu)
    with panel(fmu) as instance:
        expected = instance.initialize().run(np.ones(COUNT), STEP)
    assert np.all(worst(motion(results), expected) < 1e-5), worst(motion(results), expected)


@pytest.mark.parametrize("kind", ["cs", "me"])
def test_the_compliance_checker_has_nothing_to_say(fmu2, forces, tmp_path, kind):
    """FMI 2.0, which is the last that it reads; in model exchange it takes steps of Euler's, whose numbers say nothing."""
    checker, results = program("fmuCheck.linux64", "FMU_CHECKER"), tmp_path / "results.csv"
    said = ran(checker, "-k", kind, "-h", STEP, "-s", COUNT * STEP, "-f", "-i", forces, "-o", results, fmu2)
    assert "FMU reported:\n\t0 warning(s) and error(s)" in said and "\t0 Warning(s)\n\t0 Error(s)" in said, said
    if kind == "cs":
        found, expected = motion(results), in_fmpy(fmu2)
        assert np.all(worst(found, expected) < TOLERANCE), worst(found, expected)


# It writes twelve digits.
TWELVE_DIGITS = 1e-10


def test_omsimulator_runs_an_ssp_as_fmpy_runs_the_fmu(tmp_path):
    """The rail car's floor by `export --ssp`, at the step that its annotation names, with nothing to complain of."""
    omsimulator = program("OMSimulator", "OMSIMULATOR")
    fmu = tmp_path / "floor.fmu"
    done = run_export(json.loads((ROOT / "examples/rail-car/floor.json").read_text()), fmu, "--name", "floor", "--modes", "20", "--ssp")
    assert done.returncode == 0, done.stderr
    step, count = 1e-5, 100
    (tmp_path / "run.lua").write_text(f"""
        oms_importFile("floor.ssp")
        oms_setReal("floor.system.force_1", 1.0)
        oms_setResultFile("floor", "results.csv")
        oms_setStopTime("floor", {count * step})
        oms_instantiate("floor")
        oms_initialize("floor")
        oms_simulate("floor")
        oms_terminate("floor")
        oms_delete("floor")
    """)
    said = subprocess.run([omsimulator, "run.lua"], capture_output=True, text=True, timeout=120, cwd=tmp_path)
    # Its own schema, which a build that is not installed does not find, is no matter of the file.
    told = [line for line in said.stdout.splitlines() if line.startswith(("warning", "error")) and "could not load the ssd schema" not in line]
    assert said.returncode == 0 and not told, said.stdout + said.stderr
    header, *rows = csv.reader((tmp_path / "results.csv").read_text().splitlines())
    at = [header.index(f"floor.system.floor.{name}") for name in NAMES]
    # It writes each instant twice, before its step and after.
    by_step = {round(float(row[0]) / step): [float(row[index]) for index in at] for row in rows}
    found = np.array([by_step[n + 1] for n in range(count)]).T
    with panel(fmu) as instance:
        expected = instance.initialize().run(np.ones(count), step)
    assert np.all(worst(found, expected) < TWELVE_DIGITS), worst(found, expected)
