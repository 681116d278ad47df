"""What was identified."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, _plots, _progress
from ._answer import Answer
from ._errors import FileError, InputError
from ._model import Model
from ._pairs import Accelerance, pairs
from ._tables import matrix, table

if TYPE_CHECKING:
    from ._test import Test
    from ._trace import Trace

__all__ = ["Accelerance", "Fit"]


class Fit(Answer):
    """Elastic constants, damping and modes that were identified from a test; made by `identify`. JSON is ``orthopanel.identified/1``.

    Tables are of pandas where it is installed, structured arrays of numpy else; what is not known is NaN.
    """

    _words: str
    _held: _native.Fit | None
    _models: list[tuple[str, Model]]
    _pairs: list[Accelerance]

    @classmethod
    def _of(cls, test: Test, words: str, native: _native.Fit) -> Fit:
        fit = cls.__new__(cls)
        fit._keep(test, native)
        fit._words = words
        fit._models = [(name, Model._of(model)) for name, model in native.models()]
        fit._pairs = pairs(native.accelerances())
        return fit

    @property
    def constants(self) -> Any:
        """A row a constant: value, std, unit, held [Pa, Poisson's ratio 1]. Shear moduli go with the shear coefficient k' = 2/3."""
        columns = [("constant", "U"), ("value", "f8"), ("std", "f8"), ("unit", "U"), ("held", "?")]
        return table(columns, [(name, *of) for name, of in self._estimates()], "constant")

    def value(self, constant: str) -> float:
        """The value of a constant by its name, such as ``"e_x"`` [Pa, Poisson's ratio 1]."""
        for name, (value, *_) in self._estimates():
            if name == constant:
                return value
        names = ", ".join(name for name, _ in self._estimates())
        raise InputError(f"constant = {constant!r}: must be one of {names}", key="constant")

    @property
    def covariance(self) -> Any:
        """constants x constants [products of their units], of those that were identified, in the order of `constants`;
        with the damping ratios: `Model.covariance`."""
        known = [(name, std) for name, (_, std, _, _) in self._estimates() if std is not None]
        place = {name: index for index, (name, _) in enumerate(known)}
        correlation = np.eye(len(known))
        for pair in self.to_dict()["correlations"]:
            first, second = (place.get(_called(pair[end], pair.get(f"{end}_piece"))) for end in ("first", "second"))
            if first is not None and second is not None:
                correlation[first, second] = correlation[second, first] = pair["value"]
        stds = np.array([std for _, std in known], dtype=np.float64)
        return matrix([name for name, _ in known], correlation * np.outer(stds, stds))

    @property
    def modes(self) -> Any:
        """A row a measured mode: piece, mode, nodal lines, measured and model frequency [Hz], error [%], damping ratio."""
        columns = [
            ("piece", "U"), ("mode", "i8"), ("nodes_x", "i8"), ("nodes_y", "i8"), ("measured_hz", "f8"), ("measured_std_hz", "f8"),
            ("model_hz", "f8"), ("error_percent", "f8"), ("zeta", "f8"), ("zeta_std", "f8"),
        ]  # fmt: skip
        rows = [
            [of["piece"], of["mode"], *of["nodes"], *(of[name] for name, _ in columns[4:])] for of in self.to_dict()["modes"]
        ]
        return table(columns, rows)

    @property
    def error(self) -> dict[str, float | None]:
        """How well the model meets the test: ``frequency_rms_percent``, ``left_one_out_percent``, ``accelerance_rms_percent`` and
        ``chi_square``; what is not known is ``None``."""
        return dict(self.to_dict()["error"])

    @property
    def accelerances(self) -> list[Accelerance]:
        """The records, measured and calculated."""
        return list(self._pairs)

    @property
    def models(self) -> dict[str, Model]:
        """The model of each piece, by its name."""
        return dict(self._models)

    @property
    def model(self) -> Model:
        """The model of the only piece.

        Raises:
            InputError: where there are several: `models` has them by name.
        """
        return only(self._models)

    def report(
        self, path: str | os.PathLike[str], *, trace: Trace | None = None, progress: bool | _progress.Tell | None = None
    ) -> None:
        """Writes one HTML page of the test, which needs no network and nothing beside it, as ``orthopanel report`` does.

        A fit that was pickled holds what was found, not what the page is drawn from (every record and hit, which would be as large as the
        test): it is identified and traced anew from its test, as long as that takes, to the same numbers.

        Args:
            path: Page to write.
            trace: What `orthopanel.trace` found of the same test; it is traced anew where this is left out.
        """
        if trace is not None and trace._held is not None and self._held is not None:
            page = self._held.page(trace._held)
        else:
            tell = _progress.teller(progress)
            try:
                page = self._test._held.page(self._words, tell)
            finally:
                _progress.end(tell)
        try:
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(page)
        except OSError as error:
            raise FileError(f"{os.fspath(path)!r} cannot be written: {error.strerror}", file=os.fspath(path)) from error

    def plot(self) -> Any:
        """A figure of matplotlib: records measured and calculated, else natural frequencies and their errors.

        Raises:
            ImportError: where matplotlib is not installed.
        """
        if self._pairs:
            return _plots.accelerances([("model", self._pairs)])
        return _plots.frequencies(self.to_dict()["modes"])

    def __repr__(self) -> str:
        constants = ", ".join(f"{name}={of[0]:.4g}" for name, of in self._estimates())
        return f"<orthopanel.Fit: {constants}>"

    def _estimates(self) -> list[tuple[str, tuple[float, float | None, str, bool]]]:
        answer = self.to_dict()
        of = [(name, None, entry) for name, entry in answer["constants"].items()]
        for piece, own in answer.get("own_constants", {}).items():
            of += [(name, piece, entry) for name, entry in own.items()]
        return [
            (_called(name, piece), (entry["value"], entry["std"], entry["unit"], entry["held"])) for name, piece, entry in of
        ]


def only(models: list[tuple[str, Model]]) -> Model:
    """The only one."""
    if len(models) != 1:
        names = ", ".join(repr(name) for name, _ in models)
        raise InputError(f"model: the test has {len(models)} pieces: take models[NAME] of {names}", key="model")
    return models[0][1]


def _called(name: str, piece: str | None) -> str:
    return name if piece is None else f"{name} of {piece}"
