"""A list of a plate's modes in which two lines have changed their names: every two of ten are told with the right ones."""

import itertools
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import ROOT
from plate_by_scikit_fem import nodal_lines

PIECE = {"length": 0.8, "width": 0.2, "thickness": 0.03, "mass_per_area": 6.88}
TRUTH = {"e_x": 1.07e10, "e_y": 9.6e9, "nu_xy": 0.31, "g_xy": 3.7e9, "g_yz": 2.9e8, "g_zx": 5.363e8}
COUNT = 10


@pytest.fixture(scope="module")
def modes():
    found = nodal_lines({"piece": PIECE, "constants": TRUTH}, (14, 4), COUNT)
    return [(round(frequency, 1), nodes) for frequency, nodes in found]


def told(modes, changed, folder):
    names = [nodes for _, nodes in modes]
    one, other = changed
    names[one], names[other] = names[other], names[one]
    path = folder / f"{one}-{other}.toml"
    piece = "\n".join(f"{key} = {value}" for key, value in PIECE.items())
    path.write_text(
        f'structure = "mindlin-plate"\n[piece]\n{piece}\n[[measurement]]\nkind = "natural-frequencies"\n'
        f"values = {[frequency for frequency, _ in modes]}\nshape = {names}\n"
    )
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    done = subprocess.run([command, "identify", str(path)], capture_output=True, text=True)
    # Names under which no search ends are told with the error.
    assert done.returncode in (0, 1), done.stderr
    return done.stdout + done.stderr


def test_two_lines_with_changed_names_are_told(modes, tmp_path):
    """A third of all pairs, in which every line stands: neighbours and lines far apart."""
    pairs = [pair for pair in itertools.combinations(range(COUNT), 2) if sum(pair) % 3 == 0]
    with ThreadPoolExecutor(2) as pool:
        answers = list(pool.map(lambda pair: told(modes, pair, tmp_path), pairs))
    assert len(pairs) == 15 and {line for pair in pairs for line in pair} == set(range(COUNT))
    for (one, other), answer in zip(pairs, answers):
        for line, wrong in ((one, other), (other, one)):
            frequency, right = modes[line]
            assert f"{frequency:g} Hz named {modes[wrong][1]}" in answer, ((one, other), answer)
            assert f"and {right} at" in answer, ((one, other), answer)
