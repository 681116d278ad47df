"""`orthopanel trace` on small versions of the judging sets: a case of every kind, or of a few cheap ones.

Seeds from 1000 on are for development; the sets that judge have seeds below 1000. A case is a seed's, so a kind that goes wrong here goes
wrong each time.
"""

import os
from statistics import fmean

import pytest

from . import make, score

ORTHOPANEL = os.environ.get("ORTHOPANEL")
SEED = 1000
# Of sets whose every kind would take minutes; `None` is all kinds.
KINDS = {
    "clean": None,
    "further": None,
    "none": None,
    "outside": ["spring-to-ground", "mains-hum", "dry-friction"],
    "rough": ["sensor-mass", "record-gain"],
    "single-place": ["edge-mass", "resonator", "high-pass"],
    "pairs": ["edge-mass + high-pass", "resonator + position-error"],
    "accelerances": ["record-gain", "stiffness-loss", "none"],
    "lists": ["local-mass", "support-compliance", "none"],
}
# s a case; the dearest takes about 60 s of one processor.
TIMEOUT = 300.0


@pytest.fixture(scope="module")
def scored(tmp_path_factory):
    """The score of a set, made and traced once."""
    known = {}

    def of(name):
        if name not in known:
            out = tmp_path_factory.mktemp("blind") / name
            make.make(out, name, 1, SEED, only=KINDS[name])
            known[name] = score.score(out, [ORTHOPANEL, "trace"], timeout=TIMEOUT)
        return known[name]

    return of


pytestmark = pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")


def _cases(result):
    return {case["kind"]: case for case in result["judged"]}


def _wrong(result, key):
    """Kind, verdict, names and faults of the cases for which `key` does not hold."""
    told = ("verdict", "ids", "alternatives", "faults")
    return {kind: [case[name] for name in told] for kind, case in _cases(result).items() if case[key] is False}


def _each(result, key):
    """Whether `key` holds, of all parameters, or cases."""
    values = [case[key] for case in result["judged"] if case[key] is not None]
    return [one for value in values for one in (value if isinstance(value, list) else [value])]


def _rate(result, key):
    """The part of all parameters, or cases, for which `key` holds."""
    return fmean(_each(result, key))


def test_val_the_effect_put_in_is_named_first(scored):
    """Every effect of the catalogue, with records that were made with it."""
    result = scored("clean")
    assert len(_cases(result)) == 19
    assert _wrong(result, "right_first") == {}


def test_val_a_sensor_that_resists_turning_is_no_mass_beside_it(scored):
    """Its moment of inertia is freed where it pays."""
    result = scored("further")
    assert len(_cases(result)) == 1
    assert _wrong(result, "right_first") == {}


def test_val_parameters_lie_inside_their_interval(scored):
    """95 % of them should; 90 % are asked, as of the large sets, which some fifty parameters tell to a standard error of 4 %."""
    judged = [case for name in ("clean", "further", "single-place", "pairs", "lists") for case in scored(name)["judged"]]
    faults = [case["faults"] for case in judged if case["faults"]]
    inside = _each({"judged": judged}, "inside")
    assert len(inside) >= 40
    assert fmean(inside) >= 0.9 - (0.9 * 0.1 / len(inside)) ** 0.5, faults


@pytest.mark.parametrize("name", ["clean", "further", "none", "single-place", "pairs"])
def test_val_what_was_held_out_is_foretold_within_noise(scored, name):
    """Within 1.2 of the noise floor in 90 %, as asked of the large sets."""
    result = scored(name)
    ratios = {kind: case["held_out_over_floor"] for kind, case in _cases(result).items()}
    assert _rate(result, "at_floor") >= 0.9, ratios


def test_val_nothing_is_named_where_nothing_is_missing(scored):
    """Free, clamped, and from a single pair of places."""
    result = scored("none")
    assert len(_cases(result)) == 3
    assert _wrong(result, "quiet") == {}


def test_val_an_effect_is_named_from_one_pair_of_places(scored):
    """First, or among the alternatives. A resonator of 4.5 g and a damping ratio of 0.04 is as likely as none: one pole of a single record tells
    little of its four parameters."""
    result = scored("single-place")
    assert len(_cases(result)) == len(KINDS["single-place"])
    assert _wrong(result, "named").keys() <= {"resonator"}


@pytest.mark.parametrize("name", ["lists", "accelerances"])
def test_val_an_effect_is_named_without_the_hits(scored, name):
    """First, or among the alternatives; and nothing where nothing is missing."""
    result = scored(name)
    assert len(_cases(result)) == len(KINDS[name])
    assert _wrong(result, "named") == {}
    assert _wrong(result, "quiet") == {}


def test_val_both_effects_of_a_pair_are_named(scored):
    """One of the structure and one of the channel."""
    result = scored("pairs")
    assert len(_cases(result)) == len(KINDS["pairs"])
    assert _wrong(result, "both") == {}


def test_val_an_effect_is_named_first_in_a_rough_test(scored):
    """Hits 0.7 mm beside their mark, gains 0.3 % off, a core uneven by 0.5 %. A gain of 3.2 % among five is likelier than none by 15, and an
    effect is named at 1000."""
    result = scored("rough")
    assert len(_cases(result)) == len(KINDS["rough"])
    assert _wrong(result, "right_first").keys() <= {"record-gain"}


def test_val_a_sensor_on_a_strip_on_cords_is_explained(tmp_path):
    """Cords of 150 N/m that damp both hanging modes alike, as no dashpot does, and an accelerometer of 4 g that nobody declared."""
    make.make(tmp_path / "hung", "real", 20, 7007, only=["hung strip"])
    (case,) = score.score(tmp_path / "hung", [ORTHOPANEL, "trace"], timeout=TIMEOUT)["judged"]
    assert (case["verdict"], sorted(case["ids"])) == ("explained", ["sensor-mass", "suspension"])
    assert all(case["inside"]), case["faults"]


def test_val_what_the_catalogue_lacks_is_not_explained(scored):
    """Of 100 cases ten may be. A spring to ground is met to the noise by a stiffer suspension and a resonator in its place: whether that
    is said hangs on the processor's rounding (with AVX-512 it is, with AVX2 it was not)."""
    cases = _cases(scored("outside"))
    assert len(cases) == len(KINDS["outside"])
    assert {kind for kind, case in cases.items() if case["explained"]} <= {"spring-to-ground"}


def test_val_every_case_has_an_answer(scored):
    """Also those that take the search to its bound. Hum of 17 % of the response hides every resonance from the joint fit, and is refused."""
    unanswered = {name: _wrong(scored(name), "answered") for name in KINDS}
    assert all(cases.keys() <= {"mains-hum"} for cases in unanswered.values()), unanswered
