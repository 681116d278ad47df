"""What the model of a test lacks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _native, _plots, _progress
from ._answer import Answer
from ._errors import OrthopanelError
from ._fit import only
from ._model import Model
from ._pairs import Accelerance, pairs
from ._tables import table

if TYPE_CHECKING:
    from ._test import Test


class Trace(Answer):
    """The effect that the model of a test lacks; made by `trace`. JSON is ``orthopanel.trace/2``; tables as of `Fit`."""

    _held: _native.Traced | None
    _sentence: str
    _models: list[tuple[str, Model]] | OrthopanelError | None
    _pairs: list[list[Accelerance]]

    @classmethod
    def _of(cls, test: Test, native: _native.Traced) -> Trace:
        trace = cls.__new__(cls)
        trace._keep(test, native)
        trace._sentence, trace._models = native.sentence(), None
        trace._pairs = [pairs(of) for of in native.accelerances()]
        return trace

    @property
    def verdict(self) -> str:
        """``"nothing-missing"``, ``"explained"``, ``"ambiguous"`` or ``"unexplained"``."""
        return str(self.to_dict()["verdict"])

    @property
    def sentence(self) -> str:
        """The verdict in one plain sentence."""
        return self._sentence

    @property
    def effects(self) -> Any:
        """A row a parameter of the effects that were found: effect, owner, parameter, value, std [SI units], unit; of records that
        each have their own, a row a record, from 1."""
        columns = [
            ("effect", "U"), ("owner", "U"), ("parameter", "U"), ("record", "i8"), ("value", "f8"), ("std", "f8"), ("unit", "U"),
        ]  # fmt: skip
        rows = []
        for effect in self.to_dict()["effects"]:
            for name, of in effect["parameters"].items():
                for record, one in enumerate(of if isinstance(of, list) else [of], start=1):
                    rows.append([effect["id"], effect["owner"], name, record, one["value"], one["std"], one["unit"]])
        return table(columns, rows)

    @property
    def alternatives(self) -> list[str]:
        """Effects that fit alike."""
        return list(self.to_dict()["alternatives"])

    @property
    def error(self) -> dict[str, Any]:
        """``measure``, ``before`` and ``after`` (each ``fitted`` and ``held_out``) and ``noise_floor``."""
        return dict(self.to_dict()["error"])

    @property
    def next_experiment(self) -> str:
        """The measurement that would part what fits alike; empty where none would."""
        return str(self.to_dict().get("next_experiment", ""))

    @property
    def accelerances(self) -> list[Accelerance]:
        """The records, measured and by the model with the effects that were found."""
        return list(self._pairs[1])

    @property
    def base_accelerances(self) -> list[Accelerance]:
        """The same, by the model without them."""
        return list(self._pairs[0])

    @property
    def models(self) -> dict[str, Model]:
        """The model of each piece after tracing, by its name: effects of the panel stay in it, those of rig and measuring chain are out.

        Raises:
            RefusedError: where no effect explains the data and the base model is refused.
        """
        return dict(self._found())

    @property
    def model(self) -> Model:
        """The model after tracing of the only piece."""
        return only(self._found())

    def plot(self) -> Any:
        """A figure of matplotlib: records measured, by the base model and with the effects; else the evidence of the hypotheses.

        Raises:
            ImportError: where matplotlib is not installed.
        """
        if self._pairs[1]:
            return _plots.accelerances([("base model", self._pairs[0]), ("with effects", self._pairs[1])])
        return _plots.evidence(self.to_dict()["candidates"])

    def _found(self) -> list[tuple[str, Model]]:
        if isinstance(self._models, OrthopanelError):
            raise self._models
        if self._models is None and self._held is not None:
            tell = _progress.teller(False)
            self._models = [(name, Model._of(model)) for name, model in self._held.models(tell)]
        return self._models or []

    def __repr__(self) -> str:
        effects = ", ".join(str(effect["id"]) for effect in self.to_dict()["effects"])
        return f"<orthopanel.Trace: {self.verdict}{': ' if effects else ''}{effects}>"

    def __getstate__(self) -> dict[str, Any]:
        try:
            models: Any = self._found()
        except OrthopanelError as refused:
            models = refused
        return {**super().__getstate__(), "_models": models}
