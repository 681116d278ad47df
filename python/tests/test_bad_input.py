"""Bad input: a Python exception of the right type, never a panic or a crash."""

import numpy as np
import pytest

import orthopanel as op

GOOD = np.sin(np.arange(2048.0)).reshape(2, 1024)
PLACES = {"force_at": (-0.3, 0.0), "response_at": (0.3, 0.0)}
RATE = 10240.0

# force, acceleration, rate, other arguments; exception, what it says.
HITS = [
    (GOOD.astype(complex), GOOD, RATE, {}, TypeError, "complex128"),
    (GOOD.astype(object), GOOD, RATE, {}, TypeError, "object"),
    (GOOD > 0, GOOD, RATE, {}, TypeError, "bool"),
    ("records.uff", GOOD, RATE, {}, TypeError, "dtype"),
    (None, GOOD, RATE, {}, TypeError, "dtype"),
    ([[1.0, 2.0], [3.0]], GOOD, RATE, {}, ValueError, "force"),
    (GOOD[None], GOOD, RATE, {}, op.InputError, "3 dimensions"),
    (GOOD, GOOD[:1], RATE, {}, op.InputError, "hits"),
    (GOOD, GOOD[:, :1000], RATE, {}, op.InputError, "samples"),
    (np.zeros((0, 0)), np.zeros((0, 0)), RATE, {}, op.InputError, "no hit"),
    (np.zeros((2, 0)), np.zeros((2, 0)), RATE, {}, op.InputError, "no hit"),
    (np.where(GOOD > 0.99, np.nan, GOOD), GOOD, RATE, {}, op.InputError, "hit 1, force: point"),
    (GOOD, np.where(GOOD > 0.99, np.inf, GOOD), RATE, {}, op.InputError, "hit 1, response: point"),
    (np.ma.masked_greater(GOOD, 0.5), GOOD, RATE, {}, op.InputError, "masked"),
    (GOOD, GOOD, 0.0, {}, op.InputError, "sampling_rate"),
    (GOOD, GOOD, -1.0, {}, op.InputError, "sampling_rate"),
    (GOOD, GOOD, float("nan"), {}, op.InputError, "sampling_rate"),
    (GOOD, GOOD, "fast", {}, TypeError, "sampling_rate"),
    (GOOD, GOOD, RATE, {"force_at": (9.0, 0.0)}, op.InputError, "force_at"),
    (GOOD, GOOD, RATE, {"force_at": (0.0, 0.0, 0.0)}, op.InputError, "3 numbers"),
    (GOOD, GOOD, RATE, {"force_at": "left"}, TypeError, "force_at"),
    (GOOD, GOOD, RATE, {"force_at": (np.nan, 0)}, op.InputError, "force_at"),
    (GOOD, GOOD, RATE, {"response_unit": "furlong"}, op.InputError, "no unit"),
    (GOOD, GOOD, RATE, {"response_unit": "N"}, op.InputError, "response_unit"),
    (GOOD, GOOD, RATE, {"force_unit": "g"}, op.InputError, "force_unit"),
    (GOOD, GOOD, RATE, {"response_unit": 3}, TypeError, "response_unit"),
    (GOOD, GOOD, RATE, {"quantity": "strain"}, op.InputError, "quantity"),
    (GOOD, GOOD, RATE, {"direction": 0}, op.InputError, "direction"),
    (GOOD, GOOD, RATE, {"band": (1.0,)}, op.InputError, "band"),
    (GOOD, GOOD, RATE, {"band": (900.0, 100.0)}, op.InputError, "band"),
    (GOOD, GOOD, RATE, {"piece": "other"}, op.InputError, "piece"),
    (GOOD, GOOD, RATE, {"trigger": {"height": 1}}, op.InputError, "trigger"),
]


@pytest.mark.parametrize("force, acceleration, rate, others, refused, told", HITS)
def test_hits(piece, force, acceleration, rate, others, refused, told):
    test = op.Test(piece)
    with pytest.raises(refused, match=told):
        test.add_hits(force, acceleration, rate, **{**PLACES, **others})
    assert len(test) == 0


@pytest.mark.parametrize("others", [{"response_unit": "N"}, {"response_unit": "m/s", "quantity": "acceleration"}])
def test_units_that_do_not_fit(piece, others):
    with pytest.raises(op.InputError):
        test = op.Test(piece)
        test.add_hits(GOOD, GOOD, RATE, **PLACES, **others)
        op.identify(test)


def test_errors_tell_file_key_and_way_out(piece, tmp_path):
    (tmp_path / "test.toml").write_text("[piece]\nlength = -1\n")
    with pytest.raises(op.InputError) as refused:
        op.Test.load(tmp_path)
    error = refused.value
    assert isinstance(error, ValueError)
    assert (error.file, error.line, error.key) == (str(tmp_path / "test.toml"), 2, "piece.length")
    assert error.way_out and error.way_out in str(error)
    with pytest.raises(op.MissingFileError) as missing:
        op.Test.load(tmp_path / "nowhere.toml")
    assert isinstance(missing.value, FileNotFoundError) and "nowhere.toml" in (missing.value.file or "")
    with pytest.raises(op.FileError):
        op.Model.load("examples/plate.json" if False else _plate()).export(tmp_path / "no" / "such" / "x.fmu")
    with pytest.raises(op.InputError, match=r"\.fmu"):
        op.Model.load(_plate()).export(tmp_path / "x.zip")
    with pytest.raises(op.InputError, match="test file"):
        op.Model.load(tmp_path / "test.toml")
    with pytest.raises(op.InputError) as negative:
        op.Test(piece, constants={"e_x": -1.0})
    assert negative.value.key == "constants.e_x"


@pytest.mark.parametrize(
    "make, told",
    [
        (lambda piece: op.Test(None), "piece"),
        (lambda piece: op.Test(piece, boundary=3), "boundary"),
        (lambda piece: op.Test(piece, boundary={"left": 3}), "boundary.left"),
        (lambda piece: op.Test(piece, structure=3), "structure"),
        (lambda piece: op.Test(piece, constants=[1]), "constants"),
        (lambda piece: op.Model.load(_plate()).accelerance([10.0], 0.0, 0.0, quantity=[3]), "quantity"),
    ],
)
def test_arguments_of_another_type_are_named(piece, make, told):
    with pytest.raises(TypeError, match=f"^{told}: must be"):
        make(piece)


def test_draws_without_end_and_pages_without_a_folder_are_refused(piece, tmp_path):
    with pytest.raises(op.InputError, match="count = 1000000000000: must be a whole number from 0 to 1000000"):
        op.Model.load(_plate()).sample(10**12)
    test = op.Test(piece)
    test.add_frequencies([321.3, 837.5, 1520.0, 2312.5])
    with pytest.raises(op.FileError, match="cannot be written"):
        op.identify(test).report(tmp_path / "no" / "page.html")


def _plate():
    from conftest import EXAMPLES

    return EXAMPLES / "plate.json"


def test_data_that_say_no(piece):
    test = op.Test(piece)
    test.add_hits(np.zeros((2, 4096)), np.zeros((2, 4096)), RATE, **PLACES)
    with pytest.raises(op.RefusedError, match="no hit can be used"):
        op.identify(test)


@pytest.mark.parametrize(
    "make",
    [
        lambda piece: op.Test([]),
        lambda piece: op.Test(piece, boundary={"left": "loose"}),
        lambda piece: op.Test(piece, boundary={"top": "free"}),
        lambda piece: op.Test(piece, structure="membrane"),
        lambda piece: op.Test(piece, suspension=[(5.0, 0.0)]),
        lambda piece: op.Test(piece, constants={"young": 1.0}),
        lambda piece: op.Test(piece, constants={"e_x": {"low": 1.0}}),
        lambda piece: op.Test(piece, effects=[{"mass": 1.0}]),
        lambda piece: op.Piece(float("nan"), 0.1, 0.03, 6.88),
        lambda piece: op.identify(op.Test(piece)),
        lambda piece: op.trace(op.Test(piece)),
        lambda piece: op.identify(op.Test(piece), damping="dry"),
        lambda piece: op.identify(op.Test(piece), window="force-exponential"),
        lambda piece: op.identify(op.Test(piece), window="hann", tau=1.0),
        lambda piece: op.identify(op.Test(piece), tau=float("inf")),
    ],
)
def test_tests_and_options(piece, make):
    with pytest.raises(ValueError):
        make(piece)


@pytest.mark.parametrize(
    "make",
    [
        lambda piece: op.Test("piece"),
        lambda piece: op.Piece("long", 0.1, 0.03, 6.88),
        lambda piece: op.Test(piece, suspension=3.0),
        lambda piece: op.identify("test.toml"),
        lambda piece: op.trace(op.Test(piece), reference="good.toml"),
        lambda piece: op.Test(piece, constants={"e_x": "stiff"}),
    ],
)
def test_types(piece, make):
    with pytest.raises(TypeError):
        make(piece)


@pytest.mark.parametrize(
    "ask, refused",
    [
        (lambda model: model.accelerance([-1.0], -0.3, 0.3), ValueError),
        (lambda model: model.accelerance([np.nan], -0.3, 0.3), ValueError),
        (lambda model: model.accelerance(["a"], -0.3, 0.3), TypeError),
        (lambda model: model.accelerance([1j], -0.3, 0.3), TypeError),
        (lambda model: model.accelerance([1.0], 7.0, 0.3), ValueError),
        (lambda model: model.accelerance([1e9], -0.3, 0.3), ValueError),
        (lambda model: model.accelerance([1.0], -0.3, 0.3, "noise"), ValueError),
        (lambda model: model.accelerance([1.0], -0.3, 0.3, modes=-1), ValueError),
        (lambda model: model.accelerance([1.0], -0.3, 0.3, modes=10**7), ValueError),
        (lambda model: model.mode_shape(0, 0.0), ValueError),
        (lambda model: model.mode_shape(10**6, 0.0), ValueError),
        (lambda model: model.mode_shape(1, 9.0), ValueError),
        (lambda model: model.mode_shape(1, [0.0, 0.1], [0.0, 0.1, 0.2]), ValueError),
        (lambda model: model.mode_shape(1.5, 0.0), TypeError),
        (lambda model: model.state_space(10**6), ValueError),
        (lambda model: model.state_space(5, forces=[]), ValueError),
        (lambda model: model.state_space(5, forces=[(9, 9)]), ValueError),
        (lambda model: model.sample(-1), ValueError),
        (lambda model: model.sample(2, seed=-1), ValueError),
        (lambda model: model.sample("many"), TypeError),
        (lambda model: model.export("x.fmu", fmi=1), ValueError),
        (lambda model: model.export("x.fmu", name="two words"), ValueError),
        (lambda model: op.Model.from_json("{}"), ValueError),
        (lambda model: op.Model.from_json("\0"), ValueError),
    ],
)
def test_models(ask, refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(refused):
        ask(op.Model.load(_plate()))
    assert list(tmp_path.iterdir()) == []
