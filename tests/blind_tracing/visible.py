"""How plainly an effect shows in a real test: what it moves, over what panel, hits and gains are off by."""

from copy import copy

import numpy as np

from .lists import coupled, poles

COUNT = 8  # flexible modes that are looked at
LOWEST = 2.0 * np.pi * 30.0  # rad/s: below are the motions on the cords
SLOW = 2.0 * np.pi * 60.0  # 1/s: where the panel's motion as a whole is read
STEP = 1e-3  # of a constant: for the derivative by it
BESIDE = 5e-3  # error of a residue beside the panel's: its own, the record's gain, the hit's place


def amplitude(bench, bare, uneven, share):
    """Standard deviations by which `bench` differs from the `bare` one where no constants undo it.

    They are the rms of what the only `uneven` bench is off by where no constants undo that, each mode's own `share` or BESIDE added."""
    plain = _seen(bare)
    difference = lambda other: _difference(_seen(other), plain)  # noqa: E731
    slopes = np.stack([difference(_stiffer(bare, name)) / STEP for name in ("e_x", "g_zx")], axis=1)
    frequencies = np.arange(len(slopes)) < COUNT
    off = _at_best_constants(difference(uneven), slopes, frequencies.astype(float))
    rms = lambda part, least: np.hypot(np.sqrt(np.mean(np.abs(part) ** 2)), least)  # noqa: E731
    deviation = np.where(frequencies, rms(off[frequencies], share), rms(off[~frequencies], BESIDE))
    return float(np.linalg.norm(_at_best_constants(difference(bench), slopes, 1.0 / deviation) / deviation))


def _stiffer(bench, name):
    """The same bench with one constant greater by STEP."""
    other = copy(bench)
    other.change_panel(**{name: getattr(bench.panel, name) * (1.0 + STEP)})
    return other


def _at_best_constants(moved, slopes, weight):
    """What is left of `moved` at the constants that take most of it away by these weights."""
    split = lambda part: np.concatenate([part.real, part.imag])  # noqa: E731
    taken = np.linalg.lstsq(split(slopes * weight[:, None]), split(moved * weight), rcond=None)[0]
    return moved - slopes @ taken


def _difference(one, other):
    """Relative: frequencies by themselves, residues by their rms over modes and records, which grows with frequency."""
    frequency, residue, _ = other
    size = frequency * np.sqrt(np.mean(np.abs(residue / frequency) ** 2))
    return np.concatenate([((a - b) / over).ravel() for a, b, over in zip(one, other, (frequency, size, 1.0))])


def _seen(bench):
    """Frequencies (modes), residues of the accelerance (records, modes) and the panel's motion as a whole
    (records) over that of a point mass."""
    matrices, rows = coupled(bench, bench.struck().mean(axis=1))
    mass, damping, stiffness = matrices
    found, vectors = poles(matrices)
    flexible = np.flatnonzero(found.imag > LOWEST)[:COUNT]
    found, vectors = found[flexible], vectors[:, flexible]
    size = np.sum(vectors * (mass @ vectors * 2.0 * found + damping @ vectors), axis=0)
    shape = rows @ vectors
    whole = SLOW**2 * rows[:-1] @ np.linalg.solve(mass * SLOW**2 + damping * SLOW + stiffness, rows[-1])
    gain = bench.gain * bench.record_gain[:, None]
    chain = np.prod([factor(found) for factor in bench.chain], axis=0) * gain
    return np.abs(found), chain * shape[:-1] * shape[-1] / size * found**2, whole * gain[:, 0] * bench.panel.mass
