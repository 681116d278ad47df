"""Progress of long work, on standard error: in a terminal and in a notebook."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Union

Tell = Callable[[str, int, Union[int, None], str], None]
"""``tell(work, done, of, step)``: ``done`` of ``of`` steps of the work are done, ``step`` the last; ``of`` is ``None`` where nobody
knows."""

WIDTH = 30


def teller(progress: bool | Tell | None) -> Line | Tell | None:
    """What `progress` asks for: a callable as it is; ``None`` shows where somebody sees it."""
    if callable(progress):
        return progress
    shown = _is_seen() if progress is None else progress
    return Line() if shown else None


def end(tell: Line | Tell | None) -> None:
    """Takes a line of progress away."""
    if isinstance(tell, Line):
        tell.clear()


def _is_seen() -> bool:
    return "ipykernel" in sys.modules or bool(getattr(sys.stderr, "isatty", lambda: False)())


class Line:
    """One line that is written over itself."""

    def __init__(self) -> None:
        self.length = 0

    def __call__(self, work: str, done: int, of: int | None, step: str) -> None:
        """Shows how far it is."""
        bar = ""
        if of:
            full = WIDTH * min(done, of) // of
            bar = f" [{'#' * full}{'.' * (WIDTH - full)}] {done}/{of} {step}"
        text = f"{work}{bar}"
        print("\r" + text.ljust(self.length), end="", file=sys.stderr, flush=True)
        self.length = len(text)

    def clear(self) -> None:
        """Leaves an empty line."""
        if self.length:
            print("\r" + " " * self.length + "\r", end="", file=sys.stderr, flush=True)
            self.length = 0
