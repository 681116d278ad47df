"""The FMU through C, without FMPy between: `c_harness/checks.c`, also under valgrind where there is one."""

import shutil
import subprocess
from pathlib import Path

import fmpy
import pytest
from fmpy import extract, read_model_description

HERE = Path(__file__).resolve().parent / "c_harness"
FLAGS = ["-std=c11", "-O1", "-g", "-Wall", "-Wextra", "-Werror"]

pytestmark = pytest.mark.skipif(not shutil.which("gcc"), reason="needs gcc")


@pytest.fixture(scope="module")
def command(fmu2, tmp_path_factory):
    """The call of the harness on the FMU, unpacked where a careless importer stumbles; the number of instances lacks."""
    folder = tmp_path_factory.mktemp("50% of ü")
    program = folder / "checks"
    headers = Path(fmpy.__file__).parent / "c-code"
    words = ["gcc", *FLAGS, f"-I{headers}", HERE / "checks.c", "-o", program, "-ldl", "-lm"]
    subprocess.run(list(map(str, words)), check=True)
    unpacked = Path(extract(str(fmu2), unzipdir=str(folder / "a fmu")))
    description = read_model_description(str(unpacked))
    references = {v.name: str(v.valueReference) for v in description.modelVariables}
    library = next((unpacked / "binaries").glob("*/*.so"))
    uri = (unpacked / "resources").as_uri()
    names = ("force_1", "acceleration_1", "displacement_1")
    return [str(program), str(library), description.guid, uri, *(references[name] for name in names)]


def test_numbers_reset_states_derivatives_and_2000_instances(command):
    done = subprocess.run([*command, "2000"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "")


@pytest.mark.skipif(not shutil.which("valgrind"), reason="needs valgrind")
def test_valgrind_finds_no_leak_and_no_wrong_access(command):
    watch = ["valgrind", "--quiet", "--error-exitcode=99", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect"]
    done = subprocess.run([*watch, *command, "20"], capture_output=True, text=True)
    assert "failed" not in done.stdout.replace("failed: settled > 0 && resident() <= settled + 32", "")
    assert done.returncode != 99, done.stderr
