"""The port must find what the seed found, else its speed says nothing. Authority: the seed's tables 4, 5 and 7."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import seed_port

PRINTED = {1: [321.4, 837.6, 1522.5, 2306.1, 3141.7, 4000.4], 3: [582.9, 1381.8, 2294.2, 3221.0]}  # tables 5 and 7, Hz


@pytest.mark.parametrize("piece", [1, 3])
def test_val_modes_agree_with_the_printed_columns(piece):
    """Table 4's rounded constants give the printed columns within 0.06 Hz: half a printed digit and the constants' own
    rounding."""
    found = seed_port.run("modes", piece, repeat=1)["frequencies"]
    assert np.abs(np.array(found) - PRINTED[piece]).max() < 0.06


@pytest.mark.parametrize("task", ["simplex", "least-squares"])
@pytest.mark.parametrize("piece", [1, 3])
def test_val_both_searches_find_table_4(task, piece):
    """Within two units of the fourth printed digit: the seed's simplex stopped a little off the minimum."""
    found = seed_port.run(task, piece, repeat=1)
    for value, printed in zip((found["e_x"], found["g_zx"]), seed_port.PIECES[piece]["table_4"]):
        unit = 10.0 ** (np.floor(np.log10(printed)) - 3)
        assert abs(value - printed) <= 2.0 * unit


@pytest.mark.parametrize("piece", [1, 3])
def test_val_both_searches_reach_the_same_minimum(piece):
    """The simplex knows its minimum to about the square root of rounding: 1e-6 relative is asked."""
    one, other = (seed_port.run(task, piece, repeat=1) for task in ("simplex", "least-squares"))
    assert one["e_x"] == pytest.approx(other["e_x"], rel=1e-6)
    assert one["g_zx"] == pytest.approx(other["g_zx"], rel=1e-6)


def test_too_many_modes_below_the_cut_off_are_refused():
    """Equation 11 holds below the cut-off of condition 9 only, and fewer than 60 modes lie there: that is said."""
    with pytest.raises(ValueError, match="of 60 modes lie below the cut-off"):
        seed_port.natural_frequencies(1.070e10, 5.363e8, 0.03, 60)


def test_the_command_prints_one_json_line():
    """What a benchmark reads: one line, one object."""
    script = Path(seed_port.__file__)
    done = subprocess.run(
        [sys.executable, script, "modes", "--repeat", "2"], capture_output=True, text=True, check=True
    )
    assert done.stdout.count("\n") == 1
    record = json.loads(done.stdout)
    assert record["task"] == "modes" and record["seconds"] > 0.0 and len(record["frequencies"]) == 6
