"""What a user types, for ``mypy --strict`` and to be run."""

from pathlib import Path

import numpy as np

import orthopanel as op


def main(folder: Path) -> float:
    """Identify, trace, answer, write."""
    test = op.Test(op.Piece(length=0.8, width=0.1, thickness=0.03, mass_per_area=6.88), suspension=[-0.18, 0.18])
    test.add_frequencies([321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5], resolution=1.25)
    fit = op.identify(test)
    why = op.trace(test)
    verdict: str = why.verdict
    f = np.linspace(10.0, 1000.0, 100)
    h = fit.model.accelerance(f, force_at=(-0.3, 0), response_at=(0.3, 0))
    a, b, c, d = fit.model.state_space(modes=20)
    shape = fit.model.mode_shape(3, np.linspace(-0.4, 0.4, 9))
    draws: list[op.Model] = fit.model.sample(10, seed=0)
    fit.model.export(folder / "panel.fmu", fmi=3)
    fit.model.save(folder / "model.json")
    fit.report(folder / "report.html", trace=why)
    assert verdict and np.iscomplexobj(h) and a.shape[0] == b.shape[0] and c.shape[0] == d.shape[0] and len(draws) == 10
    return float(np.abs(shape).max()) + fit.value("e_x")
