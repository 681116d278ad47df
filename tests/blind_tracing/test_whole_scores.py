"""The scorer of constants, and that of places on a plate, against answers whose score is plain."""

import json
import sys

import pytest

from . import cli, constants, judge

TRUTH = {
    "case": "case-000",
    "kind": "none",
    "effects": [],
    "places": 12,
    "constants": {"e_x": 1.0e10, "nu_xy": 0.3, "g_zx": 4.0e8, "shear_coefficient": 2.0 / 3.0},
}


def answer(e_x=(1.01e10, 1e8), nu=(0.33, 0.01), open_to=None):
    """Constants as `identify` prints them; `open_to` is the interval of a g_zx that it holds."""
    entry = lambda value, std: {"value": value, "std": std, "unit": "Pa", "held": False}  # noqa: E731
    given = {"e_x": entry(*e_x), "nu_xy": entry(*nu), "g_zx": entry(4.4e8, None if open_to else 1e8)}
    not_identified = [{"name": "g_zx", "held_at": 4.4e8, "interval": open_to}] if open_to else []
    return {"schema": "orthopanel.identified/1", "constants": given, "not_identified": not_identified, "seconds": 1.5}


def test_errors_in_percent_and_in_deviations():
    """1 % and one deviation, 10 % and three, 10 % and 0.4: two of three inside 2.5."""
    judged = constants.case(TRUTH, answer())
    found = {name: (one["percent"], one["deviations"]) for name, one in judged["constants"].items()}
    for name, wanted in {"e_x": (1.0, 1.0), "nu_xy": (10.0, 3.0), "g_zx": (10.0, 0.4)}.items():
        assert found[name] == pytest.approx(wanted), name
    result = constants.summary([judged])
    assert [rate["reached"] for rate in result["rates"]] == [1.0, pytest.approx(2.0 / 3.0)]
    assert not result["reached"]
    assert "nu_xy +10 (+3.0)" in constants.text({"set": "whole", "seed": 1} | result)


def test_what_is_held_is_counted_apart():
    """It enters no rate of deviations; whether the truth lies in the interval left open is told."""
    held = [constants.case(TRUTH, answer(open_to=interval)) for interval in ([3e8, 5e8], [4.2e8, 5e8])]
    row = constants.summary(held)["constants"]["nothing missing"]["g_zx"]
    assert (row["told"], row["held"], row["held_open_to_truth"], row["inside"]) == (0, 2, 1, 0)
    assert constants.summary(held)["rates"][1]["of"] == 4


@pytest.mark.parametrize("std", [None, 0.0, float("nan")])
def test_a_value_without_a_deviation_is_not_inside(std):
    """As the true value itself, too."""
    judged = constants.case(TRUTH, answer(e_x=(1e10, std)))
    assert constants.summary([judged])["constants"]["nothing missing"]["e_x"]["inside"] == 0


def test_a_refusal_and_a_missing_constant_are_no_answers():
    """Each with its reason."""
    partial = answer()
    del partial["constants"]["nu_xy"]
    judged = [constants.case(TRUTH, {"reason": "exit 1: half of all lines miss"}), constants.case(TRUTH, partial)]
    assert [one["refused"] for one in judged] == ["exit 1: half of all lines miss", "no nu_xy in the answer"]
    assert constants.summary(judged)["rates"][0]["reached"] == 0.0


def test_errors_with_an_effect_missing_enter_no_rate():
    """They stand in a table of their own."""
    judged = constants.case(TRUTH | {"effects": [{"id": "gain", "parameters": {}}]}, answer())
    result = constants.summary([judged])
    assert result["rates"][1]["of"] == 0 and list(result["constants"]) == ["an effect missing"]


def test_the_command_runs_a_set(tmp_path, capsys):
    """As a user calls it: a program that prints an answer for one case and fails on the other."""
    (tmp_path / "truth.json").write_text(
        json.dumps({"schema": "orthopanel.blind-truth/1", "set": "whole", "seed": 1, "cases": [TRUTH, TRUTH | {"case": "case-001"}]})
    )
    for name in ("case-000", "case-001"):
        (tmp_path / name).mkdir()
    program = tmp_path / "identify.py"
    program.write_text(
        "import sys\nassert sys.argv[2:] == ['--json'], sys.argv\n"
        "if 'case-001' in sys.argv[1]: print('{\"error\": \"no modes\"}'), sys.exit(1)\n"
        f"print({json.dumps(answer())!r})\n"
    )
    with pytest.raises(SystemExit) as ended:
        cli.main(["constants", str(tmp_path), "--command", f"{sys.executable} {program}", "--json", str(tmp_path / "out.json")])
    assert ended.value.code == 1
    assert "exit 1: no modes" in capsys.readouterr().out
    result = json.loads((tmp_path / "out.json").read_text())
    assert result["schema"] == "orthopanel.blind-constants/1" and result["refused"] == 1


@pytest.mark.parametrize("x, placed", [(0.204, 1.0), (0.215, 0.0)])
def test_places_count_over_x_and_y(x, placed):
    """5 and 15.3 mm from a mass at (0.2, -0.1): within 10 mm or not, each told in mm."""
    truth = TRUTH | {"kind": "local-mass", "rough": False, "effects": [{"id": "local-mass", "parameters": {"mass": 0.05, "x": 0.2, "y": -0.1}}]}
    given = {"mass": {"value": 0.05, "std": 1e-3}, "x": {"value": x, "std": 0.01}, "y": {"value": -0.103, "std": 0.01}}
    named = {"verdict": "explained", "effects": [{"id": "local-mass", "parameters": given}], "alternatives": []}
    result = judge.summary("whole", [judge.case(truth, named)])
    assert {rate["name"]: rate["reached"] for rate in result["rates"]}["a mass named within 10 mm of its place"] == placed
    assert result["place_mm"]["local-mass"] == [pytest.approx(1e3 * ((x - 0.2) ** 2 + 0.003**2) ** 0.5)]
