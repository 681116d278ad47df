"""Making a set: case folders with neutral names, in an order that tells nothing, and the truth beside them."""

import sys
import time

import numpy as np

from . import accelerances, files, lists, records, sets


def make(out, name, count, seed, sampling=None, only=None):
    """Write `count` cases of each kind of set `name` into the new folder `out`; `only` names the kinds wanted."""
    if out.exists() and any(out.iterdir()):
        raise ValueError(f"{out} is not empty: name a new folder")
    wanted = [case for case in sets.cases(name, count, seed) if not only or case.kind in only]
    if not wanted:
        kinds = sorted({case.kind for case in sets.cases(name, count, seed)})
        raise ValueError(f'no kind is called "{only[0]}" in the set {name}: {", ".join(kinds)}')
    key = sets.SETS.index(name)
    # The folder's number must not give the kind away.
    order = np.random.default_rng([seed, key]).permutation(len(wanted))
    started, truths = time.monotonic(), []
    for number, which in enumerate(order):
        random = np.random.default_rng([seed, key, int(which)])
        folder = f"case-{number:03d}"
        if wanted[which].places == "list":
            truths.append(lists.make_case(out / folder, wanted[which], random))
        else:
            analysed = wanted[which].analysed
            bench, truth, further = sets.build(wanted[which], random, sampling or (accelerances.SAMPLING if analysed else None))
            played = records.play(bench, random)
            write_case = accelerances.write_case if analysed else files.write_case
            write_case(out / folder, bench, played)
            truths.append(files.truth_of(folder, wanted[which], bench, truth, played) | further)
        print(f"{number + 1} of {len(wanted)}, {time.monotonic() - started:.0f} s", file=sys.stderr)
    files.write_truth(out, name, seed, truths)
