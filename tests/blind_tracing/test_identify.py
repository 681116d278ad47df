"""`orthopanel identify` on the records with nothing missing: all panels, places and noises that the sets draw."""

import json
import os
import subprocess

import pytest

from . import make
from .contour import Sampling

ORTHOPANEL = os.environ.get("ORTHOPANEL")


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_the_constants_of_every_test_with_nothing_missing(tmp_path):
    """E and G within 0.1 and 0.3 %, whichever of the low modes stand out, and whether or not the response dies away."""
    out = tmp_path / "none"
    make.make(out, "none", 4, 1000, Sampling())
    truth = json.loads((out / "truth.json").read_text(encoding="utf-8"))
    assert len(truth["cases"]) == 12
    for case in truth["cases"]:
        test = out / case["case"] / "test.toml"
        ran = subprocess.run([ORTHOPANEL, "identify", test, "--json"], capture_output=True, text=True, timeout=120)
        assert ran.returncode == 0, (case["case"], ran.stderr)
        found = json.loads(ran.stdout)
        for name, within in [("e_x", 1e-3), ("g_zx", 3e-3)]:
            assert found["constants"][name]["value"] == pytest.approx(case["constants"][name], rel=within), case["case"]
        # What neither noise nor the model explains: a leak gave 2.6 and 251. With three hits, of which the hard ones are the
        # noisier, their scatter tells up to a third too little.
        assert found["error"]["chi_square"] < 1.5, (case["case"], found["error"])
