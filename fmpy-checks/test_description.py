"""What FMPy reads from modelDescription.xml."""

import zipfile

import pytest
from conftest import FORCES, RESPONSES, ZETAS
from fmpy import read_model_description
from fmpy.validation import validate_fmu


# The two rigid modes are modes too.
MODES = 2 + len(ZETAS)
DERIVED = {"m.kg^(1/2)": "m.kg^(1/2)/s", "m.kg^(1/2)/s": "m.kg^(1/2)/s2"}


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
    for n in range(MODES):
        for state, unit in (("position", "m.kg^(1/2)"), ("velocity", "m.kg^(1/2)/s")):
            name = f"modal_{state}_{n + 1}"
            expected |= {name: ("local", unit), f"der({name})": ("local", DERIVED[unit])}
    sizes = {"length": "m", "width": "m", "thickness": "m", "mass_per_area": "kg/m2", "e_x": "Pa", "g_zx": "Pa"}
    sizes |= {f"damping_ratio_{n + 1}": "1" for n in range(len(ZETAS))}
    places = [f"force_{n + 1}" for n in range(len(FORCES))] + [f"response_{n + 1}" for n in range(len(RESPONSES))]
    sizes |= {f"{place}_{axis}": "m" for place in places for axis in "xy"}
    expected |= {name: ("parameter", unit) for name, unit in sizes.items()}
    assert {name: (v.causality, v.unit) for name, v in variables.items()} == expected


def test_base_units(fmu):
    units = {unit.name: unit.baseUnit for unit in read_model_description(str(fmu)).unitDefinitions}
    # FMI has whole exponents only: the units of modal coordinates are said by name alone.
    exponents = {name: (base.kg, base.m, base.s) for name, base in units.items() if base}
    assert all("(1/2)" in name or name == "1" for name, base in units.items() if not base)
    assert exponents == {
        "kg/m2": (1, -2, 0), "kg": (1, 0, 0), "Hz": (0, 0, -1),
        "Pa": (1, -1, -2),
        "s": (0, 0, 1), "N": (1, 1, -2), "m/s2": (0, 1, -2), "m/s": (0, 1, -1), "m": (0, 1, 0)}


@pytest.mark.parametrize("part", ["outputs", "initialUnknowns"])
def test_accelerations_alone_depend_on_forces(fmu, part):
    unknowns = [u for u in getattr(read_model_description(str(fmu)), part) if u.variable.causality == "output"]
    assert len(unknowns) == 3 * len(RESPONSES)
    for unknown in unknowns:
        forces = [v.name for v in unknown.dependencies if v.causality == "input"]
        direct = unknown.variable.name.startswith("acceleration")
        assert forces == ([f"force_{n + 1}" for n in range(len(FORCES))] if direct else [])


def test_each_state_has_its_derivative_and_a_nominal(fmu):
    description = read_model_description(str(fmu))
    assert description.numberOfContinuousStates == 2 * MODES
    for unknown in description.derivatives:
        state = unknown.variable.derivative
        assert unknown.variable.name == f"der({state.name})"
        assert float(state.nominal) > 0.0


def test_the_archive_has_documentation_and_an_executable_library(fmu):
    with zipfile.ZipFile(fmu) as archive:
        assert "documentation/index.html" in archive.namelist()
        libraries = [info for info in archive.infolist() if info.filename.startswith("binaries/")]
    assert libraries and all(library.external_attr >> 16 & 0o111 == 0o111 for library in libraries)
