"""The command beside the package, and the examples."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"


@pytest.fixture(scope="session")
def command():
    """Runs the command that the workspace built; gives its JSON."""

    def run(*words, code=0):
        done = subprocess.run(
            [os.environ["ORTHOPANEL"], *map(str, words)], cwd=ROOT, capture_output=True, text=True, timeout=300, check=False
        )
        assert done.returncode == code, done.stderr
        return json.loads(done.stdout) if "--json" in words else done

    return run


@pytest.fixture
def piece():
    """The paper's piece 1."""
    import orthopanel as op

    return op.Piece(length=0.8, width=0.1, thickness=0.03, mass_per_area=6.88)
