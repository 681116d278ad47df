"""Tables: pandas where it is installed, structured arrays of numpy else."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np


def installed(name: str) -> Any:
    """The package of that name, or ``None``."""
    return import_module(name) if find_spec(name) is not None else None


def table(columns: Sequence[tuple[str, str]], rows: Sequence[Sequence[Any]], index: str | None = None) -> Any:
    """A table of columns with a name and a dtype of numpy (``U`` for texts of any length); what is not known is NaN."""
    data: dict[str, Any] = {}
    for place, (name, dtype) in enumerate(columns):
        values = [row[place] for row in rows]
        if dtype == "f8":
            values = [float("nan") if value is None else value for value in values]
        elif dtype == "U":
            values = ["" if value is None else str(value) for value in values]
        data[name] = np.array(values, dtype=dtype)
    pandas = installed("pandas")
    if pandas is not None:
        frame = pandas.DataFrame({name: list(values) if values.dtype.kind == "U" else values for name, values in data.items()})
        return frame if index is None else frame.set_index(index)
    found = np.empty(len(rows), dtype=[(name, values.dtype if values.dtype.itemsize else "U1") for name, values in data.items()])
    for name, values in data.items():
        found[name] = values
    return found


def matrix(names: Sequence[str], values: np.ndarray[Any, Any]) -> Any:
    """A square matrix, with names on both sides where pandas is installed."""
    pandas = installed("pandas")
    return values if pandas is None else pandas.DataFrame(values, index=list(names), columns=list(names))
