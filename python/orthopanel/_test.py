"""Tests, built or loaded, and what is done with them."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _native, _progress
from ._errors import InputError
from ._fit import Fit
from ._piece import Piece
from ._trace import Trace


class Test:
    """A hammer test: pieces, how they were held, and what was measured.

    Args:
        piece: The test piece, or several of one material.
        suspension: Places [m] at which the pieces hang or rest: x, or (x, y), each.
        boundary: How edges are held: ``{"left": "clamped"}``, each ``"free"`` (where it is left out), ``"pinned"`` or ``"clamped"``; ends
            are ``left`` and ``right``, a plate has ``front`` and ``back`` too.
        structure: ``"timoshenko-beam"`` (where nothing is said) or ``"mindlin-plate"``.
        constants: What is known of constants by name [Pa, Poisson's ratio 1]: a number holds one, ``{"value": .., "std": ..}`` is a prior,
            ``{"start": ..}`` where the search begins. Shear moduli go with the shear coefficient k' = 2/3.
        effects: Effects known beforehand, each ``{"id": "sensor-mass", "mass": 0.005}``; a parameter left out is identified.

    Raises:
        InputError: for what a test file is refused for, with the key.
    """

    __test__ = False  # for pytest

    def __init__(
        self,
        piece: Piece | Sequence[Piece],
        suspension: Iterable[_arguments.Place] = (),
        *,
        boundary: Mapping[str, str] | None = None,
        structure: str | None = None,
        constants: Mapping[str, float | Mapping[str, float]] | None = None,
        effects: Iterable[Mapping[str, Any]] = (),
    ) -> None:
        pieces = list(piece) if isinstance(piece, Iterable) else [piece]
        for of in pieces:
            if not isinstance(of, Piece):
                raise TypeError(f"piece: must be a Piece, not {type(of).__name__}")
        header = {
            "pieces": [of._entry() for of in pieces],
            "suspension": _arguments.places(suspension, "suspension"),
            "boundary": {
                edge: _arguments.words(held, f"boundary.{edge}")
                for edge, held in _arguments.mapping(boundary, "boundary").items()
            },
            "structure": _arguments.words(structure, "structure"),
            "constants": {
                name: _known(of, f"constants.{name}")
                for name, of in _arguments.mapping(constants, "constants").items()
            },
            "effects": [_effect(of, f"effects[{index}]") for index, of in enumerate(effects)],
        }
        self._made: tuple[Any, ...] = ("built", json.dumps(header))
        self._calls: list[tuple[str, tuple[Any, ...]]] = []
        self._held = _native.Test(self._made[1])

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Test:
        """The test of a file ``test.toml``, or of a folder that holds one.

        Raises:
            MissingFileError: where it is not there. InputError: with line and key of what is wrong in it.
        """
        native = _native.Test.load(os.fspath(path))
        file = Path(path) / "test.toml" if Path(path).is_dir() else Path(path)
        return cls._of(("read", file.read_text(encoding="utf-8"), os.path.abspath(file)), [], native)

    @classmethod
    def from_toml(cls, text: str, path: str | os.PathLike[str] = "test.toml") -> Test:
        """The test of a text; ``path`` names it in messages, and files that it names are looked for beside it."""
        return cls._of(("read", text, os.path.abspath(path)), [], _native.Test.from_toml(text, os.fspath(path)))

    @classmethod
    def _of(cls, made: tuple[Any, ...], calls: list[tuple[str, tuple[Any, ...]]], native: _native.Test) -> Test:
        test = cls.__new__(cls)
        test._made, test._calls, test._held = made, calls, native
        return test

    @property
    def pieces(self) -> list[str]:
        """Names of the pieces."""
        return self._held.pieces

    def __len__(self) -> int:
        """Number of measurements."""
        return self._held.count

    def __repr__(self) -> str:
        return f"<orthopanel.Test of {', '.join(self.pieces)}: {len(self)} measurements>"

    def add_hits(
        self,
        force: npt.ArrayLike,
        acceleration: npt.ArrayLike,
        sampling_rate: float,
        force_at: _arguments.Place,
        response_at: _arguments.Place,
        *,
        piece: str | None = None,
        force_unit: str | None = None,
        response_unit: str | None = None,
        quantity: str | None = None,
        force_sensitivity: float | None = None,
        response_sensitivity: float | None = None,
        direction: int | None = None,
        band: tuple[float, float] | None = None,
        trigger: Mapping[str, float] | None = None,
    ) -> None:
        """Adds hits of a hammer at one place and what a sensor saw of them at another.

        Args:
            force: hits x samples [N].
            acceleration: hits x samples [m/s2]; another motion where ``quantity`` says so.
            sampling_rate: [Hz].
            force_at, response_at: x or (x, y) from the piece's centre [m].
            piece: The piece's name, where there are several.
            force_unit, response_unit: Other units, such as ``"lbf"``, ``"g"``, ``"mm/s"``.
            quantity: What the sensor reads: ``"acceleration"``, ``"velocity"`` or ``"displacement"``.
            force_sensitivity, response_sensitivity: Volts a unit, where the arrays are in volts.
            direction: -1 where the sensor looks against the force.
            band: From and to [Hz]: what of the records counts.
            trigger: ``level`` [N], ``before`` and ``length`` [s]: how a continuous record of several blows is cut into hits.

        Raises:
            TypeError: for arrays that hold no real numbers. InputError: for shapes, rates, places and units that do not fit, and for
                samples that are no finite number.
        """
        read_as = {
            "force_unit": _arguments.words(force_unit, "force_unit"),
            "response_unit": _arguments.words(response_unit, "response_unit"),
            "quantity": _arguments.words(quantity, "quantity"),
            "force_sensitivity": _arguments.optional(force_sensitivity, "force_sensitivity"),
            "response_sensitivity": _arguments.optional(response_sensitivity, "response_sensitivity"),
            "direction": _direction(direction),
            "band": _band(band),
            "trigger": None if trigger is None else _trigger(trigger),
        }
        self._add(
            "with_hits",
            self._piece(piece),
            _arguments.hits(force, "force"),
            _arguments.hits(acceleration, "acceleration"),
            _arguments.number(sampling_rate, "sampling_rate"),
            [_arguments.place(force_at, "force_at"), _arguments.place(response_at, "response_at")],
            json.dumps(read_as),
        )

    def add_frequencies(
        self,
        values: npt.ArrayLike,
        *,
        piece: str | None = None,
        resolution: float | npt.ArrayLike | None = None,
        scatter: float | npt.ArrayLike | None = None,
        shape: Iterable[tuple[int, int]] = (),
        response_at: _arguments.Place | None = None,
    ) -> None:
        """Adds natural frequencies of flexible modes.

        Args:
            values: [Hz], rising: the beam's modes 1, 2, ... where ``shape`` is left out.
            piece: The piece's name, where there are several.
            resolution: Bin width of the analyser [Hz], one for all or one a mode.
            scatter: Standard deviation by which each is known to miss a model that lacks nothing [Hz].
            shape: Nodal lines crossed along x and along y, one pair a mode: of a plate.
            response_at: Place of the sensor [m], where known.
        """
        found = _arguments.numbers(values, "values")
        if found.ndim != 1:
            raise InputError(f"values: has {found.ndim} dimensions: must be a row of frequencies", key="values")
        count = found.shape[0]
        pairs = [
            [_arguments.whole(part, f"shape[{index}]") for part in pair] for index, pair in enumerate(shape)
        ]
        if any(len(pair) != 2 for pair in pairs):
            raise InputError("shape: must be pairs of nodal lines along x and along y", key="shape")
        of = {
            "values": found.tolist(),
            "resolution": _each(resolution, "resolution", count),
            "scatter": _each(scatter, "scatter", count),
            "shape": pairs,
            "response_at": None if response_at is None else _arguments.place(response_at, "response_at"),
        }
        self._add("with_frequencies", self._piece(piece), json.dumps(of))

    def add_accelerance(
        self,
        frequency: npt.ArrayLike,
        value: npt.ArrayLike,
        force_at: _arguments.Place,
        response_at: _arguments.Place,
        *,
        coherence: npt.ArrayLike | None = None,
        piece: str | None = None,
        force_unit: str | None = None,
        response_unit: str | None = None,
        quantity: str | None = None,
        direction: int | None = None,
        band: tuple[float, float] | None = None,
        window_decay: float | None = None,
    ) -> None:
        """Adds a frequency response between two places.

        Args:
            frequency: lines [Hz], rising.
            value: lines, complex [(m/s2)/N], for e^(+j omega t); of another motion where ``quantity`` says so.
            force_at, response_at: x or (x, y) from the piece's centre [m].
            coherence: lines, where it is known.
            window_decay: Time constant [s] of an exponential window that was over the records.

        Other arguments as of `add_hits`.
        """
        read_as = {
            "force_unit": _arguments.words(force_unit, "force_unit"),
            "response_unit": _arguments.words(response_unit, "response_unit"),
            "quantity": _arguments.words(quantity, "quantity"),
            "direction": _direction(direction),
            "band": _band(band),
            "window_decay": _arguments.optional(window_decay, "window_decay"),
        }
        self._add(
            "with_accelerance",
            self._piece(piece),
            _arguments.line(frequency, "frequency"),
            _arguments.line(value, "value", "fiuc", np.complex128),
            None if coherence is None else _arguments.line(coherence, "coherence"),
            [_arguments.place(force_at, "force_at"), _arguments.place(response_at, "response_at")],
            json.dumps(read_as),
        )

    def identify(self, **options: Any) -> Fit:
        """As `orthopanel.identify`."""
        return identify(self, **options)

    def trace(self, **options: Any) -> Trace:
        """As `orthopanel.trace`."""
        return trace(self, **options)

    def _piece(self, name: str | None) -> int:
        names = self.pieces
        if name is None and len(names) == 1:
            return 0
        if name not in names:
            raise InputError(f"piece = {name!r}: must be one of {', '.join(map(repr, names))}", key="piece")
        return names.index(name)

    def _add(self, method: str, *arguments: Any) -> None:
        self._held = getattr(self._held, method)(*arguments)
        # Arrays of the caller may change: those of ours are copies where they were converted, and are made so where not.
        kept = tuple(np.array(of) if isinstance(of, np.ndarray) else of for of in arguments)
        self._calls.append((method, kept))

    def __getstate__(self) -> dict[str, Any]:
        return {"made": self._made, "calls": self._calls}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._made, self._calls = state["made"], list(state["calls"])
        kind, *of = self._made
        self._held = _native.Test(*of) if kind == "built" else _native.Test.from_toml(*of)
        for method, arguments in self._calls:
            self._held = getattr(self._held, method)(*arguments)


def identify(
    test: Test,
    *,
    damping: str = "viscous",
    search: str = "least-squares",
    window: str | None = None,
    tau: float | None = None,
    force_half_width: float | None = None,
    estimator: str = "h1",
    progress: bool | _progress.Tell | None = None,
) -> Fit:
    """Elastic constants from a test, and the damping ratios of its modes where there are records.

    Other threads run meanwhile, and Ctrl-C ends it.

    Args:
        damping: How modes lose energy: ``"viscous"`` or ``"hysteretic"``.
        search: ``"least-squares"``, or ``"simplex"`` as in the paper.
        window: Over each hit: ``"as-needed"`` (where nothing is said), ``"none"``, ``"force"``, ``"hann"`` or
            ``"force-exponential"``, which needs ``tau``, its time constant [s].
        force_half_width: Of the force window [s].
        estimator: Average over the hits: ``"h1"``, ``"h2"`` or ``"hv"``.
        progress: Whether to show how far it is, on standard error; where nothing is said, in terminals and notebooks. Or what is to be
            called with it: ``progress(work, done, of, step)``.

    Raises:
        RefusedError: where the data contradict the model. InputError: for a test that is not as it should be.
    """
    words = _words(damping, search, window, tau, force_half_width, estimator)
    tell = _progress.teller(progress)
    try:
        native = _checked(test)._held.identify(words, tell)
    finally:
        _progress.end(tell)
    return Fit._of(test, words, native)


def trace(
    test: Test, *, reference: Test | None = None, progress: bool | _progress.Tell | None = None
) -> Trace:
    """The physical effect that the model of a test lacks.

    Other threads run meanwhile, and Ctrl-C ends it at its next step.

    Args:
        reference: A test of a sound panel of the same make: what is found is what differs between the two.
        progress: As of `identify`.

    Raises:
        InputError: for a test that cannot be traced.
    """
    tell = _progress.teller(progress)
    try:
        native = _checked(test)._held.trace(None if reference is None else _checked(reference)._held, tell)
    finally:
        _progress.end(tell)
    return Trace._of(test, native)


def _checked(test: Test) -> Test:
    if not isinstance(test, Test):
        raise TypeError(f"test: must be a Test, not {type(test).__name__}: Test.load reads a file")
    return test


def _words(
    damping: str, search: str, window: str | None, tau: float | None, half_width: float | None, estimator: str
) -> str:
    words = {
        "damping": _arguments.words(damping, "damping"),
        "search": _arguments.words(search, "search"),
        "window": _arguments.words(window, "window"),
        "tau": _arguments.optional(tau, "tau"),
        "force_half_width": _arguments.optional(half_width, "force_half_width"),
        "estimator": _arguments.words(estimator, "estimator"),
    }
    return json.dumps(words)


def _known(of: Any, key: str) -> Any:
    if isinstance(of, Mapping):
        if set(of) not in ({"value", "std"}, {"start"}):
            raise InputError(f"{key}: give a number, {{'value': .., 'std': ..}} or {{'start': ..}}", key=key)
        return {name: _arguments.number(value, f"{key}.{name}") for name, value in of.items()}
    return _arguments.number(of, key)


def _effect(of: Any, key: str) -> dict[str, Any]:
    if not isinstance(of, Mapping) or not isinstance(of.get("id"), str):
        raise InputError(f"{key}: must be a mapping with an id, as {{'id': 'sensor-mass', 'mass': 0.005}}", key=key)
    return {name: value if name == "id" else _arguments.number(value, f"{key}.{name}") for name, value in of.items()}


def _direction(value: Any) -> int | None:
    if value is None:
        return None
    if value not in (1, -1):
        raise InputError(f"direction = {value!r}: must be 1 or -1", key="direction")
    return int(value)


def _band(value: Any) -> list[float] | None:
    if value is None:
        return None
    found = _arguments.numbers(value, "band").ravel().tolist()
    if len(found) != 2:
        raise InputError(f"band: {len(found)} numbers: must be from and to in Hz", key="band")
    return found  # type: ignore[no-any-return]


def _trigger(value: Mapping[str, float]) -> dict[str, float]:
    if not isinstance(value, Mapping) or not set(value) <= {"level", "before", "length"}:
        raise InputError("trigger: must hold level [N], before [s] and length [s], or some of them", key="trigger")
    return {name: _arguments.number(of, f"trigger.{name}") for name, of in value.items()}


def _each(value: Any, key: str, count: int) -> list[float]:
    if value is None:
        return []
    found = _arguments.numbers(value, key)
    if found.ndim == 0:
        return [float(found)] * count
    return found.ravel().tolist()  # type: ignore[no-any-return]
