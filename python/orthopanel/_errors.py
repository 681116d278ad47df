"""What orthopanel refuses."""

from __future__ import annotations

import os
from typing import Any


class OrthopanelError(Exception):
    """Why something was not done: the message names the file, what is wrong in it, and the way out.

    Attributes:
        message: The whole of it.
        file: The file that it is about, or what stands for one in memory; ``None`` where it is about none.
        line: The line of the file, from 1, where one is known.
        key: The key of a test file, or the argument, where one is known.
        way_out: What to do, the end of the message.
    """

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        key: str | None = None,
        way_out: str | None = None,
    ) -> None:
        super().__init__(message)
        self.message, self.file, self.line, self.key, self.way_out = message, file, line, key, way_out

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.message, self.file, self.line, self.key, self.way_out)


class InputError(OrthopanelError, ValueError):
    """A test, records, a model or an argument that is not as it should be."""


class RefusedError(OrthopanelError, ValueError):
    """Input that is as it should be, to which the data or the model says no; the command ends with status 1."""


class FileError(OrthopanelError, OSError):
    """A file that cannot be read, or a result that cannot be written."""


class MissingFileError(FileError, FileNotFoundError):
    """A file that is not there."""


_KINDS: dict[str, type[OrthopanelError]] = {
    "file": FileError,
    "input": InputError,
    "missing": MissingFileError,
    "refused": RefusedError,
}


def of(kind: str, message: str, **about: Any) -> OrthopanelError:
    """The exception of a kind, as the native module calls it."""
    file = about.pop("file", None)
    return _KINDS.get(kind, OrthopanelError)(message, file=None if file is None else os.fspath(file), **about)
