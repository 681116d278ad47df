"""Time of one step of the FMU beside the same modes by hand in C and in a pythonfmu, all in one run.

    python benches/fmu_c/run.py [ORTHOPANEL]

Prints tables, what was asked beside what was reached; fails where the FMU and the C propagator do not end at the same
acceleration.
"""

import json
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

import fmpy
from fmpy import extract, read_model_description

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FLAGS = ["-O3", "-std=c11", "-fno-math-errno", "-Wall", "-Wextra", "-Werror"]
# Short rounds: on a shared machine some of them run undisturbed.
STEPS = {"fmu": 20_000, "c": 20_000, "pythonfmu": 100}
# Flexible modes, and the share of the C propagator's time that is asked of the FMU.
ASKED = {6: 1.0, 30: 0.5}
START_ASKED, SIZE_ASKED = 5.0, 1.5  # ms, MB
# The panel of the paper's piece 1.
MODEL = {
    "schema": "orthopanel.model/1",
    "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.880},
    "structure": "timoshenko-beam",
    "constants": {"e_x": 1.067e10, "g_zx": 5.304e8},
    "damping": {"beyond": 0.003},
}


PLATE = MODEL | {
    "piece": {"length": 0.8, "width": 0.4, "thickness": 0.03, "mass_per_area": 6.880},
    "structure": "mindlin-plate",
    "constants": {"e_x": 1.067e10, "e_y": 0.9e10, "nu_xy": 0.3, "g_xy": 4.1e9, "g_yz": 3.0e8, "g_zx": 5.304e8},
}
BRACKET = MODEL | {
    "effects": [{"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 900.0, "zeta": 0.02, "x": 0.21}]
}


def export(folder, orthopanel, count, content=MODEL):
    """The unpacked FMU, and its modes as text."""
    model = folder / "model.json"
    model.write_text(json.dumps(content))
    fmu = folder / f"panel-{count}.fmu"
    words = ["export", model, "-o", fmu, "--modes", count, "--force=-0.3", "--response=0.3"]
    subprocess.run([orthopanel, *map(str, words)], check=True, capture_output=True)
    unpacked = Path(extract(str(fmu), unzipdir=str(folder / f"panel-{count}")))
    modes = json.loads((unpacked / "resources/panel.json").read_text())["model"]["modes"]
    keys = ("angular_frequency", "damping_ratio")
    lines = [[mode[key] for key in keys] + mode["at_forces"] + mode["at_responses"] for mode in modes]
    text = folder / f"modes-{count}.txt"
    text.write_text("".join(" ".join(map(repr, line)) + "\n" for line in lines))
    return unpacked, text


def pythonfmu(folder, modes):
    script = shutil.copy(HERE / "numpy_panel.py", folder)
    text = shutil.copy(modes, folder / "modes.txt")
    words = [sys.executable, "-m", "pythonfmu", "build", "-f", script, "-d", folder, text]
    subprocess.run(list(map(str, words)), check=True, capture_output=True)
    return Path(extract(str(folder / "NumpyPanel.fmu"), unzipdir=str(folder / "pythonfmu")))


def compiled(folder):
    bench = folder / "bench"
    headers = Path(fmpy.__file__).parent / "c-code"
    sources = [HERE / "bench.c", HERE / "propagator.c"]
    words = ["gcc", *FLAGS, f"-I{headers}", *sources, "-o", bench, "-ldl", "-lm"]
    subprocess.run(list(map(str, words)), check=True)
    return bench


def timed(bench, *words):
    """Microseconds and last acceleration by name."""
    # What runs inside a pythonfmu is this environment's Python, whose library the FMU expects its host to have loaded.
    python = Path(sysconfig.get_config_var("LIBDIR")) / sysconfig.get_config_var("INSTSONAME")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    environment |= {"LD_PRELOAD": str(python)} if python.suffix != ".a" else {}
    done = subprocess.run([str(bench), *map(str, words)], check=True, capture_output=True, text=True, env=environment)
    lines = [line.split() for line in done.stdout.splitlines()]
    return {name: (float(time), float(last)) for name, time, last in lines}


def timed_fmu(bench, unpacked, steps):
    description = read_model_description(str(unpacked))
    variables = {v.name: v.valueReference for v in description.modelVariables}
    library = next((unpacked / "binaries/linux64").glob("*.so"))
    references = f"{variables['force_1']},{variables['acceleration_1']}"
    uri = (unpacked / "resources").as_uri()
    return timed(bench, library, description.guid, uri, steps, references)["fmu"]


def started(bench, unpacked):
    """Milliseconds from instantiation to the first step, with a length of its own to solve the modes for."""
    description = read_model_description(str(unpacked))
    reference = next(v.valueReference for v in description.modelVariables if v.name == "length")
    library = next((unpacked / "binaries/linux64").glob("*.so"))
    uri = (unpacked / "resources").as_uri()
    return timed(bench, "start", library, description.guid, uri, reference, 0.81)["start"][0] / 1e3


def main():
    orthopanel = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target/release/orthopanel")
    failed = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = compiled(folder)
        print(f"{platform.processor() or platform.machine()}, gcc {' '.join(FLAGS[:3])}; us a step: set, step, get")
        print("modes   this FMU   C exact   C RK4   pythonfmu   FMU / C exact   asked")
        for count, asked in ASKED.items():
            unpacked, modes = export(folder, orthopanel, count)
            ours = timed_fmu(bench, unpacked, STEPS["fmu"])
            by_hand = timed(bench, "c", modes, STEPS["c"])
            python = timed_fmu(bench, pythonfmu(folder, modes), STEPS["pythonfmu"])
            times = [ours[0], by_hand["exact"][0], by_hand["rk4"][0], python[0]]
            row = "{:5d}   {:8.4f}   {:7.4f}  {:6.4f}   {:9.2f}   {:13.2f}   {:5.1f}"
            print(row.format(count, *times, times[0] / times[1], asked))
            if abs(ours[1] - by_hand["exact"][1]) > 1e-9 * abs(ours[1]):
                failed.append(f"{count} modes: the FMU ends at {ours[1]} m/s2, the C propagator at {by_hand['exact'][1]}")
        print(f"from instantiation to the first step, modes solved anew; asked {START_ASKED} ms:")
        models = {"beam": (30, MODEL), "beam with a resonator": (20, BRACKET), "plate": (30, PLATE)}
        for number, (name, (count, content)) in enumerate(models.items()):
            own = folder / str(number)
            own.mkdir()
            unpacked, _ = export(own, orthopanel, count, content)
            print(f"    {name}, {count} flexible modes: {started(bench, unpacked):.2f} ms")
        size = next((unpacked / "binaries/linux64").glob("*.so")).stat().st_size
        print(f"library: {size / 1e6:.2f} MB, asked {SIZE_ASKED} MB")
    if failed:
        sys.exit("\n".join(failed))


if __name__ == "__main__":
    main()
