"""FMUs in hosts with a floating-point environment of their own: `c_harness/hosts.c`, `hosts3.c`.

No call raises INVALID, DIVBYZERO or OVERFLOW, which some real-time hosts trap, nor leaves traps or rounding as others. Traps change no
bit of any number, another rounding no more than last digits.
"""

import re
import shutil
import subprocess
from pathlib import Path

import conftest
import fmpy
import plate_panel
import pytest
from exported import run_export
from fmpy import extract, read_model_description

HERE = Path(__file__).resolve().parent / "c_harness"
FLAGS = ["-std=gnu11", "-O1", "-g", "-Wall", "-Wextra", "-Werror", "-frounding-math"]
HEADERS = Path(fmpy.__file__).parent / "c-code"
PROGRAMS = {2: "hosts.c", 3: "hosts3.c"}

pytestmark = pytest.mark.skipif(
    not shutil.which("gcc") or fmpy.platform_tuple != "x86_64-linux", reason="needs gcc and Linux on x86-64"
)


def beam(boundary=None, effects=()):
    return conftest.model() | {"boundary": boundary or {}, "effects": [{"owner": "panel"} | effect for effect in effects]}


def plate(boundary=None, effects=()):
    return plate_panel.model() | {"boundary": boundary or {}, "effects": [{"owner": "panel"} | effect for effect in effects]}


def everywhere(edge):
    return dict.fromkeys(("left", "right"), edge)


EFFECTS = {
    "local-mass": {"mass": 0.03, "x": 0.11},
    "edge-mass": {"mass": 0.012},
    "stiffness-loss": {"loss": 0.3, "span": 0.1, "x": 0.2},
    "resonator": {"mass": 0.02, "frequency": 400.0, "zeta": 0.02, "x": -0.2},
    "rotary-inertia": {"factor": 2.2},
    "viscoelastic-core": {"strength": 0.2, "tau": 1e-4, "alpha": 0.6},
}


def effect(name):
    return {"id": name} | EFFECTS[name]


PANELS = {
    "beam": beam(),
    "beam, pinned": beam(everywhere("pinned")),
    "beam, clamped": beam(everywhere("clamped")),
    "beam, cantilever": beam({"left": "clamped"}),
    "beam, core and resonator": beam(effects=[effect("viscoelastic-core"), effect("resonator")]),
    "plate": plate(),
    "plate, pinned": plate(everywhere("pinned") | {"front": "pinned", "back": "pinned"}),
    "plate, cantilever": plate({"left": "clamped"}),
    "plate, arrays": plate(),
    "beam, all connections": beam({"left": "clamped"}),
    "plate, all connections": plate({"left": "clamped"}),
    **{f"beam, {name}": beam(effects=[effect(name)]) for name in EFFECTS},
    **{f"plate, {name}": plate(effects=[effect(name)]) for name in EFFECTS},
}


def kind_of(variable, states, rates):
    if variable.type == "Boolean":
        return "b"
    if variable.causality in ("input", "output"):
        return variable.causality[0]
    if variable.causality == "parameter":
        return "t" if variable.variability == "tunable" else "p"
    return "s" if variable.name in states else "d" if variable.name in rates else None


def table(description):
    """What `of_kind` of hosts.h reads; parameters with another value that a panel may have."""
    rates = {unknown.variable.name for unknown in description.derivatives}
    states = {unknown.variable.derivative.name for unknown in description.derivatives}
    lines = []
    for variable in description.modelVariables:
        kind = kind_of(variable, states, rates)
        size = int(variable.dimensions[0].start) if variable.dimensions else 1
        value = 0.0
        if kind in ("p", "t"):
            value = 1.02 * float(variable.start) or 0.01
        if kind:
            lines.append(f"{kind} {variable.valueReference} {size} {value:.17g}\n")
    return "".join(lines)


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hosts")
    for source in PROGRAMS.values():
        words = ["gcc", *FLAGS, f"-I{HEADERS}", f"-I{conftest.ROOT / 'benches/fmu_c'}", HERE / source]
        subprocess.run(list(map(str, [*words, "-o", folder / Path(source).stem, "-ldl", "-lm"])), check=True)
    return folder


@pytest.mark.parametrize("version", PROGRAMS)
@pytest.mark.parametrize("name", PANELS)
def test_no_call_traps_or_changes_the_hosts_environment(programs, tmp_path, name, version):
    options = ["--arrays"] if "arrays" in name else []
    joined = ["--mount=a=0.3,0,1e5,9", "--rotations", "--gravity", "--pressure", "--base-acceleration"]
    options += joined if "connections" in name else []
    if "arrays" in name and version == 2:
        pytest.skip("FMI 2.0 has no arrays")
    on_plate = name.startswith("plate")
    places = {"forces": [(-0.3, 0.1), (0.1, -0.05)] if on_plate else [-0.3, 0.1], "responses": [(0.3, -0.1)] if on_plate else [0.3]}
    fmu = tmp_path / "x.fmu"
    done = run_export(PANELS[name], fmu, "--modes", "3", "--fmi", str(version), *options, **places)
    assert done.returncode == 0, done.stderr
    unpacked = Path(extract(str(fmu), unzipdir=str(tmp_path / "unpacked")))
    description = read_model_description(str(unpacked))
    variables = tmp_path / "variables.txt"
    variables.write_text(table(description))
    library = next((unpacked / "binaries").glob("*/*.so"))
    resources = unpacked / "resources"
    token = description.guid if version == 2 else description.instantiationToken
    where = resources.as_uri() if version == 2 else f"{resources}/"
    program = programs / Path(PROGRAMS[version]).stem
    words = [program, library, token, where, variables]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stdout) == (0, ""), done.stdout[:4000]


@pytest.mark.parametrize("version", PROGRAMS)
def test_every_function_of_the_standard_is_called(version):
    header = (HEADERS / f"fmi{version}FunctionTypes.h").read_text()
    asked = set(re.findall(rf"(fmi{version}\w+)TYPE\b", header)) - {f"fmi{version}Callback"}
    called = set(re.findall(rf"\b(fmi{version}\w+)\b", (HERE / PROGRAMS[version]).read_text()))
    assert len(asked) == {2: 44, 3: 75}[version]
    assert asked <= called, asked - called
