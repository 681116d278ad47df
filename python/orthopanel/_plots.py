"""Pictures by matplotlib, which a notebook shows."""

from __future__ import annotations

import functools
import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._pairs import Accelerance
from ._tables import installed

MEASURED = "#d55e00"
CALCULATED = ["#005aaa", "#008c64"]


def _figure(rows: int, height: float) -> tuple[Any, Any]:
    if installed("matplotlib") is None:
        raise ImportError("matplotlib is not installed: pip install matplotlib")
    from matplotlib.figure import Figure

    # Without pyplot: no window and no state. A notebook shows a figure by pyplot's hook alone, or by what it says of itself.
    figure = Figure(figsize=(8.0, height * rows + 0.6), layout="constrained")
    vars(figure)["_repr_png_"] = functools.partial(_png, figure)
    axes = figure.subplots(rows, 1, squeeze=False)[:, 0]
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        FigureCanvasAgg(figure)
    except ImportError:  # pragma: no cover
        pass
    return figure, axes


def _png(figure: Any) -> bytes:
    """What a notebook shows of a figure."""
    page = io.BytesIO()
    figure.savefig(page, format="png")
    return page.getvalue()


def accelerances(calculated: Sequence[tuple[str, Sequence[Accelerance]]], most: int = 6) -> Any:
    """Magnitudes of records, measured and by one or two models."""
    first = calculated[0][1]
    shown = range(min(len(first), most))
    figure, axes = _figure(len(shown), 2.4)
    for place, axis in zip(shown, axes, strict=True):
        axis.semilogy(first[place].frequency, np.abs(first[place].measured), color=MEASURED, lw=1.0, label="measured")
        for (name, of), colour in zip(calculated, CALCULATED, strict=False):
            axis.semilogy(of[place].frequency, np.abs(of[place].model), color=colour, lw=1.0, label=name)
        force, response = first[place].force_at, first[place].response_at
        axis.set(title=f"force at {force} m, response at {response} m", ylabel="(m/s2)/N")
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("frequency [Hz]")
    axes[0].legend()
    return figure


def frequencies(modes: Sequence[dict[str, Any]]) -> Any:
    """Error of each natural frequency."""
    figure, (axis,) = _figure(1, 3.4)
    for piece in dict.fromkeys(mode["piece"] for mode in modes):
        of = [mode for mode in modes if mode["piece"] == piece]
        axis.plot([mode["measured_hz"] for mode in of], [mode["error_percent"] for mode in of], "o", label=f"piece {piece}")
    axis.axhline(0.0, color="black", lw=0.8)
    axis.set(xlabel="measured natural frequency [Hz]", ylabel="model less measured [%]", title="natural frequencies")
    axis.grid(alpha=0.3)
    axis.legend()
    return figure


def evidence(candidates: Sequence[dict[str, Any]], most: int = 12) -> Any:
    """Evidence of each hypothesis, beside the likeliest."""
    of = list(candidates)[:most]
    figure, (axis,) = _figure(1, 0.6 + 0.3 * len(of))
    best = max((candidate["log_evidence"] for candidate in of), default=0.0)
    axis.barh([candidate["id"] for candidate in of], [candidate["log_evidence"] - best for candidate in of], color=CALCULATED[0])
    axis.invert_yaxis()
    axis.set(xlabel="log evidence beside the likeliest", title="hypotheses")
    axis.grid(alpha=0.3)
    return figure
