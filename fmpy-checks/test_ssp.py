"""`export --ssp`: valid by the standard's schemas, run by FMPy as the FMU alone is, with samples that change its constants."""

import io
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from conftest import model
from exported import run_export
from fmpy import simulate_fmu
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd, read_ssv
from lxml import etree

SCHEMAS = Path(fmpy.__file__).parent
FMI = {"2.0": "fmi2/fmi2ModelDescription.xsd", "3.0": "fmi3/fmi3ModelDescription.xsd"}
PORTS = ["--force", "seat=-0.3", "--force", "0.1", "--response", "seat=-0.3", "--response", "0.2"]
EFFECT = {"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 400.0, "zeta": 0.05, "x": 0.1}


def validated(content, schema):
    document = etree.parse(io.BytesIO(content))
    etree.XMLSchema(etree.parse(str(SCHEMAS / schema))).assertValid(document)
    return document.getroot()


def exported(folder, *options, **changes):
    content = model() | changes
    content["constants"]["e_x"] = {"value": content["constants"]["e_x"], "std": 2e8}
    fmu = folder / "floor.fmu"
    done = run_export(content, fmu, "--modes", "6", "--ssp", *PORTS, *options)
    assert done.returncode == 0, done.stderr
    return fmu, fmu.with_suffix(".ssp")


@pytest.mark.parametrize("flavour", [["--fmi", "2"], ["--fmi", "3"], ["--residual", "none"]], ids=["fmi2", "fmi3", "none"])
@pytest.mark.parametrize("effects", [[], [EFFECT]], ids=["bare", "resonator"])
def test_every_xml_is_valid_by_its_schema(tmp_path, flavour, effects):
    fmu, ssp = exported(tmp_path, "--name", "floor", "--samples", "2", *flavour, effects=effects)
    with zipfile.ZipFile(ssp) as archive:
        names = archive.namelist()
        structure = archive.read("SystemStructure.ssd")
        validated(structure, "ssp/schema/SystemStructureDescription.xsd")
        assert b" xmlns:ssc=" in structure and b"<ssc:Real" in structure
        sets = [name for name in names if name.endswith(".ssv")]
        assert sets == [f"resources/{name}.ssv" for name in ("parameters", "sample-1", "sample-2")]
        for name in sets:
            validated(archive.read(name), "ssp/schema/SystemStructureParameterValues.xsd")
        assert archive.read("resources/floor.fmu") == fmu.read_bytes()
    with zipfile.ZipFile(fmu) as archive:
        description = archive.read("modelDescription.xml")
        version = etree.fromstring(description).get("fmiVersion")
        validated(description, f"schema/{FMI[version]}")
        if version == "3.0":
            terminals = archive.read("terminalsAndIcons/terminalsAndIcons.xml")
            validated(terminals, "schema/fmi3/fmi3TerminalsAndIcons.xsd")


def test_fmpy_runs_it_as_the_fmu_alone(tmp_path):
    fmu, ssp = exported(tmp_path)
    system = read_ssd(str(ssp)).system
    assert [connector.name for connector in system.connectors][:2] == ["force_seat", "force_2"]
    step = 1e-5
    signals = np.zeros(3, dtype=[("time", float), ("force_seat", float)])
    signals["time"], signals["force_seat"] = [0.0, 1e-3, 2e-3], [1.0, 1.0, 1.0]
    alone = simulate_fmu(str(fmu), stop_time=2e-3, output_interval=step, input=signals, output=["acceleration_2"])
    forces = {"force_seat": lambda time: 1.0, "force_2": lambda time: 0.0}
    whole = simulate_ssp(str(ssp), stop_time=1.9995e-3, step_size=step, input=forces)
    name = next(name for name in whole.dtype.names if name.endswith("acceleration_2"))
    found, expected = np.array(whole[name]), np.array(alone["acceleration_2"])
    # FMPy hands an SSP's input on after the step, so the first has none, and writes what comes after a step beside the time before it.
    found, expected = found[1:], expected[1 : len(found)]
    assert len(found) == len(expected) > 100 and np.max(np.abs(found - expected)) < 1e-9 * np.max(np.abs(expected))


def test_samples_are_drawn_by_the_deviations(tmp_path):
    _, ssp = exported(tmp_path, "--samples", "40")
    values = lambda name: {p.name: float(p.value) for p in read_ssv(str(ssp), f"resources/{name}.ssv").parameters}  # noqa: E731
    base = values("parameters")
    assert base["e_x"] == 1.067e10 and {"length", "g_zx", "damping_ratio_1", "force_seat_x"} <= set(base)
    drawn = [values(f"sample-{n + 1}") for n in range(40)]
    assert all({name: value for name, value in one.items() if name != "e_x"} ==
               {name: value for name, value in base.items() if name != "e_x"} for one in drawn)
    share = np.array([(one["e_x"] - base["e_x"]) / 2e8 for one in drawn])
    # Five standard errors of mean and deviation.
    assert abs(share.mean()) < 0.8 and 0.4 < share.std() < 1.6 and len(set(share)) == 40


@pytest.mark.parametrize("options, said", [
    (["--samples", "3"], "--ssp"), (["--ssp", "--samples", "-1"], "must be a whole number"),
    (["--ssp", "--samples", "2"], "no constant of this model has a standard deviation"),
])
def test_samples_that_cannot_be_are_refused(tmp_path, options, said):
    done = run_export(model(), tmp_path / "x.fmu", *PORTS, *options)
    assert done.returncode == 2 and said in done.stderr, done.stderr
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".json"]
