"""What was measured in several ways: lists beside records, records of two pieces of one make, and hits beside files of accelerances."""

import json
import os
import subprocess
from copy import copy
from dataclasses import replace

import numpy as np
import pytest

from . import accelerances, attachments, files, lists, records
from . import bench as benches

ORTHOPANEL = os.environ.get("ORTHOPANEL")
pytestmark = pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
MASS, PLACE = 0.03, 0.21  # kg, m: on the piece that is hit
SCATTER = 5e-4  # of each frequency


def natural_frequencies(random, bench, name):
    """A list as a tester writes it."""
    true = lists.natural_frequencies(bench)
    read = true * (1.0 + SCATTER * random.standard_normal(len(true)))
    values, scatter = (", ".join(f"{number:.6g}" for number in column) for column in (read, SCATTER * read))
    return f'[[measurement]]\npiece = "{name}"\nkind = "natural-frequencies"\nvalues = [{values}]\nscatter = [{scatter}]\n'


def named(text, name):
    """A test of one piece as that of a piece with a name."""
    return text.replace("[piece]", f'[[piece]]\nname = "{name}"').replace("[[measurement]]", f'[[measurement]]\npiece = "{name}"')


@pytest.fixture(scope="module")
def tests(tmp_path_factory):
    """The truth, and the tests: hits of a piece with a mass on it, the same with lists of it and of a piece without, in that order."""
    random = np.random.default_rng(1207)
    bench = benches.draw(random, "single")
    bench.attachments = [(PLACE, attachments.mass(MASS))]
    folder = tmp_path_factory.mktemp("mixtures") / "hits"
    files.write_case(folder, bench, records.play(bench, random))
    alone = (folder / "test.toml").read_text(encoding="utf-8")
    other = copy(bench)
    other.panel = replace(bench.panel, length=0.75 * bench.panel.length, width=1.3 * bench.panel.width)
    other.attachments = []
    of_other = files.piece_text(other).replace("[piece]", '[[piece]]\nname = "other"').split("\n[")[0]
    both = f"{of_other}\n{named(alone, 'hit')}\n"
    both += natural_frequencies(random, bench, "hit") + natural_frequencies(random, other, "other")
    (folder / "both.toml").write_text(both, encoding="utf-8")
    return bench.constants(), folder / "test.toml", folder / "both.toml"


def asked(command, test, *more):
    """What a command says of a test."""
    ran = subprocess.run([ORTHOPANEL, command, test, "--json", *more], capture_output=True, text=True, timeout=400)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


def test_val_an_effect_on_the_piece_that_was_hit_is_found_beside_lists(tests, tmp_path):
    """The mass is found on the piece that was hit, whose list agrees, and is not on the other, whose list would contradict it."""
    _, _, both = tests
    found = asked("trace", both)
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["local-mass"]), found["candidates"][:3]
    for name, truth in [("mass", MASS), ("x", PLACE)]:
        value = found["effects"][0]["parameters"][name]
        assert abs(value["value"] - truth) < 3.0 * value["std"], (name, value)
    assert any("would count twice" in note for note in found["notes"])


def test_val_lists_narrow_the_constants_that_few_records_leave(tests):
    """With the mass declared both tests hold the constants, and lists make them no less sure."""
    truth, alone, both = tests
    known = f'\n[[effect]]\nid = "local-mass"\nmass = {MASS}\nx = {PLACE}\n'
    sure = {}
    for test in (alone, both):
        declared = test.with_name(f"declared-{test.name}")
        declared.write_text(test.read_text(encoding="utf-8") + known, encoding="utf-8")
        found = asked("identify", declared)
        for name in ("e_x", "g_zx"):
            value = found["constants"][name]
            assert abs(value["value"] - truth[name]) < 3.0 * value["std"], (test.name, name, value)
            sure[test.name, name] = value["std"]
    for name in ("e_x", "g_zx"):
        assert sure["both.toml", name] < sure["test.toml", name], sure


SENSOR = 0.008  # kg


def within(folder, text):
    """The measurements of a test file, found from the folder above its own."""
    return text.replace('file = "', f'file = "{folder.name}/')


def test_val_a_sensor_on_two_pieces_is_found_from_the_records_of_both(tmp_path):
    """Two pieces of one make, each hit with the same sensor on: one mass, constants in common, and the panel of each without the sensor."""
    random = np.random.default_rng(2311)
    long = replace(benches.draw(random, "single"), suspension=())
    short = copy(long)
    short.panel = replace(long.panel, length=round(0.8 * long.panel.length, 3), width=round(1.2 * long.panel.width, 3))
    short.forces, short.response = np.round(0.8 * long.forces, 3), round(0.8 * long.response, 3)
    text = ""
    for name, bench in [("long", long), ("short", short)]:
        bench.attachments = [(bench.response, attachments.mass(SENSOR))]
        files.write_case(tmp_path / name, bench, records.play(bench, random))
        alone = (tmp_path / name / "test.toml").read_text(encoding="utf-8")
        text += within(tmp_path / name, named(alone, name)) + "\n"
    test = tmp_path / "test.toml"
    test.write_text(text, encoding="utf-8")
    found = asked("trace", test)
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["sensor-mass"]), found["candidates"][:3]
    mass = found["effects"][0]["parameters"]["mass"]
    assert abs(mass["value"] - SENSOR) < 3.0 * mass["std"] < 0.5 * SENSOR, mass
    reasons = {one["id"]: one["reason"] for one in found["not_tested"]}
    assert "trace one piece" in reasons["local-mass"]
    # With the sensor declared, each piece is identified with it, and drawn by its own records.
    test.write_text(f'{text}\n[[effect]]\nid = "sensor-mass"\n', encoding="utf-8")
    found = asked("identify", test)
    truth = long.constants()
    for name in ("e_x", "g_zx"):
        value = found["constants"][name]
        assert abs(value["value"] - truth[name]) < 3.0 * value["std"], (name, value)
    assert {mode["piece"] for mode in found["modes"]} == {"long", "short"}
    assert all(abs(mode["error_percent"]) < 0.05 for mode in found["modes"]), found["modes"]
    # What stands at a place would be on one of the two, and the file cannot say on which.
    test.write_text(f'{text}\n[[effect]]\nid = "local-mass"\nx = 0.1\n', encoding="utf-8")
    ran = subprocess.run([ORTHOPANEL, "trace", test], capture_output=True, text=True, timeout=400)
    assert ran.returncode != 0 and "trace one piece in a test file" in ran.stderr, ran.stderr


def test_val_hits_beside_a_file_of_accelerances_of_one_piece_find_a_mass_together(tmp_path):
    """One place hit, another kept by the analyser as an accelerance."""
    random = np.random.default_rng(2312)
    bench = replace(benches.draw(random, "single", sampling=accelerances.SAMPLING), suspension=())
    bench.attachments = [(PLACE, attachments.mass(MASS))]
    files.write_case(tmp_path / "hits", bench, records.play(bench, random))
    other = copy(bench)
    other.forces = np.array([-0.3 * bench.panel.length])
    accelerances.write_case(tmp_path / "lines", other, records.play(other, random))
    texts = {name: within(tmp_path / name, (tmp_path / name / "test.toml").read_text(encoding="utf-8")) for name in ("hits", "lines")}
    test = tmp_path / "test.toml"
    test.write_text(texts["hits"] + "\n[[measurement]]" + texts["lines"].split("[[measurement]]")[1], encoding="utf-8")
    found = asked("trace", test)
    assert (found["verdict"], [effect["id"] for effect in found["effects"]]) == ("explained", ["local-mass"]), found["candidates"][:3]
    for name, truth in [("mass", MASS), ("x", PLACE)]:
        value = found["effects"][0]["parameters"][name]
        assert abs(value["value"] - truth) < 3.0 * value["std"], (name, value)
