"""Running a tracer over a made set, and how often it was right.

A case's answer is one `orthopanel.trace/1` or `/2` object on standard output. A command that fails, runs over its time or
prints something else counts as a wrong answer, with its reason kept.
"""

import json
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from . import files, judge

SCHEMA = "orthopanel.blind-score/1"
ANSWERS = ("orthopanel.trace/1", "orthopanel.trace/2")
NO_ANSWER = {"verdict": "no answer", "effects": [], "alternatives": []}


def score(out, command, parallel=2, timeout=120.0):
    """The score of `command` on the set in `out`: a dictionary, see `judge.summary`."""
    truth = files.read_truth(out)
    folders = [out / case["case"] for case in truth["cases"]]
    with ThreadPoolExecutor(parallel) as pool:
        answers = list(pool.map(lambda folder: trace(folder, command, timeout), folders))
    judged = [judge.case(case, answer) for case, answer in zip(truth["cases"], answers)]
    return {"schema": SCHEMA, "set": truth["set"], "seed": truth["seed"]} | judge.summary(truth["set"], judged)


def trace(folder, command, timeout):
    """The tracer's answer to one case; NO_ANSWER with a `reason` where there is none."""
    return NO_ANSWER | answer_of(folder, command, timeout, ANSWERS)


def answer_of(folder, command, timeout, schemas):
    """What a command prints of one case, with the `seconds` it took; a `reason` where that is none of the `schemas`."""
    started = time.monotonic()
    call = [*command, str(folder / "test.toml"), *([] if "--json" in command else ["--json"])]
    try:
        done = subprocess.run(call, capture_output=True, text=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return {"reason": f"no answer within {timeout:g} s", "seconds": timeout}
    try:
        answer = json.loads(done.stdout)
    except json.JSONDecodeError:
        said = done.stderr.strip().splitlines()
        return {"reason": f"exit {done.returncode}: {said[-1] if said else 'nothing printed'}"}
    if isinstance(answer, dict) and "error" in answer and "schema" not in answer:
        return {"reason": f"exit {done.returncode}: {answer['error']}", "seconds": time.monotonic() - started}
    if not isinstance(answer, dict) or answer.get("schema") not in schemas:
        return {"reason": f"printed JSON that is none of {', '.join(schemas)}"}
    return answer | {"seconds": time.monotonic() - started}


def text(result):
    """The score as a page: rates asked and reached, the confusion matrix, and the cases that went wrong."""
    lines = [f"set {result['set']}, seed {result['seed']}: {result['cases']} cases", ""]
    lines.append(f"{'rate':58} {'asked':>8} {'reached':>8} {'95 %':>12}  of")
    for rate in result["rates"]:
        reached = "-" if rate["reached"] is None else f"{100.0 * rate['reached']:.1f} %"
        mark = "" if rate["met"] else "  below" if rate["at"] == "least" else "  above"
        asked = "-" if rate["asked"] is None else f"{'>=' if rate['at'] == 'least' else '<='}{100.0 * rate['asked']:.0f} %"
        lines.append(f"{rate['name']:58} {asked:>8} {reached:>8} {percents(rate['interval']):>12}  {rate['of']}{mark}")
    ratio = result["held_out_over_floor"]
    if ratio["of"]:
        lines.append(f"held-out error after over noise floor: median {ratio['median']:.2f}, worst {ratio['worst']:.2f}")
    if result["place_mm"]:
        lines.append("place error, mm: " + ", ".join(f"{name} {_spread(errors)}" for name, errors in result["place_mm"].items()))
    if result["seconds"]:
        lines.append(f"seconds a test: median {result['seconds']['median']:.1f}, most {result['seconds']['most']:.1f}")
    if any(row["of"] for row in result["calibration"]):
        lines += ["", "first candidate against the second, by their evidence:", f"{'stated':>15} {'mean':>8} {'right':>8} {'95 %':>12}  of"]
        for row in (row for row in result["calibration"] if row["of"]):
            right, stated = 100.0 * row["right"] / row["of"], f"{row['from']:g} to {row['to']:g}"
            lines.append(f"{stated:>15} {row['stated']:>8.4f} {right:>6.1f} % {percents(row['interval']):>12}  {row['of']}")
    lines += ["", "truth (rows) and the effect named first, or the verdict:"]
    width = max(len(kind) for kind in result["confusion"])
    for kind, named in result["confusion"].items():
        counts = sorted(named.items(), key=lambda pair: -pair[1])
        lines.append(f"  {kind:{width}}  " + ", ".join(f"{count} {name}" for name, count in counts))
    wrong = [case for case in result["judged"] if case["faults"]]
    if wrong:
        lines += ["", "cases with a fault:"]
        lines += [f"  {case['case']} ({case['kind']}): " + "; ".join(case["faults"]) for case in wrong]
    return "\n".join(lines)


def _spread(errors):
    """Median, worst and number."""
    return f"median {np.median(errors):.1f}, worst {max(errors):.1f} of {len(errors)}"


def percents(interval):
    """An interval of a rate."""
    return "-" if interval is None else f"{100.0 * interval[0]:.0f} to {100.0 * interval[1]:.0f} %"
