"""Builds the vehicle, runs it coupled and as one system, and prints and draws what the coupling and the bracket do.

    python examples/rail-car/compare.py OUT [--settle S] [--steps S ...] [--ecos]
"""

import argparse
import json
from pathlib import Path

import coupled_runs
import numpy as np
from comfort import lines_of, weighted_rms
from monolith import Monolith
from vehicle import FOOT, MODEL, build_fmus, resonator, write_ssp


def coupling_error(motion, monolith, step, after):
    """Rms of the coupled acceleration's error over the rms of the closed form, from the time `after` [s] on."""
    times = step * np.arange(1, len(motion) + 1)
    exact = monolith.acceleration(FOOT, times)
    seen = times > after
    return np.sqrt(np.mean((motion - exact)[seen] ** 2) / np.mean(exact[seen] ** 2))


def spectra_and_comfort(folder, bracket, settle, step, in_ecos=False):
    """Amplitudes and W_k-weighted rms over one period of the track: of the coupled run, and of the monolith."""
    monolith = Monolith(folder / "floor.fmu", bracket)
    track = monolith.track
    period = round(track.period / step)
    count = round(settle / step) + period
    if in_ecos:
        motion = coupled_runs.in_ecos(folder, bracket, step, count)
    else:
        motion = coupled_runs.in_fmpy(write_ssp(folder / "vehicle.ssp", folder, bracket), step, count)
    # The record begins at a whole number of steps: only phases know where, and neither result does.
    coupled, exact = lines_of(motion[-period:], len(track.omegas)), monolith.line_amplitudes(FOOT)
    return track.omegas, coupled, exact, weighted_rms(track.omegas, coupled), weighted_rms(track.omegas, exact)


def draw(path, spectra, errors):
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4), layout="constrained")
    for name, (omegas, coupled, exact, *_) in spectra.items():
        (line,) = left.semilogy(omegas / (2 * np.pi), abs(exact), label=f"{name}, one system")
        left.semilogy(omegas / (2 * np.pi), abs(coupled), ":", color=line.get_color(), label=f"{name}, coupled")
    left.set(xlabel="frequency [Hz]", ylabel="amplitude of acceleration [m/s²]")
    left.legend()
    for name, points in errors.items():
        right.loglog(*zip(*points), "o-", label=name)
    right.set(xlabel="communication step [s]", ylabel="rms error of the coupling [1]")
    right.legend()
    figure.savefig(path)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("folder", type=Path, metavar="OUT")
    arguments.add_argument("--settle", type=float, default=6.0, help="time before the comfort record [s]")
    arguments.add_argument("--steps", type=float, nargs="+", default=[1e-3, 5e-4, 2.5e-4], help="communication steps [s]")
    arguments.add_argument("--ecos", action="store_true", help="run the comfort record in ecospy too")
    given = arguments.parse_args()
    build_fmus(given.folder)
    bracket = resonator(json.loads(MODEL.read_text()))

    spectra = {}
    for name, added in (("without bracket", None), ("with bracket", bracket)):
        for master in ["FMPy"] + ["ecospy"] * given.ecos:
            found = spectra_and_comfort(given.folder, added, given.settle, given.steps[0], master == "ecospy")
            spectra.setdefault(name, found)
            print(f"{name}, {master}: weighted rms {found[3]:.5f} m/s2 coupled, {found[4]:.5f} m/s2 as one system")

    errors = {}
    monolith = Monolith(given.folder / "floor.fmu", bracket)
    print("step [s]  held     predicted   (rms error of the coupling, 1 to 2 s)")
    for step in given.steps:
        for name, predict in (("held", False), ("predicted", True)):
            ssp = write_ssp(given.folder / "vehicle.ssp", given.folder, bracket, predict)
            motion = coupled_runs.in_fmpy(ssp, step, round(2.0 / step))
            errors.setdefault(name, []).append((step, coupling_error(motion, monolith, step, 1.0)))
        print(f"{step:8.2e}  {errors['held'][-1][1]:.1e}  {errors['predicted'][-1][1]:.1e}")
    draw(given.folder / "rail-car.svg", spectra, errors)


if __name__ == "__main__":
    main()
