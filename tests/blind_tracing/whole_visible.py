"""How plainly an effect shows in the frequencies of a real whole panel, beside what the panel is off by and what constants undo."""

from dataclasses import replace

import numpy as np

from .whole_plate import CONSTANTS, RIGID, Mesh, lowest

STEP = 1e-3  # of a constant: for the derivative by it
COARSE = {"degree": 5, "element": 0.2}  # shifts of the first order, to a few percent


class Seen:
    """The modes of an even panel up to the band's end, and what they tell of changes to it, to first order: a great loss shows by more."""

    def __init__(self, even, uneven, share, count):
        self.even, self.uneven, self.share, self.count = even, uneven, share, count

    def amplitude(self, changed, masses=()):
        """Standard deviations by which the frequencies of the `changed` panel, with `masses` (Foot, kg) on it, differ from those of the
        `uneven` one, of what no constants undo. They are the rms of what the uneven panel is off by itself and each mode's `share`."""
        lines = {"lines_x": changed.lines_x, "lines_y": changed.lines_y}
        mesh = Mesh(replace(self.even, **lines), **COARSE)
        square, vectors = (part[..., RIGID:] for part in lowest(mesh, self.count)[:2])

        def moved(panel):
            stiffer = Mesh(replace(panel, **lines), **COARSE).stiffness - mesh.stiffness
            return np.sum(vectors * (stiffer @ vectors), axis=0) / (2.0 * square)

        slopes = [moved(replace(self.even, **{name: getattr(self.even, name) * (1.0 + STEP)})) / STEP for name in CONSTANTS]
        undone, _ = np.linalg.qr(np.stack(slopes, axis=1))
        left = lambda shift: shift - undone @ (undone.T @ shift)  # noqa: E731
        own = moved(self.uneven)
        shift = moved(changed) - own - sum((0.5 * kilograms * (mesh.deflection(foot) @ vectors) ** 2 for foot, kilograms in masses), 0.0)
        deviation = np.hypot(np.sqrt(np.mean(left(own) ** 2)), self.share)
        return float(np.linalg.norm(left(shift)) / deviation)
