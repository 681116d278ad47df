"""Running an identification over a made set, and how far its constants are from the true ones.

An answer is one `orthopanel.identified/1` object. What it gives with a deviation is held against the truth in percent and in that
deviation; a constant that it holds as not identified is counted apart, with whether the interval it leaves open has the truth in it.
"""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from . import calibration, files
from .score import answer_of, percents

SCHEMA = "orthopanel.blind-constants/1"
ANSWERS = ("orthopanel.identified/1",)
WITHIN = 2.5  # deviations
ASKED = (("constants given or held as not identified", "answered", 1.0), ("inside 2.5 deviations, nothing missing", "inside", 0.90))


def score(out, command, parallel=2, timeout=120.0):
    """The score of `command` on the set in `out`: rates, a table of each constant, and every case."""
    truth = files.read_truth(out)
    folders = [out / case["case"] for case in truth["cases"]]
    with ThreadPoolExecutor(parallel) as pool:
        answers = list(pool.map(lambda folder: answer_of(folder, command, timeout, ANSWERS), folders))
    judged = [case(one, answer) for one, answer in zip(truth["cases"], answers)]
    return {"schema": SCHEMA, "set": truth["set"], "seed": truth["seed"]} | summary(judged)


def case(truth, answer):
    """One case: of each constant its error, or that it is held; why there is no answer where there is none."""
    judged = {
        "case": truth["case"],
        "kind": truth["kind"],
        "places": truth.get("places"),
        "missing": bool(truth["effects"]),
        "refused": answer.get("reason"),
        "seconds": answer.get("seconds"),
        "constants": {},
    }
    open_ = {one["name"]: one for one in answer.get("not_identified", [])}
    given = answer.get("constants", {})
    for name, true in truth["constants"].items():
        if name == "shear_coefficient" or "reason" in answer:
            continue
        value, std = (given.get(name, {}).get(key) for key in ("value", "std"))
        if name in open_:
            low, high = open_[name].get("interval") or (-math.inf, math.inf)
            judged["constants"][name] = {"held": True, "open_to_truth": bool(low <= true <= high)}
        elif _finite(value):
            known = _finite(std) and std > 0.0
            judged["constants"][name] = {
                "held": False,
                "percent": 100.0 * (value / true - 1.0),
                "stated_percent": 100.0 * std / true if known else None,
                # A number without a deviation is not inside it.
                "deviations": (value - true) / std if known else None,
            }
        else:
            judged["refused"] = judged["refused"] or f"no {name} in the answer"
    return judged


def summary(judged):
    """Rates asked and reached, of each constant how it does over the cases with nothing missing and over the others, and all cases."""
    rates = []
    for label, key, asked in ASKED:
        values = [value for one in judged for value in _counts(one, key)]
        reached = float(np.mean(values)) if values else None
        met = reached is None or reached >= asked
        rates.append({"name": label, "asked": asked, "reached": reached, "interval": calibration.wilson(values), "of": len(values), "met": met})
    seconds = [one["seconds"] for one in judged if one["seconds"] is not None]
    groups = {"nothing missing": [one for one in judged if not one["missing"]], "an effect missing": [one for one in judged if one["missing"]]}
    return {
        "cases": len(judged),
        "rates": rates,
        "reached": all(rate["met"] for rate in rates),
        "constants": {label: _table(cases) for label, cases in groups.items() if cases},
        "refused": sum(one["refused"] is not None for one in judged),
        "seconds": {"median": float(np.median(seconds)), "most": max(seconds)} if seconds else None,
        "judged": judged,
    }


def _counts(one, key):
    """The truth values that a case adds to a rate."""
    if key == "answered":
        return [one["refused"] is None]
    told = [] if one["missing"] else [constant for constant in one["constants"].values() if not constant["held"]]
    return [_inside(constant) for constant in told]


def _inside(constant):
    """True within WITHIN of its own deviation."""
    return constant["deviations"] is not None and abs(constant["deviations"]) <= WITHIN


def _table(cases):
    """Of each constant: how often told and held, its errors where told."""
    table = {}
    for name in dict.fromkeys(name for one in cases for name in one["constants"]):
        all_ = [one["constants"][name] for one in cases if name in one["constants"]]
        told, held = ([one for one in all_ if one["held"] == held] for held in (False, True))
        errors = np.abs([one["percent"] for one in told])
        stated = [one["stated_percent"] for one in told if one["stated_percent"] is not None]
        deviations = [one["deviations"] for one in told if one["deviations"] is not None]
        table[name] = {
            "told": len(told),
            "held": len(held),
            "held_open_to_truth": sum(one["open_to_truth"] for one in held),
            "median_percent": float(np.median(errors)) if told else None,
            "worst_percent": float(np.max(errors)) if told else None,
            "median_stated_percent": float(np.median(stated)) if stated else None,
            "rms_deviations": float(np.sqrt(np.mean(np.square(deviations)))) if deviations else None,
            "inside": sum(_inside(one) for one in told),
        }
    return table


def text(result):
    """The score as a page."""
    lines = [f"set {result['set']}, seed {result['seed']}: {result['cases']} cases, {result['refused']} refused", ""]
    lines.append(f"{'rate':45} {'asked':>8} {'reached':>8} {'95 %':>12}  of")
    for rate in result["rates"]:
        reached = "-" if rate["reached"] is None else f"{100.0 * rate['reached']:.1f} %"
        asked, mark = f">={100.0 * rate['asked']:.0f} %", "" if rate["met"] else "  below"
        lines.append(f"{rate['name']:45} {asked:>8} {reached:>8} {percents(rate['interval']):>12}  {rate['of']}{mark}")
    if result["seconds"]:
        lines.append(f"seconds a test: median {result['seconds']['median']:.1f}, most {result['seconds']['most']:.1f}")
    for label, table in result["constants"].items():
        lines += ["", f"{label + ':':20} {'told':>5} {'inside':>7} {'held':>5} {'open':>5} {'median':>9} {'worst':>9} {'stated':>9} {'rms dev.':>9}"]
        for name, row in table.items():
            numbers = [row[key] for key in ("median_percent", "worst_percent", "median_stated_percent")]
            shown = " ".join(f"{'-' if one is None else f'{one:.3g} %':>9}" for one in numbers)
            rms = "-" if row["rms_deviations"] is None else f"{row['rms_deviations']:.2f}"
            lines.append(f"  {name:18} {row['told']:>5} {row['inside']:>7} {row['held']:>5} {row['held_open_to_truth']:>5} {shown} {rms:>9}")
    lines += ["", "error in percent (and in deviations) of each case:"]
    for one in result["judged"]:
        seconds = "" if one["seconds"] is None else f", {one['seconds']:.1f} s"
        places = "" if one["places"] is None else f", {one['places']} places"
        told = one["refused"] or ", ".join(_shown(*pair) for pair in one["constants"].items())
        lines.append(f"  {one['case']} ({one['kind']}{places}{seconds}): {told}")
    return "\n".join(lines)


def _shown(name, one):
    """A constant of one case."""
    if one["held"]:
        return f"{name} held" + ("" if one["open_to_truth"] else " (the truth is outside what is left open)")
    deviations = "?" if one["deviations"] is None else f"{one['deviations']:+.1f}"
    return f"{name} {one['percent']:+.2g} ({deviations})"


def _finite(value):
    """True of a number."""
    return isinstance(value, (int, float)) and math.isfinite(value)
