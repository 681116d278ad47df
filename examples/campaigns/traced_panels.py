"""Two hundred made panels, each traced: how often is the missing effect named?

    python examples/campaigns/traced_panels.py OUT [--panels 200] [--scheduler tcp://..]

Makes lists of natural frequencies of panels with an effect that their test files do not declare (tests/blind_tracing, whose physics is its own), traces
them all, and holds every answer against the truth. Ended and started again it goes on where it was.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import orthopanel as op

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

from blind_tracing import files, judge, make, score  # noqa: E402

KINDS = 10  # of the set `lists`


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="OUT")
    parser.add_argument("--panels", type=int, default=200, help="in tens: one of each kind of the set `lists`")
    parser.add_argument("--kind", action="append", help="only this kind; repeat it for more")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scheduler", help="address of a Dask scheduler; one process a core of this machine where it is left out")
    given = parser.parse_args(arguments)
    tests = given.folder / "tests"
    if not (tests / "truth.json").exists():
        make.make(tests, "lists", max(given.panels // KINDS, 1), given.seed, only=given.kind)
    client = None
    if given.scheduler:
        from distributed import Client

        client = Client(given.scheduler)
    started = time.monotonic()
    lot = op.campaign.trace(tests, given.folder / "traced", client=client, progress=True).compute()
    print(f"{len(lot)} panels traced in {time.monotonic() - started:.0f} s", file=sys.stderr)
    answers = {row.panel: json.loads(row.answer) if not isinstance(row.failed, str) else {} for row in lot.itertuples()}
    judged = [judge.case(case, score.NO_ANSWER | answers[case["case"]]) for case in files.read_truth(tests)["cases"]]
    result = {"set": "lists", "seed": given.seed} | judge.summary("lists", judged)
    print(score.text(result))
    return result


if __name__ == "__main__":
    main()
