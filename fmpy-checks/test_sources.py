"""`export --sources`: C99 that FMPy compiles, with the numbers of the library.

FMPy's own build wants cmake (PyPI has it); without one, gcc compiles the files that the FMU lists.
"""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.build import build_platform_binary
from fmpy.validation import validate_fmu
from lxml import etree
from masters import REFUSED, panel
from exported import run_export
from test_connections import PLATE
from test_residual import beam
from test_ssp import SCHEMAS

# FMPy calls it by its name.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
WARNINGS = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2"]
BRACKET = {"effects": [{"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 400, "zeta": 0.05, "x": 0.1}]}
CANTILEVER = {"boundary": {"left": "clamped", "right": "free"}}
PANELS = {
    "beam": (beam(), ["--modes", "30"]),
    "resonator": (beam(**BRACKET), ["--modes", "6", "--residual", "none"]),
    "mounted": (beam(), ["--modes", "12", "--mount=a=-0.3,0,1e6,50", "--mount=b=0.3,0,3e5,20", "--gravity", "--pressure"]),
    "plate on a frame": (PLATE, ["--modes", "10", "--base-acceleration", "--rotations"]),
    "cantilever on a frame and a mount": (beam(**CANTILEVER), ["--modes", "6", "--base-acceleration", "--mount=tip=0.4,0,1e5,9"]),
}


def compiled(fmu, folder):
    """The unpacked FMU with its library."""
    extract(str(fmu), unzipdir=str(folder))
    if shutil.which("cmake"):
        build_platform_binary(folder, all_warnings=True)
    else:
        identifier = read_model_description(str(folder)).coSimulation.modelIdentifier
        platform = "linux64" if read_model_description(str(folder)).fmiVersion == "2.0" else "x86_64-linux"
        library = folder / "binaries" / platform / f"{identifier}.so"
        library.parent.mkdir(parents=True)
        files = read_model_description(str(folder)).buildConfigurations[0].sourceFileSets[0].sourceFiles
        words = ["gcc", *WARNINGS, "-fPIC", "-shared", *[folder / "sources" / file for file in files], "-o", library, "-lm"]
        subprocess.run(list(map(str, words)), check=True)
    return folder


@pytest.mark.skipif(not shutil.which("gcc"), reason="no gcc")
@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("name", PANELS)
def test_compiled_sources_give_the_numbers_of_the_library(tmp_path, name, version):
    content, options = PANELS[name]
    fmu, sources = tmp_path / "panel.fmu", tmp_path / "panel-sources.fmu"
    done = run_export(content, fmu, "--fmi", version, "--sources", *options, "--name", "floor", forces=[-0.3, 0.1], responses=[0.25])
    assert done.returncode == 0, done.stderr
    folder = compiled(sources, tmp_path / "unpacked")
    library, source = read_model_description(str(fmu)), read_model_description(str(sources))
    variables = {v.name: (v.causality, v.valueReference, v.unit) for v in source.modelVariables}
    others = {v.name: (v.causality, v.valueReference, v.unit) for v in library.modelVariables}
    assert variables == {name: others[name] for name in variables}
    inputs = [name for name, (causality, *_) in variables.items() if causality == "input"]
    outputs = [name for name, (causality, *_) in variables.items() if causality == "output"]
    assert {n for n, (c, *_) in others.items() if c in ("input", "output")} == {*inputs, *outputs}
    sizes = np.array([1e-5 if "displacement" in name else 1e-3 if "velocity" in name else 1.0 for name in inputs])
    for linear in (False, True):
        random = np.random.default_rng(3)
        steps = [1e-5] * 40 + [1e-3] * 40 + [3e-5] * 40
        values = [random.normal(size=len(inputs)) * sizes for _ in steps]
        runs = []
        for at in (fmu, folder):
            with panel(at) as instance:
                instance.initialize(force_linear=linear)
                time, motion = 0.0, []
                for step, value in zip(steps, values):
                    for name, number in zip(inputs, value):
                        instance.set(name, number)
                    instance.step(time, step)
                    time += step
                    motion.append(instance.get("time", *inputs, *outputs))
                runs.append(np.array(motion))
        errors = np.max(np.abs(runs[0] - runs[1]), axis=0) / np.max(np.abs(runs[0]), axis=0)
        assert np.max(errors) < 1e-12, dict(zip(["time", *inputs, *outputs], errors))


@pytest.mark.skipif(not shutil.which("gcc"), reason="no gcc")
@pytest.mark.parametrize("version", ["2", "3"])
def test_sources_compile_without_a_warning_and_refuse_as_an_fmu_should(tmp_path, version):
    fmu = tmp_path / "panel.fmu"
    options = ["--fmi", version, "--sources", "--mount=a=0.2,0,1e5,9", "--json"]
    done = run_export(beam(), fmu, *options, forces=[-0.3], responses=[0.25])
    assert json.loads(done.stdout)["sources"] == str(tmp_path / "panel-sources.fmu")
    sources = Path(tmp_path / "panel-sources.fmu")
    assert validate_fmu(str(sources)) == []
    with zipfile.ZipFile(sources) as archive:
        schema = {"2": "fmi2/fmi2ModelDescription.xsd", "3": "fmi3/fmi3ModelDescription.xsd"}[version]
        check = [("modelDescription.xml", schema)]
        check += [("sources/buildDescription.xml", "fmi3/fmi3BuildDescription.xsd")] if version == "3" else []
        for name, schema in check:
            etree.XMLSchema(etree.parse(str(SCHEMAS / "schema" / schema))).assertValid(etree.fromstring(archive.read(name)))
    folder = tmp_path / "unpacked"
    extract(str(sources), unzipdir=str(folder))
    file = next((folder / "sources").glob("fmi*.c"))
    # With a prefix, as a program that holds two panels links them; no name but the entry points' is told.
    prefix = f"-DFMI{version}_FUNCTION_PREFIX=floor_"
    subprocess.run(["gcc", *WARNINGS, prefix, "-c", str(file), "-o", str(tmp_path / "floor.o")], check=True)
    names = subprocess.run(["nm", "-g", "--defined-only", str(tmp_path / "floor.o")], check=True, capture_output=True, text=True)
    told = [line.split()[-1] for line in names.stdout.splitlines()]
    assert len(told) == {"2": 44, "3": 75}[version] and all(name.startswith(f"floor_fmi{version}") for name in told)
    needed = subprocess.run(["nm", "-u", str(tmp_path / "floor.o")], check=True, capture_output=True, text=True).stdout.split()
    allowed = {"calloc", "free", "memcpy", "memset", "strcmp", "strncpy", "sin", "cos", "exp", "fma", "sqrt", "log2", "ceil", "ldexp",
               "fmax", "sincos", "U", "_GLOBAL_OFFSET_TABLE_", "__stack_chk_fail", "memmove", "exp2"}
    assert set(needed) <= allowed, set(needed) - allowed
    compiled(sources, tmp_path / "built")
    with panel(tmp_path / "built") as instance:
        instance.initialize(stop_time=1.0)
        for wrong in (lambda: instance.set("force_1", np.nan), lambda: instance.set("acceleration_1", 1.0),
                      lambda: instance.step(0.5, 0.1), lambda: instance.step(0.0, -1.0), lambda: instance.step(0.0, 2.0),
                      lambda: instance.fmu.getFMUState()):
            with pytest.raises(REFUSED):
                wrong()
            assert instance.messages, wrong
        instance.step(0.0, 0.1)
    with pytest.raises(Exception):
        with panel(tmp_path / "built", guid="{wrong}"):
            pass
