"""Every number is the command's."""

import json
import pickle

import numpy as np
import pytest
from conftest import EXAMPLES

import orthopanel as op

QUANTITIES = {"acceleration": 0, "mobility": 1, "receptance": 2}


def without_origin(answer):
    return {name: of for name, of in answer.items() if name != "provenance"}


@pytest.fixture(scope="module")
def hits():
    test = op.Test.load(EXAMPLES / "made-hits")
    return test, op.identify(test)


@pytest.mark.parametrize("example", ["piece-1", "pieces-1-2", "pieces-1-2-plate", "made-hits"])
def test_identify(command, example, tmp_path):
    test = op.Test.load(EXAMPLES / example / "test.toml")
    fit = op.identify(test)
    answer = command("identify", EXAMPLES / example / "test.toml", "-o", tmp_path / "model.json", "--json")
    assert fit.to_dict() == without_origin(answer)
    for name, of in answer["constants"].items():
        assert fit.value(name) == of["value"]
        assert fit.constants.loc[name, "held"] == of["held"]
    suffixes = [""] if len(fit.models) == 1 else [f"-{name}" for name in fit.models]
    for suffix, model in zip(suffixes, fit.models.values(), strict=True):
        assert model.to_json() == (tmp_path / f"model{suffix}.json").read_text()


def test_covariance_holds_deviations_and_correlations(command):
    answer = command("identify", EXAMPLES / "pieces-1-2", "--json")
    covariance = op.identify(op.Test.load(EXAMPLES / "pieces-1-2")).covariance
    for pair in answer["correlations"]:
        first, second = pair["first"], pair["second"]
        stds = [answer["constants"][name]["std"] for name in (first, second)]
        assert covariance.loc[first, second] == pytest.approx(pair["value"] * stds[0] * stds[1], rel=1e-14)
        assert covariance.loc[first, first] == pytest.approx(stds[0] ** 2, rel=1e-14)


def test_trace(command, tmp_path):
    test = op.Test.load(EXAMPLES / "misplaced-hit")
    why = op.trace(test)
    answer = command("trace", EXAMPLES / "misplaced-hit", "-o", tmp_path / "model.json", "--json")
    assert why.to_dict() == without_origin(answer)
    assert (why.verdict, why.error) == (answer["verdict"], answer["error"])
    found = answer["effects"][0]
    row = why.effects.iloc[0]
    assert (row["effect"], row["owner"], row["parameter"]) == (found["id"], found["owner"], "offset")
    assert row["value"] == found["parameters"]["offset"]["value"]
    assert why.model.to_json() == (tmp_path / "model.json").read_text()


def test_report_is_the_commands(command, hits, tmp_path, monkeypatch):
    test, fit = hits
    monkeypatch.chdir(EXAMPLES.parent)
    test = op.Test.load("examples/made-hits")
    fit = op.identify(test)
    fit.report(tmp_path / "one.html", trace=op.trace(test))
    command("report", "examples/made-hits", "-o", tmp_path / "two.html")
    assert (tmp_path / "one.html").read_bytes() == (tmp_path / "two.html").read_bytes()
    # A fit from afar has no native part: the page is made anew.
    pickle.loads(pickle.dumps(fit)).report(tmp_path / "three.html")
    assert "Hammer test" in (tmp_path / "three.html").read_text()


@pytest.mark.parametrize("model", ["plate", "clamped-plate"])
def test_models_answer_as_the_command(command, model, tmp_path):
    path = EXAMPLES / f"{model}.json"
    of = op.Model.load(path)
    line = ["--force", "-0.2,0.01", "--response", "0.3,0.02", "--from", "10", "--to", "900", "--lines", "90"]
    answer = command("accelerance", path, *line, "--json")
    frequency = np.array(answer["frequency_hz"])
    due = np.array(answer["real"]) + 1j * np.array(answer["imag"])
    for quantity, order in QUANTITIES.items():
        found = of.accelerance(frequency, (-0.2, 0.01), (0.3, 0.02), quantity)
        assert np.array_equal(found, due / (2j * np.pi * frequency) ** order if order else due)
    assert np.array_equal(of.accelerance(frequency.reshape(9, 10), (-0.2, 0.01), (0.3, 0.02)), due.reshape(9, 10))
    modes = command("modes", path, "--count", "7", "--json")["modes"]
    table = of.modes(7)
    assert table["frequency_hz"].tolist() == [mode["frequency_hz"] for mode in modes]
    assert table["zeta"].tolist() == [mode["zeta"] for mode in modes]
    assert table["kind"].tolist() == [mode["kind"] for mode in modes]


@pytest.mark.parametrize("fmi", [2, 3])
def test_fmus_are_the_commands_bytes(command, fmi, tmp_path):
    path = EXAMPLES / "plate.json"
    op.Model.load(path).export(
        tmp_path / "one.fmu", fmi, modes=6, forces={"seat": (-0.3, 0.0)}, responses=[0.3, (0.0, 0.02)], name="floor"
    )
    places = ["--force", "seat=-0.3", "--response", "0.3", "--response", "0,0.02"]
    command("export", path, "-o", tmp_path / "two.fmu", "--fmi", fmi, "--modes", 6, *places, "--name", "floor")
    assert (tmp_path / "one.fmu").read_bytes() == (tmp_path / "two.fmu").read_bytes()


def test_state_space_is_the_modal_sum():
    model = op.Model.load(EXAMPLES / "plate.json")
    force, response = (-0.2, 0.01), (0.3, 0.02)
    a, b, c, d = model.state_space(modes=8, forces=[force], responses=[response])
    frequency = np.array([20.0, 333.0, 700.0])
    found = [(c @ np.linalg.solve(2j * np.pi * f * np.eye(len(a)) - a, b) + d)[0, 0] for f in frequency]
    # What stands for the modes beyond is left out of the matrices: it is -omega^2 times one number.
    whole = model.accelerance(frequency, force, response, modes=8)
    beyond = (whole - found) / frequency**2
    assert np.allclose(beyond, beyond[0], rtol=1e-6, atol=0)


def test_mode_shapes_are_of_unit_modal_mass():
    model = op.Model.load(EXAMPLES / "plate.json")
    size = model.to_dict()["piece"]
    nodes, weights = np.polynomial.legendre.leggauss(40)
    x, y = nodes[:, None] * size["length"] / 2, nodes[None, :] * size["width"] / 2
    shape = model.mode_shape(2, x, y)
    area = size["length"] * size["width"] / 4 * weights[:, None] * weights[None, :]
    # Of a Mindlin plate the turning of sections carries the rest of the modal mass.
    assert 0.99 < size["mass_per_area"] * (area * shape**2).sum() <= 1.0


def test_draws_go_together(hits):
    _, fit = hits
    draws = fit.model.sample(2000, seed=1)
    assert draws[:3] == fit.model.sample(3, seed=1)
    values = np.array([[draw.constants[name] for name in ("e_x", "g_zx")] for draw in draws])
    due = fit.covariance.to_numpy()
    found = np.cov(values.T)
    # Five standard errors.
    assert np.allclose(found / np.sqrt(np.outer(due.diagonal(), due.diagonal())), [[1, d(due)], [d(due), 1]], atol=5 * 2**0.5 / 2000**0.5)


def d(covariance):
    """The correlation of two."""
    return covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])


def test_saved_models_read_back(hits, tmp_path):
    _, fit = hits
    fit.model.save(tmp_path / "model.json")
    assert op.Model.load(tmp_path / "model.json") == fit.model
    assert json.loads(fit.model.to_json())["schema"] == "orthopanel.model/1"


def test_the_package_brings_the_command(command):
    import subprocess
    import sys
    from pathlib import Path

    program = Path(sys.executable).with_name("orthopanel")
    for words in (["--version"], ["identify", EXAMPLES / "piece-1"], ["identify", "nowhere.toml"], ["modes"]):
        theirs = subprocess.run([program, *words], capture_output=True, text=True, check=False)
        ours = command(*words, code=theirs.returncode)
        assert (theirs.stdout, theirs.stderr) == (ours.stdout, ours.stderr)
    assert subprocess.run([sys.executable, "-m", "orthopanel", "--help"], capture_output=True, check=False).returncode == 0
