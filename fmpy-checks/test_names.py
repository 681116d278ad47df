"""Names of the panel, of its ports, and numbers of its effects as parameters."""

import os
import subprocess

import numpy as np
import pytest
from conftest import model
from exported import ROOT, run_export
from fmpy import extract, read_model_description
from fmpy.validation import validate_fmu
from masters import panel

BRACKET = {"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 400.0, "zeta": 0.05, "x": 0.1}


@pytest.mark.parametrize("version", ["2", "3"])
def test_two_panels_in_one_folder_keep_their_libraries(tmp_path, version):
    for name, content in (("floor_left", model()), ("floor_right", model() | {"name": "floor_right"})):
        options = ["--fmi", version] + ["--name", name] * (name == "floor_left")
        done = run_export(content, tmp_path / f"{name}.fmu", *options, forces=[-0.3], responses=[0.3])
        assert done.returncode == 0, done.stderr
        description = read_model_description(str(tmp_path / f"{name}.fmu"))
        assert description.modelName == description.coSimulation.modelIdentifier == name
        assert description.modelExchange.modelIdentifier == name
        assert validate_fmu(str(tmp_path / f"{name}.fmu")) == []
        extract(str(tmp_path / f"{name}.fmu"), unzipdir=str(tmp_path / "both"))
    assert len(list((tmp_path / "both/binaries").glob("*/floor_*.so"))) == 2


def test_ports_have_names_and_simulate_finds_them(tmp_path):
    words = ["--force", "seat=-0.3", "--force", "rail=0.1", "--response", "seat=-0.3", "--response", "0.2"]
    fmu = tmp_path / "named.fmu"
    done = run_export(model(), fmu, *words)
    assert done.returncode == 0, done.stderr
    names = {v.name: v.causality for v in read_model_description(str(fmu)).modelVariables}
    assert {name for name, kind in names.items() if kind == "input"} == {"force_seat", "force_rail"}
    assert {name for name, kind in names.items() if kind == "output"} == {
        f"{motion}_{port}" for motion in ("acceleration", "velocity", "displacement") for port in ("seat", "2")}
    assert {"force_seat_x", "force_rail_y", "response_seat_x", "response_2_y"} <= set(names)
    history = tmp_path / "force.csv"
    history.write_text("time_s,force_1_n,force_2_n\n" + "".join(f"{n * 1e-4!r},{n % 3},{-n % 5}\n" for n in range(30)))
    command = run_command()
    moved = [subprocess.run([command, "simulate", str(source), "--force-file", str(history), *options], capture_output=True, text=True)
             for source, options in ((fmu, []), (fmu.with_suffix(".json"), ["--force=-0.3", "--force=0.1", "--response=-0.3", "--response=0.2"]))]
    assert [done.returncode for done in moved] == [0, 0], moved
    one, other = (np.loadtxt(done.stdout.splitlines()[1:], delimiter=",") for done in moved)
    assert np.all(np.abs(one - other) <= 1e-9 * np.abs(other).max(axis=0))


def run_command():
    return os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))


@pytest.mark.parametrize("options, said", [
    (["--name", "floor left"], "must be of letters, digits and _"),
    (["--name", "2a"], "must be of letters, digits and _"),
    (["--force", "seat left=0.1"], "is no name of letters, digits and _"),
    (["--force", "a=0.1", "--force", "a=0.2"], 'two variables are called "force_a"'),
    (["--force", "linear=0.1"], 'two variables are called "force_linear"'),
    (["--force", "a=0.1", "--force", "a_x=0.2"], 'two variables are called "force_a_x"'),
    (["--fmi", "3", "--arrays", "--force", "a=0.1"], "leave out --arrays or the names"),
    (["--force", "a=0.5"], "lies off the piece"),
])
def test_names_that_cannot_be_are_refused(tmp_path, options, said):
    done = run_export(model(), tmp_path / "x.fmu", *options, "--response=0.3", *([] if "--force" in options else ["--force=0.1"]))
    assert done.returncode == 2 and said in done.stderr, done.stderr
    assert not (tmp_path / "x.fmu").exists()


def test_a_model_file_with_a_wrong_name_is_refused(tmp_path):
    done = run_export(model() | {"name": "left floor"}, tmp_path / "x.fmu", forces=[0.1], responses=[0.2])
    assert done.returncode == 2 and 'name = "left floor": must be of letters, digits and _' in done.stderr


@pytest.mark.parametrize("version", ["2", "3"])
def test_numbers_of_effects_are_set_as_constants_are(tmp_path, version):
    """Set in the FMU, or written in the model file: the same motion."""
    ports = {"forces": [-0.3], "responses": [0.3]}
    changed = {"mass": 0.03, "frequency": 500.0, "x": -0.2}
    fmus = [tmp_path / "as_exported.fmu", tmp_path / "as_written.fmu"]
    for fmu, bracket in zip(fmus, (BRACKET, BRACKET | changed)):
        done = run_export(model() | {"effects": [bracket]}, fmu, "--fmi", version, "--modes", "6", **ports)
        assert done.returncode == 0, done.stderr
    variables = {v.name: v for v in read_model_description(str(fmus[0])).modelVariables}
    for name, unit in (("mass", "kg"), ("frequency", "Hz"), ("zeta", "1"), ("x", "m")):
        variable = variables[f"resonator_{name}"]
        assert (variable.causality, variable.variability, variable.unit) == ("parameter", "fixed", unit)
        assert float(variable.start) == BRACKET[name]
    runs = []
    for fmu, values in zip(fmus, (changed, {})):
        with panel(fmu) as instance:
            for name, value in values.items():
                instance.set(f"resonator_{name}", value)
            runs.append(instance.initialize().run(np.cos(0.2 * np.arange(60)), 1e-4))
    assert np.max(np.abs(runs[0] - runs[1]) / np.abs(runs[1]).max(axis=1, keepdims=True)) < 1e-9
    with panel(fmus[0]) as instance:
        instance.set("resonator_frequency", 1e9)
        with pytest.raises(Exception):
            instance.initialize()
        assert "resonator: frequency" in instance.messages[-1], instance.messages
