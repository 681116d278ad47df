"""The folder that a test is written to, read back by other readers than the ones under test."""

import dataclasses
import json
import tomllib

import numpy as np
import pytest

from . import cli, files
from .records import Setup, record

SHORT = Setup(samples=2048, hits=2, pairs=((-0.3, 0.3), (0.13, 0.3)))


@pytest.fixture(scope="module")
def made():
    """One short test, for every format."""
    return record(SHORT)


def test_csv_holds_the_records(made, tmp_path):
    """Ten digits of each value; one file and one measurement a hit, places as asked."""
    plan = tomllib.loads(files.write(SHORT, *made, tmp_path / "t").read_text())
    assert plan["piece"] == {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}
    hits = [(pair, hit) for pair, place in zip(SHORT.pairs, made[1]) for hit in place]
    assert len(plan["measurement"]) == len(hits) == 4
    for measurement, (pair, hit) in zip(plan["measurement"], hits):
        assert measurement["kind"] == "time-history"
        assert (measurement["force_at"], measurement["response_at"]) == ([pair[0], 0.0], [pair[1], 0.0])
        lines = (tmp_path / "t" / measurement["file"]).read_text().splitlines()
        assert lines[0] == "time_s,force_n,acceleration_m_s2"
        table = np.array([line.split(",") for line in lines[1:]], dtype=float)
        np.testing.assert_allclose(table[:, 0], np.arange(2048) / 16384.0, rtol=1e-11)
        np.testing.assert_allclose(table[:, 1], hit.force, rtol=1e-9)
        np.testing.assert_allclose(table[:, 2], hit.acceleration, rtol=1e-9)


@pytest.mark.parametrize("kind", ["uff", "uff-binary"])
def test_uff_holds_the_records(made, tmp_path, kind):
    """Read by pyuff: force and acceleration in pairs, a file a place; ASCII carries 12 digits, binary all of them."""
    pyuff = pytest.importorskip("pyuff")
    plan = tomllib.loads(files.write(SHORT, *made, tmp_path, kind).read_text())
    assert [m["file"] for m in plan["measurement"]] == ["point-0.uff", "point-1.uff"]
    for measurement, place in zip(plan["measurement"], made[1]):
        sets = pyuff.UFF(str(tmp_path / measurement["file"])).read_sets()
        assert [s["ordinate_spec_data_type"] for s in sets] == [files.FORCE, files.ACCELERATION] * 2
        for s, signal in zip(sets, [x for hit in place for x in (hit.force, hit.acceleration)]):
            np.testing.assert_allclose(s["data"], signal, rtol=0.0 if kind == "uff-binary" else 1e-11)


def test_unit_and_direction_are_declared(tmp_path):
    """A sensor turned round that reads in g is never silent: test.toml says both. The file's header says the unit
    too, and takes the sensor for a plain one: a sign told twice could be applied twice."""
    pyuff = pytest.importorskip("pyuff")
    setup = dataclasses.replace(SHORT, unit="g", sensor_sign=-1)
    plan = tomllib.loads(files.write(setup, *record(setup), tmp_path, "uff").read_text())
    assert all(m["unit"] == "g" and m["direction"] == -1 for m in plan["measurement"])
    motion = pyuff.UFF(str(tmp_path / "point-0.uff")).read_sets()[1]
    assert motion["ordinate_axis_units_lab"].strip() == "g" and motion["rsp_dir"] == 3


def test_truth_tells_what_went_in(made, tmp_path):
    """Constants, damping ratios in the order of the modes, and the hits of each place."""
    files.write(SHORT, *made, tmp_path)
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert truth["constants"]["e_x"] == 1.067e10 and truth["constants"]["g_zx"] == 5.304e8
    assert [m["zeta"] for m in truth["modes"][:7]] == [*SHORT.zeta, 0.004]
    assert [len(p["hits"]) for p in truth["points"]] == [2, 2]


def test_a_folder_in_use_is_not_written_over(made, tmp_path):
    """The second writer is refused and the first one's files stay: to a UFF file it would have added."""
    files.write(SHORT, *made, tmp_path)
    with pytest.raises(ValueError, match="not empty"):
        files.write(SHORT, *made, tmp_path)


def test_g_in_csv_is_refused(made, tmp_path):
    """The CSV contract's column is in m/s2; nothing is written."""
    with pytest.raises(ValueError, match="acceleration_m_s2"):
        files.write(dataclasses.replace(SHORT, unit="g"), *made, tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_the_command_writes_a_test_and_refuses_nonsense(tmp_path, capsys):
    """The options reach the records; a place off the piece ends with exit 2, one line, and no folder."""
    small = ["--samples", "2048", "--hits", "1"]
    cli.main([str(tmp_path / "a"), *small, "--pair", "-0.1", "0.2", "--seed", "5", "--e-x", "7e9", "--noise", "0"])
    truth = json.loads((tmp_path / "a" / "truth.json").read_text())
    assert truth["constants"]["e_x"] == 7e9 and truth["seed"] == 5 and truth["noise"]["level"] == 0.0
    assert [(p["force_at"], p["response_at"]) for p in truth["points"]] == [(-0.1, 0.2)]
    capsys.readouterr()
    with pytest.raises(SystemExit) as left:
        cli.main([str(tmp_path / "b"), *small, "--pair", "0.5", "0.3"])
    message = capsys.readouterr().err
    assert left.value.code == 2 and message.count("\n") == 1 and "x = 0.5 m lies off the piece" in message
    assert not (tmp_path / "b").exists()
