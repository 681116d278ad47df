"""Records of pairs of places, measured and calculated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import _arguments
from ._tables import installed


@dataclass(frozen=True)
class Accelerance:
    """A measured accelerance and the model's, for e^(+j omega t).

    Attributes:
        piece: Number of the piece, from 0.
        force_at, response_at: (x, y) [m].
        frequency: lines [Hz].
        measured, model: lines, complex [(m/s2)/N].
    """

    piece: int
    force_at: tuple[float, float]
    response_at: tuple[float, float]
    frequency: _arguments.Floats
    measured: _arguments.Complexes
    model: _arguments.Complexes

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over frequency; needs xarray.

        Raises:
            ImportError: where it is not installed.
        """
        xarray = installed("xarray")
        if xarray is None:
            raise ImportError("xarray is not installed: pip install xarray")
        of = {name: ("frequency", getattr(self, name), {"units": "(m/s2)/N"}) for name in ("measured", "model")}
        frequency = ("frequency", self.frequency, {"units": "Hz"})
        places = {"piece": self.piece, "force_at": self.force_at, "response_at": self.response_at}
        return xarray.Dataset(of, coords={"frequency": frequency}, attrs=places)


def pairs(found: Sequence[tuple[int, Any, Any, Any, Any]]) -> list[Accelerance]:
    """Of what the native module gives."""
    return [
        Accelerance(piece, (force[0], force[1]), (response[0], response[1]), frequency, measured, model)
        for piece, (force, response), frequency, measured, model in found
    ]
