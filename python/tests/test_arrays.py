"""Arrays in against files in; pickles; tables of others."""

import pickle
import warnings

import h5py
import numpy as np
import pytest
from conftest import EXAMPLES
from nptdms import ChannelObject, TdmsFile, TdmsWriter
from scipy.io import loadmat, savemat

import orthopanel as op

RATE = 10240.0
PLACES = {"force_at": (-0.3, 0.0), "response_at": (0.3, 0.0)}


@pytest.fixture(scope="module")
def records():
    """Three made hits on the paper's piece 1: force and acceleration, hits x samples."""
    rng = np.random.default_rng(3)
    time = np.arange(8192) / RATE
    model = op.Model.from_json(
        '{"schema": "orthopanel.model/1", "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},'
        '"structure": "timoshenko-beam", "constants": {"e_x": 1.07e10, "g_zx": 5.363e8}, "damping": {"beyond": 0.004}}'
    )
    force = np.array([level * np.exp(-0.5 * ((time - 0.01) / 8e-5) ** 2) for level in (80.0, 95.0, 110.0)])
    lines = np.fft.rfftfreq(2 * time.size, 1 / RATE)
    response = model.accelerance(lines, **PLACES) * np.fft.rfft(force, 2 * time.size)
    acceleration = np.fft.irfft(response)[:, : time.size]
    return [of + 1e-3 * of.std() * rng.standard_normal(of.shape) for of in (force, acceleration)]


def built(piece, force, acceleration, **options):
    test = op.Test(piece)
    test.add_hits(force, acceleration, RATE, **PLACES, **options)
    return test


@pytest.fixture(scope="module")
def fit(records):
    return op.identify(built(op.Piece(0.8, 0.1, 0.03, 6.88), *records))


def test_arrays_give_what_files_give(records, fit, tmp_path):
    force, acceleration = records
    entries = []
    for hit, (f, a) in enumerate(zip(force, acceleration, strict=True)):
        rows = np.column_stack([np.arange(f.size) / RATE, f, a])
        lines = "\n".join(",".join(map(repr, row)) for row in rows.tolist())
        (tmp_path / f"hit-{hit}.csv").write_text(f"time_s,force_n,acceleration_m_s2\n{lines}\n")
        entries.append(f'"hit-{hit}.csv"')
    (tmp_path / "test.toml").write_text(
        "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n[[measurement]]\nkind = 'time-history'\n"
        f"file = [{', '.join(entries)}]\nforce_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]\n"
    )
    filed = op.identify(op.Test.load(tmp_path))
    for name in ("e_x", "g_zx"):
        assert fit.value(name) == pytest.approx(filed.value(name), rel=1e-9)
        # And both what made the records.
        due = {"e_x": 1.07e10, "g_zx": 5.363e8}[name]
        assert fit.value(name) == pytest.approx(due, rel=1e-3)


def test_any_order_of_memory_is_read(piece, records, fit):
    force, acceleration = records
    for change in (np.asfortranarray, lambda of: np.repeat(of, 2, axis=1)[:, ::2], lambda of: of.tolist(), read_only):
        test = built(piece, change(force), change(acceleration))
        assert op.identify(test).to_dict() == fit.to_dict()
    single = built(piece, force[0], acceleration[0])
    assert len(single) == 1


def read_only(of):
    of = of.copy()
    of.flags.writeable = False
    return of


def of_mat(path, channels):
    savemat(path, channels)
    return loadmat(path)


def of_hdf5(path, channels):
    with h5py.File(path, "w") as file:
        for name, values in channels.items():
            file.create_dataset(name, data=values)
    with h5py.File(path) as file:
        return {name: file[name][:] for name in channels}


def of_tdms(path, channels):
    with TdmsWriter(path) as file:
        for name, values in channels.items():
            file.write_segment([ChannelObject(name, f"hit {hit}", of) for hit, of in enumerate(values)])
    file = TdmsFile.read(path)
    return {name: [channel[:] for channel in file[name].channels()] for name in channels}


@pytest.mark.parametrize("through", [of_mat, of_hdf5, of_tdms])
def test_other_formats_arrive_through_their_packages(piece, records, fit, through, tmp_path):
    channels = through(tmp_path / "records", dict(zip(("force", "acceleration"), records, strict=True)))
    assert op.identify(built(piece, channels["force"], channels["acceleration"])).to_dict() == fit.to_dict()


def test_units_and_direction(piece, records, fit):
    force, acceleration = records
    test = built(piece, force / 4.4482216152605, -acceleration / 9.80665, force_unit="lbf", response_unit="g", direction=-1)
    assert op.identify(test).value("e_x") == pytest.approx(fit.value("e_x"), rel=1e-6)


def test_accelerances_and_frequencies(piece, fit):
    of = fit.accelerances[0]
    test = op.Test(piece)
    test.add_accelerance(of.frequency, of.measured, **PLACES)
    assert op.identify(test).value("e_x") == pytest.approx(fit.value("e_x"), rel=1e-3)
    test = op.Test(piece)
    test.add_frequencies(fit.modes["measured_hz"], resolution=0.1)
    assert op.identify(test).value("e_x") == pytest.approx(fit.value("e_x"), rel=1e-3)
    data = of.to_xarray()
    assert (data.sizes["frequency"], data["measured"].attrs["units"]) == (of.frequency.size, "(m/s2)/N")


def test_everything_pickles(piece, records, fit):
    test = built(piece, *records)
    again = pickle.loads(pickle.dumps(test))
    assert op.identify(again).to_dict() == fit.to_dict()
    assert pickle.loads(pickle.dumps(fit)).model == fit.model
    assert pickle.loads(pickle.dumps(fit)).to_dict() == fit.to_dict()
    loaded = pickle.loads(pickle.dumps(op.Test.load(EXAMPLES / "misplaced-hit")))
    why = pickle.loads(pickle.dumps(op.trace(loaded)))
    assert (why.verdict, list(why.models)) == ("explained", ["1"])
    with pytest.raises(op.InputError) as refused:
        op.Test(piece).add_frequencies([300.0, 200.0])
    copy = pickle.loads(pickle.dumps(refused.value))
    assert (str(copy), copy.key) == (str(refused.value), refused.value.key)


def test_a_fit_stays_what_it_was(piece):
    test = op.Test(piece)
    test.add_frequencies([321.3, 837.5, 1520.0])
    fit = op.identify(test)
    test.add_frequencies([330.0, 840.0, 1530.0])
    assert (len(test), len(fit._test)) == (2, 1)


def test_pictures_are_drawn(fit, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fit.plot().savefig(tmp_path / "fit.png")
        why = op.trace(op.Test.load(EXAMPLES / "piece-1"))
        why.plot().savefig(tmp_path / "why.png")
        op.identify(op.Test.load(EXAMPLES / "pieces-1-2")).plot().savefig(tmp_path / "list.svg")
    assert all((tmp_path / name).stat().st_size > 5000 for name in ("fit.png", "why.png", "list.svg"))
    # What a notebook asks of what a cell ends with, in which nothing of matplotlib was called.
    assert pickle.loads(pickle.dumps(why.plot()))._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
