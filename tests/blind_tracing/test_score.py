"""The scorer against answers whose score is plain, and the folder against what a tracer may see."""

import json
import sys
from xml.etree import ElementTree

import pytest

from . import calibration, cli, files, judge, score

TRUTH = {
    "case": "case-000",
    "kind": "sensor-mass",
    "rough": False,
    "effects": [{"id": "sensor-mass", "parameters": {"mass": 0.010}}],
}


def answer(verdict, *effects, alternatives=(), after=1.0, floor=1.0):
    """A trace that names `effects`: pairs (id, parameters)."""
    named = [{"id": name, "owner": "rig", "parameters": parameters} for name, parameters in effects]
    error = {"before": {"held_out": 9.0}, "after": {"held_out": after}, "noise_floor": floor}
    return {"verdict": verdict, "effects": named, "alternatives": list(alternatives), "error": error}


def mass(value, std):
    """The parameters of a mass."""
    return {"mass": {"value": value, "std": std, "unit": "kg"}}


def reached(name, truth, given):
    """The rates of one case, by their names."""
    return {rate["name"]: rate["reached"] for rate in judge.summary(name, [judge.case(truth, given)])["rates"]}


def test_the_right_name_first_with_a_fair_interval_is_right():
    """One standard deviation off is inside; the held-out error at 1.1 of the floor is near it."""
    rates = reached("clean", TRUTH, answer("explained", ("sensor-mass", mass(0.011, 0.001)), after=1.1))
    assert list(rates.values()) == [1.0, 1.0, 1.0, 1.0]


@pytest.mark.parametrize(
    "given, wrong",
    [
        (answer("explained", ("local-mass", {})), "right effect named first"),
        (answer("nothing-missing"), "right effect named first"),
        (answer("explained", ("sensor-mass", mass(0.013, 0.001))), "parameters inside their 95 % interval"),
        (answer("explained", ("sensor-mass", {"mass": 0.010})), "parameters inside their 95 % interval"),
        (answer("explained", ("sensor-mass", mass(0.01, 0.001)), after=1.3), "held-out error after"),
    ],
)
def test_each_fault_is_counted(given, wrong):
    """A wrong name, no name, three deviations off, no deviation stated, an error above the floor."""
    rates = reached("clean", TRUTH, given)
    assert [value for name, value in rates.items() if name.startswith(wrong)] == [0.0]


def test_an_alternative_counts_at_a_single_place_only():
    """With one place the right effect may stand among the alternatives."""
    given = answer("ambiguous", ("local-mass", {}), alternatives=["sensor-mass"])
    assert reached("single-place", TRUTH, given)["right effect named or among the alternatives"] == 1.0
    assert reached("clean", TRUTH, given)["right effect named first"] == 0.0


def test_a_pair_needs_both():
    """One of two is not the pair; the order does not count."""
    pair = TRUTH | {"effects": [*TRUTH["effects"], {"id": "gain", "parameters": {"gain": 1.1}}]}
    one = answer("explained", ("gain", {}))
    both = answer("explained", ("gain", {}), ("sensor-mass", {}))
    name = "both effects of the pair named"
    assert [reached("pairs", pair, given)[name] for given in (one, both)] == [0.0, 1.0]


@pytest.mark.parametrize("verdict, counts", [("explained", 1.0), ("ambiguous", 1.0), ("unexplained", 0.0)])
@pytest.mark.parametrize(
    "name, rate",
    [
        ("clean", "right effect named first"),
        ("single-place", "right effect named or among the alternatives"),
        ("pairs", "both effects of the pair named"),
    ],
)
def test_a_right_name_counts_only_where_it_is_said_to_explain(name, rate, verdict, counts):
    """An answer that says of itself that it does not explain the records names nothing, whatever stands in it."""
    pair = [("sensor-mass", mass(0.01, 0.001)), ("gain", {})]
    truth = TRUTH | ({"effects": [*TRUTH["effects"], {"id": "gain", "parameters": {}}]} if name == "pairs" else {})
    given = answer(verdict, *(pair if name == "pairs" else pair[:1]))
    assert reached(name, truth, given)[rate] == counts


def test_small_gains_and_offsets_are_passed_over_in_the_rough_set_only():
    """A record's gain of 0.4 % named before the mass: true of a rough test, a wrong name in a clean one."""
    given = answer(
        "explained", ("record-gain", {"gain": {"value": 1.004, "std": 1e-3}, "record": 2}),
        ("sensor-mass", mass(0.01, 0.001)),
    )
    name = "right effect named first"
    assert reached("rough", TRUTH | {"rough": True}, given)[name] == 1.0
    assert reached("clean", TRUTH, given)[name] == 0.0
    large = answer("explained", ("record-gain", {"gain": 1.08, "record": 2}), ("sensor-mass", {}))
    assert reached("rough", TRUTH | {"rough": True}, large)[name] == 0.0


def test_offsets_of_each_record_are_met_by_a_list():
    """One number a record in the truth, value and std as lists in the answer."""
    truth = TRUTH | {"effects": [{"id": "hammer-offset", "parameters": {"offset": [0.004, -0.003]}}]}
    offset = {"offset": {"value": [0.0041, -0.0023], "std": [2e-4, 2e-4]}}
    rates = reached("clean", truth, answer("explained", ("hammer-offset", offset)))
    assert rates["parameters inside their 95 % interval"] == 0.5


def test_a_set_is_made_and_scored(tmp_path, capsys):
    """From the command line: the same seed makes the same files, no case folder knows its truth, and a tracer that
    says nothing at all scores nothing."""
    made = []
    for name in ("one", "other"):
        options = ["--set", "clean", "--count", "1", "--kind", "gain", "--kind", "sensor-mass", "--samples", "2048"]
        cli.main(["make", str(tmp_path / name), *options, "--seed", "7"])
        made.append({p.relative_to(tmp_path / name): p.read_bytes() for p in (tmp_path / name).rglob("*.toml")})
    assert made[0] == made[1] and len(made[0]) == 2
    case = tmp_path / "one" / "case-000"
    assert sorted(p.name for p in case.iterdir()) == [*(f"point-{i}.uff" for i in range(5)), "test.toml"]
    words = (case / "test.toml").read_text()
    assert not any(word in words for word in ("gain", "sensor-mass", "e_x"))

    mute = tmp_path / "mute.py"
    mute.write_text("import sys; sys.exit('no answer here')")
    with pytest.raises(SystemExit) as stop:
        cli.main(["score", str(tmp_path / "one"), "--command", f"{sys.executable} {mute}"])
    assert stop.value.code == 1
    assert "no answer here" in capsys.readouterr().out


def test_a_tracer_that_reads_the_truth_reaches_every_rate(tmp_path):
    """The scorer's own path from the command to the rates, with a command that cheats."""
    out = tmp_path / "set"
    options = ["--set", "pairs", "--count", "1", "--kind", "edge-mass + high-pass", "--samples", "2048"]
    cli.main(["make", str(out), *options])
    cheat = tmp_path / "cheat.py"
    cheat.write_text(
        "import json, sys, pathlib\n"
        "case = pathlib.Path(sys.argv[1]).parent\n"
        "truth = [c for c in json.loads((case.parent / 'truth.json').read_text())['cases'] if c['case'] == case.name]\n"
        "effects = [{'id': e['id'], 'parameters': {k: {'value': v, 'std': 1e-9} for k, v in e['parameters'].items()}}\n"
        "           for e in truth[0]['effects']]\n"
        "error = {'after': {'held_out': 1.0}, 'noise_floor': 1.0}\n"
        "print(json.dumps({'schema': 'orthopanel.trace/2', 'verdict': 'explained', 'effects': effects,\n"
        "                  'alternatives': [], 'error': error}))\n"
    )
    result = score.score(out, [sys.executable, str(cheat)])
    assert result["reached"] and result["cases"] == 1
    assert "edge-mass + high-pass" in score.text(result)
    json.dumps(result)


def test_another_file_is_no_truth(tmp_path):
    """The message names the schema that was found."""
    (tmp_path / files.TRUTH).write_text('{"schema": "else"}')
    with pytest.raises(ValueError, match="'else'"):
        files.read_truth(tmp_path)


def test_no_answer_is_not_a_cautious_one():
    """Outside the catalogue a tracer that fails names nothing wrong, and still does not reach what is asked."""
    result = judge.summary("outside", [judge.case(TRUTH, score.NO_ANSWER | {"reason": "exit 2"})])
    assert not result["reached"]
    assert result["rates"][0]["met"]


REAL = TRUTH | {"hard": False}
RIGHT = {"right": True, "found": True, "false": False}
BOTH = REAL | {"effects": [*TRUTH["effects"], {"id": "suspension", "parameters": {"stiffness": 150.0}}]}
NONE, OUTSIDE = REAL | {"effects": []}, REAL | {"effects": [{"id": "tension", "parameters": {}}]}


@pytest.mark.parametrize(
    "truth, given, counts",
    [
        (REAL, answer("explained", ("sensor-mass", mass(0.01, 0.001))), RIGHT | {"sure": 1, "inside": 1}),
        (REAL, answer("ambiguous", ("sensor-mass", {})), RIGHT | {"sure": 0}),
        (REAL, answer("ambiguous", ("gain", {}), alternatives=["sensor-mass"]), {"right": 0, "found": 1, "false": 0}),
        (REAL, answer("explained", ("sensor-mass", {}), ("gain", {})), RIGHT | {"sure": 1, "false": 1}),
        (REAL, answer("unexplained", ("sensor-mass", {})), {"right": 0, "found": 0, "false": 0}),
        (REAL | {"hard": True}, answer("nothing-missing"), {"right_hard": 0, "false": 0}),
        (BOTH, answer("explained", ("suspension", {})), RIGHT | {"sure": 1, "both_named": 0}),
        (BOTH, answer("explained", ("suspension", {}), ("sensor-mass", {})), RIGHT | {"sure": 1, "both_named": 1}),
        (NONE, answer("nothing-missing"), {"raised": 0, "false": 0}),
        (NONE, answer("ambiguous", ("gain", {})), {"raised": 1, "false": 0}),
        (NONE, answer("unexplained", ("gain", {})), {"raised": 0, "false": 0}),
        (OUTSIDE, answer("explained", ("gain", {})), {"wrongly": 1, "false": 1}),
        (OUTSIDE, answer("ambiguous", ("gain", {})), {"wrongly": 0, "false": 0}),
    ],
)
def test_what_the_real_set_counts(truth, given, counts):
    """Each rate that says something of the case, and no other."""
    judged = judge.case(truth, given)
    keys = [key for _, key, *_ in judge.ASKED["real"]]
    assert {key: judged[key] for key in keys if judged[key] not in (None, [])} == {
        key: [True] if key == "inside" else bool(value) for key, value in counts.items()
    }


def test_val_a_rate_has_wilsons_interval():
    """8 of 10, 0 of 20: published values (Brown, Cai and DasGupta 2001, and by hand)."""
    assert calibration.wilson([True] * 8 + [False] * 2) == pytest.approx([0.4902, 0.9433], abs=1e-4)
    assert calibration.wilson([False] * 20) == pytest.approx([0.0, 0.1611], abs=1e-4)
    assert calibration.wilson([]) is None


def test_what_is_stated_is_held_against_what_was_right():
    """A lead of 3 nats is 95.3 %; by bic half of that; a pair is right in either order; what was left behind has no evidence."""
    candidates = [{"id": "gain", "log_evidence": 7.0}, {"id": "sensor-mass", "log_evidence": 10.0}, {"id": "base", "log_evidence": -80.0}]
    assert calibration.stated({"candidates": candidates}, ["sensor-mass"]) == pytest.approx((0.9526, True), abs=1e-4)
    assert calibration.stated({"candidates": candidates}, [])[1] is False
    old = [{"id": "base", "bic": 10.0}, {"id": "gain", "bic": 16.0}, {"id": "high-pass", "bic": 1.0, "left_behind": 9.0}]
    assert calibration.stated({"candidates": old}, []) == pytest.approx((0.9526, True), abs=1e-4)
    pair = [{"id": "suspension + record-gain#2", "log_evidence": 1.0}, {"id": "none", "log_evidence": 0.0}]
    assert calibration.stated({"candidates": pair}, ["record-gain", "suspension"])[1] is True
    assert calibration.stated({"candidates": pair[:1]}, []) is None
    rows = calibration.table([(0.6, True), (0.7, False), (0.9526, True), (1.0, True)])
    assert [(row["right"], row["of"]) for row in rows] == [(1, 2), (0, 0), (1, 1), (0, 0), (1, 1)]
    assert rows[0]["stated"] == pytest.approx(0.65) and rows[1]["stated"] is None


def test_the_picture_puts_what_was_right_beside_what_was_stated():
    """Half right at 65 % stated: the mark of the first is below that of the second, and bins without tests have none."""
    svg = ElementTree.fromstring(calibration.picture(calibration.table([(0.6, True), (0.7, False)]), "two tests"))
    space = "{http://www.w3.org/2000/svg}"
    (right,) = svg.findall(f"{space}circle")
    stated = next(line for line in svg.findall(f"{space}line") if line.get("stroke") == "#d60")
    scale = (calibration.HEIGHT - calibration.TOP - calibration.BOTTOM) * 0.15
    assert float(right.get("cy")) - float(stated.get("y1")) == pytest.approx(scale, abs=0.2)
