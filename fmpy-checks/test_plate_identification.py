"""All six constants of a plate from frequencies that scikit-fem computed: value, interval, and what data cannot see."""

import json
import os
import subprocess

import numpy as np
import pytest
from conftest import ROOT
from plate_by_scikit_fem import nodal_lines

TRUTH = {"e_x": 1.07e10, "e_y": 8.6e9, "nu_xy": 0.34, "g_xy": 3.2e9, "g_yz": 2.6e8, "g_zx": 5.363e8}
# Poisson's ratio shows where bending along x and y couple, so nearly square plates are among these.
WIDTHS = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7]
COUNT = 20
NOISE = 5e-4
SEEDS = range(20)


def piece(width):
    return {"length": 0.8, "width": width, "thickness": 0.03, "mass_per_area": 6.880}


@pytest.fixture(scope="module")
def modes():
    """Frequencies and nodal lines of the lowest modes at each width, but for those whose lines tell no sure name.

    Two that veer share one count, and with three lines across the width some have lines that join and part.
    """
    found = [nodal_lines({"piece": piece(width), "constants": TRUTH}, (14, 6), COUNT) for width in WIDTHS]
    named = [[nodes for _, nodes in listed] for listed in found]
    return [[mode for mode in listed if names.count(mode[1]) == 1 and mode[1][1] < 3] for listed, names in zip(found, named)]


def written(modes, seed, keep=lambda nodes: True):
    random = np.random.default_rng(seed)
    lines = ['structure = "mindlin-plate"']
    for number, width in list(enumerate(WIDTHS))[: len(modes)]:
        lines += ["[[piece]]", f'name = "{number}"'] + [f"{key} = {value}" for key, value in piece(width).items()]
    for number, listed in enumerate(modes):
        kept = [(f * (1.0 + NOISE * random.standard_normal()), nodes) for f, nodes in listed if keep(nodes)]
        # The test file wants rising frequencies; noise may turn two that are close.
        kept.sort(key=lambda pair: pair[0])
        lines += ["[[measurement]]", f'piece = "{number}"', 'kind = "natural-frequencies"']
        lines += [f"values = {[f for f, _ in kept]}", f"shape = {[nodes for _, nodes in kept]}"]
    return "\n".join(lines) + "\n"


def identify(text, folder):
    path = folder / "test.toml"
    path.write_text(text)
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    done = subprocess.run([command, "identify", str(path), "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_all_six_constants_come_back_and_their_intervals_hold_them(modes, tmp_path):
    held = []
    for seed in SEEDS:
        found = identify(written(modes, seed), tmp_path)
        assert not found["not_identified"], found["not_identified"]
        for name, truth in TRUTH.items():
            constant = found["constants"][name]
            missed = abs(constant["value"] - truth)
            held.append(missed < 1.96 * constant["std"])
            assert missed < 0.01 * truth, (seed, name, constant)
    # 120 intervals of 95 %. The six of one test miss together in part, so the share scatters by some 4 %.
    assert np.mean(held) > 0.85, np.mean(held)


def test_bending_modes_of_one_piece_do_not_show_every_constant(modes, tmp_path):
    for seed in SEEDS[:6]:
        found = identify(written(modes[:1], seed, keep=lambda nodes: nodes[1] == 0), tmp_path)
        unseen = {entry["name"] for entry in found["not_identified"]}
        assert {"g_xy", "nu_xy"} <= unseen, (seed, unseen)
        for entry in found["not_identified"]:
            assert found["constants"][entry["name"]]["std"] is None
            assert entry["direction"], entry
        assert found["constants"]["e_x"]["value"] == pytest.approx(TRUTH["e_x"], rel=0.02)


def test_bending_modes_of_two_widths_show_all_and_rounding_changes_nothing(modes, tmp_path):
    """Some of them veer with modes across the piece, and so know of these: a search near a veering is easily led astray."""
    missed = []
    for seed in SEEDS[:6]:
        text = written(modes[:2], seed, keep=lambda nodes: nodes[1] == 0)
        found, again = identify(text, tmp_path), identify(rounded_off(text, seed), tmp_path)
        assert not found["not_identified"] and not again["not_identified"], seed
        for name, truth in TRUTH.items():
            constant = found["constants"][name]
            assert abs(again["constants"][name]["value"] - constant["value"]) < 1e-2 * constant["std"], (seed, name)
            missed.append(abs(constant["value"] - truth) / constant["std"])
    # 36 intervals of 95 %, of which those of one list miss together.
    assert np.mean(np.array(missed) < 1.96) > 0.85, missed


def rounded_off(text, seed):
    """The same lines to the ninth digit."""
    random = np.random.default_rng(seed)
    lines = []
    for line in text.splitlines():
        if line.startswith("values = "):
            values = [f * (1.0 + 1e-9 * random.standard_normal()) for f in json.loads(line.removeprefix("values = "))]
            line = f"values = {values}"
        lines.append(line)
    return "\n".join(lines) + "\n"
