"""Hammer records to accelerances, and those to poles, by pyuff, pyFRF and sdypy-EMA: a peer to measure speed against.

    python peer.py FOLDER accelerances --repeat 9    read every point-N.uff of FOLDER, H1 over all hits of each
    python peer.py FOLDER poles --repeat 5           the same accelerances (not timed), then LSCF's poles and shapes

FOLDER is one that tests/record_generator wrote with --five-places and --format uff-binary.

One JSON line goes to standard output. `seconds` is the median over the repeats of the work alone, in this process,
after one run to warm up; the start of Python and its imports do not count. `accelerances` adds {"lines", "step_hz",
"samples"}: some lines of each place as [place, line, real, imaginary] in (m/s2)/N, so that a reader can see that both
sides did the same work. `poles` adds {"frequencies_hz", "zeta"}, of the stable poles nearest to --near.
"""

import argparse
import json
import pathlib
import statistics
import sys
import time

import numpy as np
import pyuff
from pyFRF import FRF

EXCITATION_FORCE = 13  # specific data types of dataset 58
ACCELERATION = 12
SHOWN_LINES = 16  # a place


def read_hits(path):
    """Force and acceleration of a file, shape (hits, samples) each in N and m/s2, and the sampling rate in Hz."""
    channels = {EXCITATION_FORCE: [], ACCELERATION: []}
    for record in pyuff.UFF(str(path)).read_sets():
        channels[record["ordinate_spec_data_type"]].append(record["data"])
    # The step is printed with six digits; the generator's rates are whole numbers, and pyFRF takes nothing else.
    rate = round(1.0 / record["abscissa_inc"])
    return np.array(channels[EXCITATION_FORCE]), np.array(channels[ACCELERATION]), rate


def accelerances(folder):
    """H1 of every place, shape (places, lines), with the line at 0 Hz, and the step between lines in Hz."""
    rows = []
    for path in sorted(folder.glob("point-*.uff")):
        force, acceleration, rate = read_hits(path)
        frf = FRF(rate, exc=force, resp=acceleration, exc_type="f", resp_type="a")
        rows.append(frf.get_FRF(frf_estimator="H1", frf_form="accelerance")[0, 0])
        step = rate / force.shape[1]
    return np.array(rows), step


def poles(rows, step, upper, order, near):
    """Natural frequencies [Hz] and damping ratios of LSCF's stable poles nearest to `near`, shapes by least squares."""
    from sdypy import EMA  # only here: who has no sdypy-EMA can still time the reader

    frf = np.nan_to_num(rows)  # pyFRF goes by way of receptance, which divides 0 by 0 at 0 Hz
    freq = step * np.arange(rows.shape[1])
    model = EMA.Model(frf, freq, lower=50, upper=upper, pol_order_high=order, frf_form="accelerance")
    model.get_poles(show_progress=False)
    model.select_closest_poles(near)
    model.get_constants()
    return [float(f) for f in model.nat_freq], [float(z) for z in model.nat_xi]


def timed(work, repeat):
    """The answer of `work`, and the median of its seconds after one run to warm up."""
    answer = work()
    seconds = []
    for _ in range(repeat):
        begin = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - begin)
    return answer, statistics.median(seconds)


def run(arguments):
    """Do the task and return the record that the command prints."""
    if arguments.task == "accelerances":
        (rows, step), seconds = timed(lambda: accelerances(arguments.folder), arguments.repeat)
        shown = np.linspace(1, rows.shape[1] // 2, SHOWN_LINES, dtype=int)
        samples = [[i, int(n), row[n].real, row[n].imag] for i, row in enumerate(rows) for n in shown]
        return {"seconds": seconds, "lines": rows.shape[1], "step_hz": step, "samples": samples}
    rows, step = accelerances(arguments.folder)
    wanted = (arguments.upper, arguments.order, arguments.near)
    (frequencies, zeta), seconds = timed(lambda: poles(rows, step, *wanted), arguments.repeat)
    return {"seconds": seconds, "frequencies_hz": frequencies, "zeta": zeta}


def main():
    """Read the command line, run, print one JSON line; exit 2 on bad usage."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="holds point-0.uff, point-1.uff, ...")
    parser.add_argument("task", choices=["accelerances", "poles"])
    parser.add_argument("--repeat", type=int, default=5, help="timed runs; their median is printed (default 5)")
    parser.add_argument("--upper", type=float, default=4500.0, help="end of LSCF's band, Hz (default 4500)")
    parser.add_argument("--order", type=int, default=60, help="LSCF's highest polynomial order (default 60)")
    parser.add_argument("--near", type=float, nargs="+", metavar="HZ", default=[], help="poles wanted near these")
    arguments = parser.parse_args()
    if arguments.repeat < 1:
        parser.error(f"--repeat {arguments.repeat}: at least one timed run is needed")
    if not list(arguments.folder.glob("point-*.uff")):
        parser.error(f"{arguments.folder}: no point-*.uff in it")
    if arguments.task == "poles" and not arguments.near:
        parser.error("poles: --near names the frequencies wanted")
    json.dump(run(arguments), sys.stdout)
    print()


if __name__ == "__main__":
    main()
