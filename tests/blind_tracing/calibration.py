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


WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 640, 420, 70, 60, 70  # px: of the picture, and around its axes


def picture(rows, title):
    """The rows of `table` as an SVG: how often the first candidate was right, with 95 %, beside what was stated in the mean."""
    wide, tall = (WIDTH - LEFT - 20) / len(rows), HEIGHT - TOP - BOTTOM
    at = lambda rate: TOP + (1.0 - rate) * tall  # noqa: E731
    drawn = []
    for rate in (0.0, 0.25, 0.5, 0.75, 1.0):
        drawn.append(f'<line x1="{LEFT}" x2="{WIDTH - 20}" y1="{at(rate):.1f}" y2="{at(rate):.1f}" stroke="#ddd"/>')
        drawn.append(f'<text x="{LEFT - 8}" y="{at(rate) + 4:.1f}" text-anchor="end">{100 * rate:.0f} %</text>')
    for number, row in enumerate(rows):
        middle = LEFT + (number + 0.5) * wide
        name = f"{100 * row['from']:g} to {100 * row['to']:g} %"
        drawn.append(f'<text x="{middle:.1f}" y="{HEIGHT - BOTTOM + 20}" text-anchor="middle">{name}</text>')
        drawn.append(f'<text x="{middle:.1f}" y="{HEIGHT - BOTTOM + 38}" text-anchor="middle" fill="#555">{row["of"]} tests</text>')
        if not row["of"]:
            continue
        low, high = (at(end) for end in row["interval"])
        stated, right = at(row["stated"]), at(row["right"] / row["of"])
        drawn.append(f'<line x1="{middle - 26:.1f}" x2="{middle + 26:.1f}" y1="{stated:.1f}" y2="{stated:.1f}" stroke="#d60" stroke-width="3"/>')
        drawn.append(f'<line x1="{middle:.1f}" x2="{middle:.1f}" y1="{low:.1f}" y2="{high:.1f}" stroke="#036" stroke-width="2"/>')
        drawn.append(f'<circle cx="{middle:.1f}" cy="{right:.1f}" r="5" fill="#036"/>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="white"/>\n'
        f'<text x="{LEFT}" y="22" font-size="16">{title}</text>\n'
        f'<text x="{LEFT}" y="42"><tspan fill="#d60">stated in the mean</tspan>, and <tspan fill="#036">how often that was right, '
        "with 95 %</tspan></text>\n" + "\n".join(drawn) + f'\n<text x="{LEFT}" y="{HEIGHT - 10}">'
        "stated probability of the first candidate against the second</text>\n</svg>\n"
    )


def wilson(values, deviations=1.96):
    """The 95 % interval of the rate of true among `values` (Wilson, J. Am. Stat. Assoc. 22, 1927); None of no values."""
    count = len(values)
    if count == 0:
        return None
    rate, square = float(np.mean(values)), deviations**2 / count
    middle = (rate + square / 2.0) / (1.0 + square)
    half = np.sqrt(square * rate * (1.0 - rate) + square**2 / 4.0) / (1.0 + square)
    return [max(middle - half, 0.0), min(middle + half, 1.0)]
