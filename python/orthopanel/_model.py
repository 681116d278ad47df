"""Models of panels."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._errors import InputError
from ._tables import matrix, table

MOST_DRAWS = 1_000_000
"""Draws of a model at once."""

_DERIVATIVES = {
    "acceleration": 0,
    "accelerance": 0,
    "velocity": 1,
    "mobility": 1,
    "displacement": 2,
    "receptance": 2,
}

Places = Iterable[_arguments.Place] | Mapping[str, _arguments.Place]  # a mapping names them


class Model:
    """A model of one panel, as a model file (``orthopanel.model/1``) holds it. Nothing changes it."""

    _held: _native.Model

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Model:
        """The model of a file.

        Raises:
            MissingFileError: where it is not there. InputError: for a file that is no model.
        """
        return cls._of(_native.Model.load(os.fspath(path)))

    @classmethod
    def from_json(cls, text: str, name: str | os.PathLike[str] = "model.json") -> Model:
        """The model of a text; ``name`` stands for its file in messages."""
        return cls._of(_native.Model.from_json(text, os.fspath(name)))

    @classmethod
    def _of(cls, native: _native.Model) -> Model:
        model = cls.__new__(cls)
        model._held = native
        return model

    def to_json(self) -> str:
        """The text of its file."""
        return self._held.to_json()

    def to_dict(self) -> dict[str, Any]:
        """What its file holds: piece, structure, constants, damping, effects, ports, provenance."""
        found: dict[str, Any] = json.loads(self.to_json())
        return found

    @property
    def structure(self) -> str:
        """``"timoshenko-beam"`` or ``"mindlin-plate"``."""
        return str(self.to_dict()["structure"])

    @property
    def constants(self) -> dict[str, float]:
        """Elastic constants by name [Pa, Poisson's ratio 1]; shear moduli go with the shear coefficient k' = 2/3."""
        constants = self.to_dict()["constants"]
        return {name: of["value"] if isinstance(of, dict) else of for name, of in constants.items()}

    @property
    def covariance(self) -> Any:
        """Of all that is known with a standard deviation [products of their units]: constants, then damping ratios, which are called
        ``damping_ratio_1`` and so on, of the flexible modes in their order. What goes with nothing else is independent."""
        of = self.to_dict()
        known = {name: value.get("std") for name, value in of["constants"].items() if isinstance(value, dict)}
        ratios = of.get("damping", {}).get("std", [])
        known |= {f"damping_ratio_{mode}": std for mode, std in enumerate(ratios, start=1)}
        stds = {name: std for name, std in known.items() if std is not None}
        place = {name: index for index, name in enumerate(stds)}
        correlation = np.eye(len(stds))
        told = of.get("correlation", {"names": [], "matrix": []})
        for row, first in enumerate(told["names"]):
            for column, second in enumerate(told["names"]):
                if first in place and second in place:
                    correlation[place[first], place[second]] = told["matrix"][row][column]
        deviations = np.array(list(stds.values()), dtype=np.float64)
        return matrix(list(stds), correlation * np.outer(deviations, deviations))

    def accelerance(
        self,
        frequency: npt.ArrayLike,
        force_at: _arguments.Place,
        response_at: _arguments.Place,
        quantity: str = "acceleration",
        *,
        modes: int | None = None,
    ) -> _arguments.Complexes:
        """Motion per force between two places, for e^(+j omega t).

        Args:
            frequency: [Hz], of any shape.
            force_at, response_at: x or (x, y) from the piece's centre [m].
            quantity: ``"acceleration"`` [(m/s2)/N], ``"mobility"`` [(m/s)/N] or ``"receptance"`` [m/N]; the latter two are not finite at
                0 Hz where the panel is free.
            modes: Flexible modes summed one by one; where nothing is said, as many as the frequencies need. All beyond count by
                their static flexibility.

        Returns:
            Complex, of the shape of ``frequency``.
        """
        order = _DERIVATIVES.get(_arguments.words(quantity, "quantity") or "")
        if order is None:
            raise InputError(f"quantity = {quantity!r}: must be one of {', '.join(_DERIVATIVES)}", key="quantity")
        lines = _arguments.numbers(frequency, "frequency")
        if (lines < 0.0).any():
            raise InputError("frequency: some of it is below zero", key="frequency")
        places = [_arguments.place(force_at, "force_at"), _arguments.place(response_at, "response_at")]
        count = None if modes is None else _arguments.whole(modes, "modes")
        found = self._held.accelerance(lines.ravel(), places, count).reshape(lines.shape)
        if order == 0:
            return found
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(found / (2j * np.pi * lines) ** order)

    def modes(self, count: int = 10) -> Any:
        """Flexible modes from 1: frequency [Hz], nodal lines crossed along x and along y, kind of a plate's, damping ratio."""
        columns = [
            ("mode", "i8"), ("frequency_hz", "f8"), ("nodes_x", "i8"), ("nodes_y", "i8"), ("kind", "U"), ("zeta", "f8"),
        ]  # fmt: skip
        return table(columns, self._held.modes(_arguments.whole(count, "count")), "mode")

    def mode_shape(self, mode: int, x: npt.ArrayLike, y: npt.ArrayLike = 0.0) -> _arguments.Floats:
        """Deflection of a flexible mode, from 1 [kg^(-1/2)]: its modal mass is 1 kg.

        Args:
            mode: Its number.
            x, y: Places [m], of shapes that broadcast.

        Returns:
            Of the shape that both broadcast to.
        """
        along, across = np.broadcast_arrays(_arguments.numbers(x, "x"), _arguments.numbers(y, "y"))
        flat = [np.ascontiguousarray(of, dtype=np.float64).ravel() for of in (along, across)]
        return self._held.mode_shape(_arguments.whole(mode, "mode", 1), *flat).reshape(along.shape)

    def state_space(
        self,
        modes: int = 20,
        *,
        up_to: float | None = None,
        forces: Places | None = None,
        responses: Places | None = None,
    ) -> tuple[_arguments.Floats, _arguments.Floats, _arguments.Floats, _arguments.Floats]:
        """A, B, C, D of dx/dt = A x + B f, acceleration = C x + D f, in SI units.

        The states are the modes' displacements [m kg^(1/2)], the rigid ones first, then their velocities.

        Args:
            modes: Flexible modes beside the rigid ones.
            up_to: In their place every mode up to this frequency [Hz].
            forces, responses: Places [m]; the model's own where they are left out.

        Returns:
            states x states, states x forces, responses x states, responses x forces.
        """
        count = _arguments.whole(modes, "modes")
        named = [_arguments.named_places(forces, "forces"), _arguments.named_places(responses, "responses")]
        a, b, c, d = self._held.state_space(count, _arguments.optional(up_to, "up_to"), *named)
        return a, b, c, d

    def sample(self, count: int, seed: int = 0) -> list[Model]:
        """Models drawn by the standard deviations and the correlation of constants and damping ratios; one seed gives the same draws.

        Raises:
            InputError: for more than a million draws, each of which is a model of its own.
        """
        drawn = self._held.sample(_arguments.whole(count, "count", most=MOST_DRAWS), _arguments.whole(seed, "seed"))
        return [Model._of(native) for native in drawn]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model file.

        Raises:
            FileError: where it cannot be written.
        """
        self._held.save(os.fspath(path))

    def export(
        self,
        path: str | os.PathLike[str],
        fmi: int = 2,
        *,
        modes: int | None = None,
        up_to: float | None = None,
        forces: Places | None = None,
        responses: Places | None = None,
        residual: bool = True,
        name: str | None = None,
    ) -> None:
        """Writes an FMU for co-simulation and model exchange: force in; acceleration, velocity and displacement out.

        Args:
            path: Must end in ``.fmu``.
            fmi: 2 or 3.
            modes: Flexible modes beside the rigid ones; 20 where nothing is said.
            up_to: In their place every mode up to this frequency [Hz].
            forces, responses: Places [m], of a mapping with the names of their variables; the model's own where they are left out.
            residual: Whether residual modes stand for the modes that are left out. On soft mounts that a master couples in steps of a
                millisecond they want shorter ones, and add little.
            name: Of the FMU, as in C.
        """
        self._held.export(
            os.fspath(path),
            _version(fmi),
            None if modes is None else _arguments.whole(modes, "modes"),
            _arguments.optional(up_to, "up_to"),
            _arguments.named_places(forces, "forces"),
            _arguments.named_places(responses, "responses"),
            bool(residual),
            _arguments.words(name, "name"),
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self.to_json() == other.to_json()

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __repr__(self) -> str:
        constants = ", ".join(f"{name}={value:.4g}" for name, value in self.constants.items())
        return f"<orthopanel.Model: {self.structure}, {constants}>"

    def __getstate__(self) -> dict[str, str]:
        return {"json": self.to_json(), "name": os.fspath(self._held.name)}

    def __setstate__(self, state: dict[str, str]) -> None:
        self._held = _native.Model.from_json(state["json"], state["name"])


def _version(fmi: Any) -> int:
    found = _arguments.whole(fmi, "fmi")
    if found not in (2, 3):
        raise InputError(f"fmi = {found}: must be 2 or 3", key="fmi", way_out="must be 2 or 3")
    return found
