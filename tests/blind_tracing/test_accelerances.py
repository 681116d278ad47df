"""What an analyser keeps, against the modes that the hits were played from."""

import numpy as np
import pytest
import pyuff

from . import accelerances, records
from .bench import draw


def _played():
    bench = draw(np.random.default_rng(5), sampling=accelerances.SAMPLING)
    bench.noise = 0.0
    return bench, records.play(bench, np.random.default_rng(6))


def test_val_h1_is_the_accelerance_of_the_modes():
    """On the imaginary axis, where the records were played off it; what still rings at the end of a record leaks."""
    bench, played = _played()
    frequency, found = accelerances.h1(played, bench.sampling)
    assert frequency[0] >= 20.0 and frequency[-1] <= 6000.0 and found.shape == (5, len(frequency))
    s = 2j * np.pi * frequency
    modes = bench.modes(np.array([*bench.forces, bench.response]))
    wanted = modes.receptance(s, [5], range(5))[:, 0].T * s**2
    missed = np.abs(found - wanted) / np.sqrt(np.mean(np.abs(wanted) ** 2))
    assert np.max(missed) < 1e-3


def test_files_hold_it(tmp_path):
    """Response and force nodes, their places in test.toml, and the values of the lines."""
    bench, played = _played()
    accelerances.write_case(tmp_path / "case", bench, played)
    frequency, found = accelerances.h1(played, bench.sampling)
    record = pyuff.UFF(str(tmp_path / "case" / "point-2.uff")).read_sets()
    assert (record["func_type"], record["ref_node"], record["rsp_node"]) == (4, 3, 6)
    assert record["x"] == pytest.approx(frequency, rel=1e-6)
    assert np.max(np.abs(record["data"] - found[2])) < 1e-5 * np.max(np.abs(found[2]))
    plan = (tmp_path / "case" / "test.toml").read_text(encoding="utf-8")
    assert plan.count('kind = "accelerance"') == 5
    assert f"force_at = [{bench.forces[2]:.4g}, 0.0]" in plan
