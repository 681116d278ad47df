"""A suspect against a sound strip of the same make: two tests of strips whose core wanders alike and whose modes are off alike, each with hits,
gains and noise of its own."""

import json
import os
import subprocess
from copy import deepcopy

import numpy as np
import pytest

from . import files, real, records
from .catalogue import EFFECTS
from .contour import Sampling

ORTHOPANEL = os.environ.get("ORTHOPANEL")
pytestmark = pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
NONE = real.Case("none", "none")
SAMPLING = Sampling(20480.0, 16384)


def strip(random):
    """An uneven strip of seven places."""
    while True:
        uneven, _ = real._uneven(real._draw(NONE, random, SAMPLING), random)
        if len(uneven.forces) == 7:
            break
    uneven.own = 2e-3 * random.standard_normal(real.OWN), np.ones((real.OWN, 7))
    return uneven


def make(folder, bench, random):
    """One test of it."""
    bench = deepcopy(bench)
    real._beside(bench, random)
    files.write_case(folder, bench, records.play(bench, random))
    return folder / "test.toml"


def traced(*arguments):
    """The trace as JSON."""
    return json.loads(subprocess.run([ORTHOPANEL, "trace", "--json", *arguments], capture_output=True, check=True).stdout)


def lead(found, name):
    """Of a hypothesis over nothing missing, in the logarithm of the odds."""
    evidence = {one["id"]: one["log_evidence"] for one in found["candidates"]}
    return evidence[name] - evidence["base"]


def test_val_a_reference_shows_what_the_model_error_hides(tmp_path):
    """A disbond of the weakest third of its range: what the model misses of both strips falls to less than a third, the disbond's lead
    grows, and no effect is named of two sound strips."""
    random = np.random.default_rng(41)
    bench = strip(random)
    good, again = (make(tmp_path / name, bench, random) for name in ("good", "again"))
    EFFECTS["stiffness-loss"](bench, real._Part(random, hard=True))
    suspect = make(tmp_path / "suspect", bench, random)
    alone, against = traced(suspect), traced(suspect, "--reference", good)
    shared = against["shared_model_error"]
    assert shared["modes"] >= 5 and shared["suspect_less_reference"] < shared["suspect"]
    assert against["model_error"]["frequency"] < alone["model_error"]["frequency"] / 3.0
    assert lead(against, "stiffness-loss") > lead(alone, "stiffness-loss")
    assert "shared_model_error" not in alone
    same = traced(again, "--reference", good)
    shared = same["shared_model_error"]
    assert same["verdict"] != "explained" and shared["suspect_less_reference"] < shared["suspect"] / 2.0, (same["candidates"][:3], shared)
