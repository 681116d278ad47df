"""What FMPy reads from modelDescription.xml."""

import zipfile

import pytest
from conftest import FORCES, RESPONSES
from fmpy import read_model_description
from fmpy.validation import validate_fmu


def test_fmpy_finds_no_problem(fmu):
    assert validate_fmu(str(fmu)) == []


def test_fmi_2_is_the_default(fmu2):
    assert read_model_description(str(fmu2)).fmiVersion == "2.0"


def test_every_variable_is_there_with_its_unit(fmu):
    variables = {v.name: v for v in read_model_description(str(fmu)).modelVariables}
    units = {"acceleration": "m/s2", "velocity": "m/s", "displacement": "m"}
    expected = {f"force_{n + 1}": ("input", "N") for n in range(len(FORCES))}
    for word, unit in units.items():
        expected |= {f"{word}_{n + 1}": ("output", unit) for n in range(len(RESPONSES))}
    expected |= {"time": ("independent", "s"), "force_linear": ("parameter", None)}
    assert {name: (v.causality, v.unit) for name, v in variables.items()} == expected


def test_base_units(fmu):
    units = {unit.name: unit.baseUnit for unit in read_model_description(str(fmu)).unitDefinitions}
    exponents = {name: (base.kg, base.m, base.s) for name, base in units.items()}
    assert exponents == {"s": (0, 0, 1), "N": (1, 1, -2), "m/s2": (0, 1, -2), "m/s": (0, 1, -1), "m": (0, 1, 0)}


@pytest.mark.parametrize("part", ["outputs", "initialUnknowns"])
def test_accelerations_depend_on_every_force_and_nothing_else_does(fmu, part):
    unknowns = getattr(read_model_description(str(fmu)), part)
    assert len(unknowns) == 3 * len(RESPONSES)
    for unknown in unknowns:
        names = [v.name for v in unknown.dependencies]
        direct = unknown.variable.name.startswith("acceleration")
        assert names == ([f"force_{n + 1}" for n in range(len(FORCES))] if direct else [])


def test_the_archive_has_documentation_and_an_executable_library(fmu):
    with zipfile.ZipFile(fmu) as archive:
        assert "documentation/index.html" in archive.namelist()
        libraries = [info for info in archive.infolist() if info.filename.startswith("binaries/")]
    assert len(libraries) == 1 and libraries[0].external_attr >> 16 & 0o111 == 0o111
