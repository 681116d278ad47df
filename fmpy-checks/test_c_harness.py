"""The FMU through C, without FMPy between: `c_harness/`, also under valgrind where there is one."""

import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import fmpy
import pytest
from conftest import BEAM, FORCES, RESPONSES, ROOT, ZETAS
from fmpy import extract, read_model_description
from modal_sum import modes_at

HERE = Path(__file__).resolve().parent / "c_harness"
PROPAGATOR = ROOT / "benches/fmu_c"
FLAGS = ["-std=c11", "-O1", "-g", "-Wall", "-Wextra", "-Werror"]

# The parameter that is set anew, and its other value.
CHANGED, VALUE = "thickness", 0.027
# The one that is set under way, and its other value: of the second flexible mode.
TUNABLE, TUNED = "damping_ratio_2", 0.05

pytestmark = pytest.mark.skipif(not shutil.which("gcc"), reason="needs gcc")


@pytest.fixture(scope="module")
def command(fmu, tmp_path_factory):
    """The call of the harness on the FMU, unpacked where a careless importer stumbles; the number of instances lacks."""
    folder = tmp_path_factory.mktemp("50% of ü")
    unpacked = Path(extract(str(fmu), unzipdir=str(folder / "a fmu")))
    description = read_model_description(str(unpacked))
    is_three = description.fmiVersion.startswith("3")
    program = folder / "checks"
    headers = Path(fmpy.__file__).parent / "c-code"
    sources = [HERE / ("checks3.c" if is_three else "checks.c"), PROPAGATOR / "propagator.c"]
    words = ["gcc", *FLAGS, f"-I{headers}", f"-I{PROPAGATOR}", *sources, "-o", program, "-ldl", "-lm"]
    subprocess.run(list(map(str, words)), check=True)
    # The numbers are held against modes of our own, not the FMU's.
    text, changed, tuned = (folder / f"{kind}.txt" for kind in ("modes", "changed-modes", "tuned-modes"))
    zetas = [ZETAS[0], TUNED, *ZETAS[2:]]
    for file, beam, ratios in ((text, BEAM, ZETAS), (changed, replace(BEAM, **{CHANGED: VALUE}), ZETAS), (tuned, BEAM, zetas)):
        modes = modes_at(beam, ratios, FORCES[0], RESPONSES[0])
        file.write_text("".join(f"{omega:.17g} {zeta:.17g} {shape:.17g} 1.0\n" for omega, zeta, shape in modes))
    references = {v.name: str(v.valueReference) for v in description.modelVariables}
    library = next((unpacked / "binaries").glob("*/*.so"))
    resources = unpacked / "resources"
    where = [f"{resources}/" if is_three else resources.as_uri(), text]
    names = [references[name] for name in ("force_1", "acceleration_1", "displacement_1")]
    if is_three:
        rates = [unknown.variable for unknown in description.derivatives]
        names += [",".join(str(v.valueReference) for v in list) for list in ([v.derivative for v in rates], rates)]
    names += [references[CHANGED], VALUE, changed, references[TUNABLE], TUNED, tuned]
    token = description.instantiationToken if is_three else description.guid
    return list(map(str, [program, library, token, *where, *names]))


def test_numbers_reset_states_derivatives_and_2000_instances(command):
    done = subprocess.run([*command, "2000"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "")


@pytest.mark.skipif(not shutil.which("valgrind"), reason="needs valgrind")
def test_valgrind_finds_no_leak_and_no_wrong_access(command):
    watch = ["valgrind", "--quiet", "--error-exitcode=99", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect"]
    done = subprocess.run([*watch, *command, "20"], capture_output=True, text=True)
    assert "failed" not in done.stdout.replace("failed: settled > 0 && resident() <= settled + 32", "")
    assert done.returncode != 99, done.stderr
