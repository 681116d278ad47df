"""The Windows library under wine: the numbers of the Linux one, from folders on a drive, on a share and with umlauts.

Skipped where there is no wine, no mingw, or no Windows library in the FMUs (`crates/orthopanel-fmu/build-windows`).
"""

import os
import shutil
import subprocess
from pathlib import Path
from urllib.parse import quote

import fmpy
import pytest
from fmpy import extract, read_model_description
from masters import panel

HERE = Path(__file__).resolve().parent / "windows"
GCC = "x86_64-w64-mingw32-gcc"
STEP, STEPS = 1e-5, 400
FOLDERS = {2: "win64", 3: "x86_64-windows"}


@pytest.fixture(scope="module")
def host(tmp_path_factory):
    """The program, beside it what wine 8 lacks, and a prefix with the share \\\\server\\share; runs it with some words."""
    wine = shutil.which("wine64") or shutil.which("wine") or next(map(str, Path("/usr/lib/wine").glob("wine64")), None)
    if not wine or not shutil.which(GCC):
        pytest.skip("no wine or no mingw")
    folder = tmp_path_factory.mktemp("windows")
    headers = Path(fmpy.__file__).parent / "c-code"
    build = lambda *words: subprocess.run([GCC, "-O1", "-Wall", "-Wextra", *map(str, words)], check=True)  # noqa: E731
    build("-municode", f"-I{headers}", HERE / "host.c", "-o", folder / "host.exe")
    build("-shared", HERE / "prng.c", "-o", folder / "bcryptprimitives.dll", "-ladvapi32")
    build("-shared", "-nostdlib", HERE / "synch.def", "-o", folder / "api-ms-win-core-synch-l1-2-0.dll", "-lkernel32")
    environment = os.environ | {"WINEPREFIX": str(folder / "prefix"), "WINEDEBUG": "-all", "DISPLAY": ""}
    run = lambda *words: subprocess.run(  # noqa: E731
        [wine, *map(str, words)], env=environment, capture_output=True, text=True, cwd=folder, timeout=120
    )
    run("wineboot", "--init")
    return lambda *words: run(folder / "host.exe", *words), folder


@pytest.fixture(scope="module", params=[2, 3])
def unpacked(request, export, tmp_path_factory):
    """The FMU, its version, and its folder, whose name has a blank and umlauts."""
    fmu = export(f"windows-{request.param}.fmu", "--fmi", str(request.param), "--residual", "attachment", forces=[-0.3], responses=[0.3])
    folder = tmp_path_factory.mktemp("unpacked") / "Fußböden ü"
    extract(str(fmu), unzipdir=str(folder))
    if not list((folder / "binaries" / FOLDERS[request.param]).glob("*.dll")):
        pytest.skip("no Windows library in the FMUs of this build")
    return fmu, request.param, folder


def expected(fmu):
    with panel(fmu) as instance:
        instance.initialize()
        found = []
        for n in range(STEPS):
            instance.set("force_1", n % 7 - 2.5)
            instance.step(n * STEP, STEP)
            found += instance.get("acceleration_1")
    return found


@pytest.mark.parametrize("place", ["drive", "share"])
def test_windows_gives_the_numbers_of_linux(host, unpacked, place):
    run, prefix = host
    fmu, version, folder = unpacked
    if place == "share":
        share = prefix / "prefix/dosdevices/unc/server"
        share.mkdir(parents=True, exist_ok=True)
        (share / f"share{version}").symlink_to(folder)
        path = f"\\\\server\\share{version}"
        uri = f"file:////server/share{version}/resources"
    else:
        path = "Z:" + str(folder).replace("/", "\\")
        uri = "file:///Z:" + quote(str(folder / "resources"))
    description = read_model_description(str(fmu))
    references = {v.name: v.valueReference for v in description.modelVariables}
    library = f"{path}\\binaries\\{FOLDERS[version]}\\{description.coSimulation.modelIdentifier}.dll"
    resources = uri if version == 2 else f"{path}\\resources\\"
    done = run(version, library, description.guid, resources, references["force_1"], references["acceleration_1"])
    assert done.returncode == 0, done.stderr
    found, whole = [float(line) for line in done.stdout.split()], expected(fmu)
    assert len(found) == STEPS
    peak = max(map(abs, whole))
    # Exponentials and sines come from the system's mathematical library.
    assert max(abs(one - other) for one, other in zip(found, whole)) < 1e-12 * peak


def test_a_place_that_is_none_is_told(host, unpacked):
    run, _ = host
    fmu, version, folder = unpacked
    description = read_model_description(str(fmu))
    path = "Z:" + str(folder).replace("/", "\\")
    library = f"{path}\\binaries\\{FOLDERS[version]}\\{description.coSimulation.modelIdentifier}.dll"
    place = "file:///Z:/nowhere/resources" if version == 2 else "Z:\\nowhere\\resources\\"
    done = run(version, library, description.guid, place, 3, 4)
    assert done.returncode == 5 and "panel.json" in done.stderr and "nowhere" in done.stderr
