"""The test piece."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

from . import _arguments


@dataclass(frozen=True)
class Piece:
    """A rectangular test piece of constant thickness.

    Attributes:
        length: Along x [m].
        width: Along y [m].
        thickness: Along z [m].
        mass_per_area: [kg/m2].
        name: By which measurements of several pieces tell theirs.
        length_std, width_std, thickness_std, mass_per_area_std: Standard deviations, where sizes or mass are in doubt.
        own_constants: Names of the constants that this piece has of its own, where several share the others.
    """

    length: float
    width: float
    thickness: float
    mass_per_area: float
    name: str = "1"
    length_std: float = 0.0
    width_std: float = 0.0
    thickness_std: float = 0.0
    mass_per_area_std: float = 0.0
    own_constants: Sequence[str] = ()

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name not in ("name", "own_constants"):
                object.__setattr__(self, field.name, _arguments.number(getattr(self, field.name), field.name))
        if not isinstance(self.name, str):
            raise TypeError(f"name: must be a str, not {type(self.name).__name__}")
        if isinstance(self.own_constants, str):
            raise TypeError("own_constants: must be a sequence of names")
        object.__setattr__(self, "own_constants", tuple(str(name) for name in self.own_constants))

    def _entry(self) -> dict[str, Any]:
        entry = {field.name: getattr(self, field.name) for field in fields(self)}
        return {**entry, "own_constants": list(self.own_constants)}
