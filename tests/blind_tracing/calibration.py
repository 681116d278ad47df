"""How sure a tracer says it is, against how often it was right; and how sure a rate of some cases can be."""

import numpy as np

BINS = (0.5, 0.8, 0.95, 0.99, 0.999, 1.0)  # stated probability of the first candidate against the second
NOTHING = {"base", "none"}


def stated(answer, wanted):
    """Probability of the first candidate against the second by their evidence, and whether the first is what is `wanted`; None
    where no two candidates have an evidence. By `bic` where there is no `log_evidence`: half of it is its negative to first order."""
    ranked = []
    for candidate in answer.get("candidates", []):
        evidence = candidate.get("log_evidence")
        if evidence is None and isinstance(candidate.get("bic"), (int, float)) and "left_behind" not in candidate:
            evidence = -0.5 * candidate["bic"]
        if isinstance(evidence, (int, float)) and np.isfinite(evidence):
            ranked.append((float(evidence), candidate["id"]))
    if len(ranked) < 2:
        return None
    (first, name), (second, _), *_ = sorted(ranked, reverse=True)
    named = {one.split("#")[0].strip() for one in name.split("+")} - NOTHING
    return float(1.0 / (1.0 + np.exp(second - first))), named == set(wanted)


def table(pairs):
    """Of pairs (stated probability, right): a row for each of BINS with what was stated in the mean and how often it was right."""
    rows = []
    for low, high in zip(BINS[:-1], BINS[1:]):
        inside = [pair for pair in pairs if low <= pair[0] < high or pair[0] == high == BINS[-1]]
        rights = [right for _, right in inside]
        mean = float(np.mean([probability for probability, _ in inside])) if inside else None
        rows.append({"from": low, "to": high, "stated": mean, "right": sum(rights), "of": len(rights), "interval": wilson(rights)})
    return rows


def wilson(values, deviations=1.96):
    """The 95 % interval of the rate of true among `values` (Wilson, J. Am. Stat. Assoc. 22, 1927); None of no values."""
    count = len(values)
    if count == 0:
        return None
    rate, square = float(np.mean(values)), deviations**2 / count
    middle = (rate + square / 2.0) / (1.0 + square)
    half = np.sqrt(square * rate * (1.0 - rate) + square**2 / 4.0) / (1.0 + square)
    return [max(middle - half, 0.0), min(middle + half, 1.0)]
