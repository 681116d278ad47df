"""`orthopanel trace` on a smaller benchmark than the judging sets: a case of every kind.

Seeds from 1000 on are for development; the judging sets have seeds below 100 and stand in docs/how-often-tracing-is-right.md.
"""

import os

import pytest

from . import make, score

ORTHOPANEL = os.environ.get("ORTHOPANEL")
SEED = 1000


@pytest.fixture(scope="module")
def scored(tmp_path_factory):
    """The score of a set, made and traced once."""
    known = {}

    def of(name):
        if name not in known:
            out = tmp_path_factory.mktemp("blind") / name
            make.make(out, name, 1, SEED)
            known[name] = score.score(out, [ORTHOPANEL, "trace"])
        return known[name]

    return of


pytestmark = pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")


def _cases(result):
    return {case["kind"]: case for case in result["judged"]}


def test_val_the_effect_put_in_is_named_first(scored):
    """One case of each kind: at most one may go wrong (98 % are asked of many).

    It is `width-coupling`, whose search ends at its bound of work.
    """
    cases = _cases(scored("clean"))
    wrong = [kind for kind, case in cases.items() if not case["right_first"]]
    assert len(cases) == 19
    assert len(wrong) <= 1, wrong


def test_val_nothing_is_named_where_nothing_is_missing(scored):
    """Free, clamped, and from a single pair of places."""
    cases = _cases(scored("none"))
    assert len(cases) == 3
    assert all(case["quiet"] for case in cases.values()), cases


def test_val_every_case_has_an_answer(scored):
    """Also those that take the search to its bound."""
    assert all(case["answered"] for name in ("clean", "none") for case in _cases(scored(name)).values())
