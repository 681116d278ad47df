"""The seed's identification by natural frequencies, written for SciPy: a peer to measure speed against.

Source: Saito, Parbery, Okuno and Kawano, "Parameter identification for aluminum honeycomb sandwich panels based on
orthotropic Timoshenko beam theory", J. Sound Vib. 208(2), 1997: equations 8, 11, 22, 24 and tables 3, 4, 5, 7.

    python seed_port.py modes          --repeat 50    natural frequencies at table 4's constants
    python seed_port.py simplex        --repeat 5     E_x and G_zx by the downhill simplex and a penalty (as the seed)
    python seed_port.py least-squares  --repeat 20    the same minimum by scipy.optimize.least_squares

One JSON line goes to standard output: {"task", "piece", "seconds", "e_x", "g_zx", "error", "frequencies"}. `seconds`
is the median over the repeats of the numerics alone, after one run to warm up; `error` is equation 22; frequencies are
in Hz. Units are SI. The width cancels, so every section property below is per metre of width.
"""

import argparse
import json
import math
import statistics
import sys
import time

import numpy as np
from scipy.optimize import brentq, least_squares, minimize

SHEAR_COEFFICIENT = 2.0 / 3.0  # k', section 2.3
MASS_PER_AREA = 6.880  # rho t, section 3.1, kg/m2
LENGTH = 0.8  # a, table 3, m
START = (2.0e10, 1.0e9)  # E_x, G_zx: round numbers some way off either minimum, Pa
SCAN_STEP = 20.0  # Hz; modes of one symmetry lie over 1 kHz apart on these pieces
SCAN_BLOCK = 4500.0  # Hz

PIECES = {  # thickness t [m], measured frequencies [Hz] and the identified constants of table 4 [Pa]
    1: {"thickness": 0.03, "measured": [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5], "table_4": (1.070e10, 5.363e8)},
    3: {"thickness": 0.06, "measured": [582.5, 1385.0, 2287.5, 3225.0], "table_4": (4.876e9, 2.980e8)},
}


def beam(e_x, g_zx, thickness):
    """E_x I_z [N m], k' G_zx A [N/m], rho A [kg/m2] and rho I_z [kg], each per metre of width."""
    return (
        e_x * thickness**3 / 12.0,
        SHEAR_COEFFICIENT * g_zx * thickness,
        MASS_PER_AREA,
        MASS_PER_AREA * thickness**2 / 12.0,
    )


def cut_off(section):
    """The frequency in Hz up to which condition 9 holds: sqrt(k' G_zx A / (rho I_z)) / (2 pi)."""
    _, shear, _, rotary = section
    return math.sqrt(shear / rotary) / (2.0 * math.pi)


def factors(frequency, section, lib):
    """The two factors of equation 11 (even, odd modes) at `frequency` in Hz, each divided by cosh(beta a/2).

    `lib` is numpy for a whole scan at once, or math for one frequency: that takes a quarter off an
    identification.
    """
    bending, shear, mass, rotary = section
    square = (2.0 * math.pi * frequency) ** 2
    s = mass * square / shear
    middle = -square * (rotary + mass * bending / shear)
    root = lib.sqrt(square**2 * (rotary - mass * bending / shear) ** 2 + 4.0 * bending * mass * square)
    alpha_square = (root - middle) / (2.0 * bending)  # equation 8, lambda = +-j alpha
    beta_square = (root + middle) / (2.0 * bending)  # equation 8, lambda = +-beta
    alpha, beta = lib.sqrt(alpha_square), lib.sqrt(beta_square)
    cosine, sine = lib.cos(alpha * LENGTH / 2.0), lib.sin(alpha * LENGTH / 2.0)
    tanh = lib.tanh(beta * LENGTH / 2.0)
    p, q = (alpha_square - s) * alpha, (beta_square + s) * beta
    return p * cosine * tanh + q * sine, p * sine - q * tanh * cosine


def natural_frequencies(e_x, g_zx, thickness, count):
    """The first `count` flexible natural frequencies in Hz: a scan for sign changes of equation 11, then Brent's root.

    The scan goes upward in blocks and stops at the cut-off of condition 9; a ValueError says when fewer modes lie
    below.
    """
    section = beam(e_x, g_zx, thickness)
    limit = 0.999 * cut_off(section)
    found = []
    low = SCAN_STEP
    while len(found) < count and low < limit:
        high = min(low + SCAN_BLOCK, limit)
        grid = np.linspace(low, high, max(2, math.ceil((high - low) / SCAN_STEP) + 1))
        brackets = []
        for parity, values in enumerate(factors(grid, section, np)):
            for i in np.flatnonzero(np.signbit(values[:-1]) != np.signbit(values[1:])):
                brackets.append((grid[i], grid[i + 1], parity))
        for left, right, parity in sorted(brackets)[: count - len(found)]:
            found.append(brentq(lambda f: factors(f, section, math)[parity], float(left), float(right), xtol=1e-9))
        low = high
    if len(found) < count:
        raise ValueError(f"{len(found)} of {count} modes lie below the cut-off at {cut_off(section):.0f} Hz")
    return np.sort(found)


def misfit(e_x, g_zx, thickness, measured):
    """The relative errors (f_exp - f_cal) / f_exp of equation 22, one a mode."""
    return (measured - natural_frequencies(e_x, g_zx, thickness, len(measured))) / measured


def simplex(thickness, measured):
    """E_x and G_zx in Pa by the downhill simplex on equation 22; a penalty keeps both above zero (equation 24)."""

    def objective(scaled):
        outside = np.minimum(scaled - 1e-3, 0.0)
        if outside.any():
            return 1.0 + 1e3 * float(outside @ outside)  # finite, and it slopes back: an infinite wall stalls a simplex
        try:
            errors = misfit(scaled[0] * START[0], scaled[1] * START[1], thickness, measured)
        except ValueError:
            return 1.0
        return float(errors @ errors) / len(measured)

    # The value near the minimum is flat to the square root of its rounding: 1e-8 in the constants needs 1e-15 here.
    found = minimize(objective, [1.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-15})
    if not found.success:
        raise ValueError(f"the simplex did not settle: {found.message}")
    return found.x * START


def by_least_squares(thickness, measured):
    """E_x and G_zx in Pa by a trust region on the misfits, bounded below; the slopes are SciPy's differences."""
    found = least_squares(
        lambda scaled: misfit(scaled[0] * START[0], scaled[1] * START[1], thickness, measured),
        [1.0, 1.0],
        bounds=([1e-3, 1e-3], [np.inf, np.inf]),
        xtol=1e-10,
        ftol=1e-12,
        gtol=1e-12,
    )
    if not found.success:
        raise ValueError(f"the least squares did not settle: {found.message}")
    return found.x * START


def run(task, piece, repeat):
    """Do `task` on test piece 1 or 3 of the seed `repeat` times and return the record that the command prints."""
    thickness = PIECES[piece]["thickness"]
    measured = np.array(PIECES[piece]["measured"])
    work = {
        "modes": lambda: natural_frequencies(*PIECES[piece]["table_4"], thickness, len(measured)),
        "simplex": lambda: simplex(thickness, measured),
        "least-squares": lambda: by_least_squares(thickness, measured),
    }[task]
    answer = work()
    seconds = []
    for _ in range(repeat):
        begin = time.perf_counter()
        answer = work()
        seconds.append(time.perf_counter() - begin)
    e_x, g_zx = PIECES[piece]["table_4"] if task == "modes" else answer
    errors = misfit(e_x, g_zx, thickness, measured)
    return {
        "task": task,
        "piece": piece,
        "seconds": statistics.median(seconds),
        "e_x": float(e_x),
        "g_zx": float(g_zx),
        "error": float(errors @ errors) / len(measured),
        "frequencies": [float(f) for f in natural_frequencies(e_x, g_zx, thickness, len(measured))],
    }


def main():
    """Read the command line, run, print one JSON line; exit 2 on bad usage."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["modes", "simplex", "least-squares"])
    parser.add_argument(
        "--piece", type=int, choices=sorted(PIECES), default=1, help="test piece: table 5 (1) or table 7 (3)"
    )
    parser.add_argument("--repeat", type=int, default=5, help="timed runs; their median is printed (default 5)")
    arguments = parser.parse_args()
    if arguments.repeat < 1:
        parser.error(f"--repeat {arguments.repeat}: at least one timed run is needed")
    json.dump(run(arguments.task, arguments.piece, arguments.repeat), sys.stdout)
    print()


if __name__ == "__main__":
    main()
