"""The example runs, and mypy finds nothing in it nor in the package."""

import subprocess
import sys
from pathlib import Path

import example


def test_the_example_runs(tmp_path):
    # The paper's table 4.
    assert abs(example.main(tmp_path) / 1.07e10 - 1) < 1e-2
    assert {path.name for path in tmp_path.iterdir()} == {"panel.fmu", "model.json", "report.html"}


def test_types_are_strict(tmp_path):
    for what in ([Path(__file__).with_name("example.py")], ["-p", "orthopanel"]):
        done = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--python-version", "3.10", "--cache-dir", tmp_path, *what],
            capture_output=True, text=True, check=False, cwd=tmp_path,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout
