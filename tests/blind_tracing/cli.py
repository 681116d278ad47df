"""Make hammer tests whose missing effect a tracer should name, and score its answers and the constants found.

examples, from the folder that holds blind_tracing:
  python -m blind_tracing make out/clean --set clean --count 10 --seed 1
  python -m blind_tracing score out/clean --command "orthopanel trace"
  python -m blind_tracing constants out/whole --command "orthopanel identify"
"""

import argparse
import json
import shlex
import sys
from pathlib import Path

from . import calibration, constants, make, score, sets
from .contour import Sampling


def main(arguments=None):
    """Read the command line; exit 2 with one line where the request makes no sense."""
    parser = _parser()
    given = parser.parse_args(arguments)
    try:
        if given.action == "make":
            sampling = Sampling(given.rate, given.samples)
            make.make(given.out, given.set, given.count, given.seed, sampling, given.kind)
        else:
            how = constants if given.action == "constants" else score
            result = how.score(given.out, shlex.split(given.command), given.parallel, given.timeout)
            print(how.text(result))
            if given.action == "score" and given.picture:
                title = f"{result['cases']} tests of the set {result['set']}, seed {result['seed']}"
                given.picture.write_text(calibration.picture(result["calibration"], title), encoding="utf-8")
            if given.json:
                given.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
            if not result["reached"]:
                sys.exit(1)
    except (ValueError, OSError) as problem:
        parser.exit(2, f"blind_tracing: {problem}\n")


def _parser():
    """The commands and their options."""
    shown = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog="python -m blind_tracing", description=__doc__, formatter_class=shown)
    actions = parser.add_subparsers(dest="action", required=True)
    making = actions.add_parser("make", help="write case folders and truth.json into a new folder")
    making.add_argument("out", type=Path)
    making.add_argument("--set", choices=sets.SETS, required=True)
    making.add_argument("--count", type=int, default=10, help="cases of each kind (default 10)")
    making.add_argument("--seed", type=int, default=1, help="of every random number (default 1)")
    making.add_argument("--kind", action="append", help="only this kind; repeat it for more")
    making.add_argument("--rate", type=float, default=Sampling.rate, help="Hz (default 20480; not of whole panels)")
    making.add_argument("--samples", type=int, default=Sampling.samples, help="of a hit (default 32768)")
    for name, runs, does in (
        ("score", "orthopanel trace", "trace every case and compare with the truth; exit 1 below the rates"),
        ("constants", "orthopanel identify", "identify every case and compare its constants with the truth; exit 1 below the rates"),
    ):
        scoring = actions.add_parser(name, help=does)
        scoring.add_argument("out", type=Path)
        scoring.add_argument("--command", default=runs, help=f'run as COMMAND case/test.toml --json (default "{runs}")')
        scoring.add_argument("--parallel", type=int, default=2, help="cases at a time (default 2)")
        scoring.add_argument("--timeout", type=float, default=120.0, help="s a case (default 120)")
        if name == "score":
            scoring.add_argument("--picture", type=Path, metavar="FILE.svg", help="draw how sure the tracer was, and how often it was right")
        scoring.add_argument("--json", type=Path, metavar="FILE", help="write the result as JSON, too")
    return parser
