"""What the command would print."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._test import Test


class Answer:
    """What was found of a test, as JSON and as a text for people. Pickles do without what the native module holds."""

    _test: Test
    _held: Any
    _json: str
    _text: str

    def to_json(self) -> str:
        """What the command prints with ``--json``, but for the files that it read."""
        return self._json

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary."""
        found: dict[str, Any] = json.loads(self._json)
        return found

    @property
    def notes(self) -> list[str]:
        """What was assumed, left out, cut or found wanting."""
        return list(self.to_dict()["notes"])

    def _keep(self, test: Test, native: Any) -> None:
        # A test may be added to: the answer is of what it was.
        self._test = type(test)._of(test._made, list(test._calls), test._held)
        self._held, self._json, self._text = native, native.to_json(), native.text()

    def __str__(self) -> str:
        return self._text

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_held": None}
