"""Campaigns on Dask: the same numbers, nothing lost with a worker, nothing done twice. One cluster serves them all."""

import os
import signal
from functools import partial
from pathlib import Path

import pytest
from conftest import EXAMPLES

import orthopanel as op

pandas, distributed = (pytest.importorskip(name) for name in ("pandas", "distributed"))

MODEL = op.Model.from_json(
    '{"schema": "orthopanel.model/1", "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},'
    '"structure": "timoshenko-beam", "constants": {"e_x": {"value": 1.07e10, "std": 4.5e7}, "g_zx": {"value": 5.363e8, "std": 4.6e6}}}'
)


@pytest.fixture(scope="module")
def client():
    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None, set_as_default=False) as client:
        yield client


def first_frequency(model):
    return {"first_hz": model.modes(1)["frequency_hz"].iloc[0], "threads": op._native.limit_threads(7)}


def once(folder, what, model):
    """Does `what` the first time that it sees a certain model."""
    seen = Path(folder) / "seen"
    if round(model.constants["e_x"]) % 5 == 0 and not seen.exists():
        seen.touch()
        what()
    return first_frequency(model)


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def fail():
    raise OSError("the network was away")


def never(_):
    raise ZeroDivisionError("no")


@pytest.fixture
def models():
    """Twelve, one of which `once` means."""
    drawn = [model for model in MODEL.sample(60, seed=3) if round(model.constants["e_x"]) % 5]
    return [*drawn[:11], next(model for model in MODEL.sample(60, seed=3) if round(model.constants["e_x"]) % 5 == 0)]


@pytest.fixture(scope="module")
def lot(command, tmp_path_factory):
    """Tests, one of them broken, and the table that the command makes of them."""
    folder = tmp_path_factory.mktemp("lot")
    (folder / "test.toml").write_text("[piece]\nlength = -1\n")
    paths = [EXAMPLES / "piece-1", EXAMPLES / "piece-3", folder]
    command("batch", *paths, "-o", folder / "lot.parquet")
    return paths, pandas.read_parquet(folder / "lot.parquet")


def same(rows, due, names):
    for name in names:
        told, asked = (list(of[name].astype(object).where(of[name].notna(), None)) for of in (rows, due))
        assert told == asked, name


COMMON = ["panel", "version", "failed", "structure"]


def test_identified_rows_are_those_of_the_command(lot, client, tmp_path):
    paths, due = lot
    rows = op.campaign.identify(paths, tmp_path, client=client).compute()
    same(rows, due, [*COMMON, "error_percent", "left_out_error_percent"])
    same(rows[:2], due[:2], ["sha256"])
    fit = op.identify(op.Test.load(paths[0]))
    assert rows["e_x"].iloc[0] == fit.value("e_x")
    assert op.Model.from_json(rows["model"].iloc[0]) == fit.model


def test_traced_rows_are_those_of_the_command(command, lot, client, tmp_path):
    paths, due = lot
    rows = op.campaign.trace(paths, tmp_path / "out", client=client).compute()
    same(rows, due, [*COMMON, "verdict", "effects"])
    covariance = op.trace(op.Test.load(paths[0])).model.covariance
    e_x, g_zx, correlation = rows[["e_x_std", "g_zx_std", "corr:e_x:g_zx"]].iloc[0]
    assert covariance.loc["e_x", "g_zx"] == pytest.approx(correlation * e_x * g_zx, rel=1e-14)
    # The command draws what a campaign left.
    command("lot", tmp_path / "out", "-o", tmp_path / "lot.html")


def test_pieces_are_rows(client, tmp_path):
    rows = op.campaign.identify(EXAMPLES / "pieces-1-2", tmp_path, client=client).compute()
    assert (rows["panel"].tolist(), rows["e_x"].nunique()) == (["1", "2"], 1)


def test_arrays_go_to_workers_too(client, piece, tmp_path):
    test = op.Test(piece)
    test.add_frequencies([321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5])
    rows = op.campaign.identify({"left": test}, tmp_path, client=client).compute()
    assert (rows["panel"].tolist(), rows["e_x"].tolist()) == (["left"], [op.identify(test).value("e_x")])


def test_a_worker_that_dies_loses_nothing(client, models, tmp_path):
    out = tmp_path / "out"
    rows = op.campaign.runs(models, partial(once, tmp_path, die), out, client=client).compute()
    assert (tmp_path / "seen").exists(), "no worker died"
    assert rows["run"].tolist() == list(range(12))
    assert rows["failed"].isna().all()
    assert rows["first_hz"].tolist() == [first_frequency(model)["first_hz"] for model in models]
    # And each computes on as many threads as it has.
    assert set(rows["threads"]) == {1}


def test_what_is_done_stays_done(client, models, tmp_path):
    simulate = partial(once, tmp_path, fail)
    first = op.campaign.runs(models, simulate, tmp_path / "out", client=client, retries=0).compute()
    assert first["failed"].dropna().tolist() == ["OSError: the network was away"]
    assert first["e_x"].tolist() == [model.constants["e_x"] for model in models]
    before = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out").iterdir()}
    told = []
    second = op.campaign.runs(
        models, simulate, tmp_path / "out", client=client, retries=0, progress=lambda *of: told.append(of[1:3])
    ).compute()
    assert second["failed"].isna().all() and told == [(11, 12), (12, 12)]
    after = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out").iterdir()}
    assert len(after) == 12 and sum(after.get(name) == when for name, when in before.items()) == 11
    # Other arguments are another campaign.
    third = op.campaign.runs(models[:1], never, tmp_path / "out", client=client, retries=1).compute()
    assert third["failed"].tolist() == ["ZeroDivisionError: no"]


def test_what_is_asked_in_vain(client, tmp_path):
    with pytest.raises(op.InputError, match="no test.toml"):
        op.campaign.trace(tmp_path, tmp_path / "out", client=client)
    with pytest.raises(op.InputError, match="nothing is given"):
        op.campaign.runs([], never, tmp_path, client=client)
    with pytest.raises(TypeError, match="windows"):
        op.campaign.identify(EXAMPLES / "piece-1", tmp_path, client=client, windows="hann")
    with pytest.raises(TypeError, match="Client"):
        op.campaign.identify(EXAMPLES / "piece-1", tmp_path, client="tcp://there:8786")
    assert not list(tmp_path.glob("*.parquet"))
