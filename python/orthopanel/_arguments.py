"""Arguments, checked before the native module sees them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._errors import InputError

Place = Union[float, tuple[float, float], Iterable[float]]
"""x, or (x, y), in m from the piece's centre."""

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]


def number(value: Any, key: str) -> float:
    """A finite real number."""
    if isinstance(value, (str, bytes, bool)) or not hasattr(type(value), "__float__"):
        raise TypeError(f"{key}: must be a real number, not {type(value).__name__}")
    try:
        found = float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise TypeError(f"{key}: must be a real number: {error}") from None
    if not math.isfinite(found):
        raise InputError(f"{key} = {found}: must be a finite number", key=key, way_out="must be a finite number")
    return found


def optional(value: Any, key: str) -> float | None:
    """As `number`, of what may be left out."""
    return None if value is None else number(value, key)


def whole(value: Any, key: str, least: int = 0, most: int = 2**63 - 1) -> int:
    """A whole number, from `least` to `most`."""
    if isinstance(value, (bool, np.bool_)) or not hasattr(type(value), "__index__"):
        raise TypeError(f"{key}: must be a whole number, not {type(value).__name__}")
    found = value.__index__()
    if not least <= found <= most:
        raise InputError(f"{key} = {found}: must be a whole number from {least} to {most}", key=key)
    return int(found)


def place(value: Any, key: str) -> tuple[float, float]:
    """(x, y) of x or of a pair."""
    if isinstance(value, (str, bytes, Mapping)):
        raise TypeError(f"{key}: must be x or (x, y) in m, not {type(value).__name__}")
    if not isinstance(value, Iterable) or (isinstance(value, np.ndarray) and value.ndim == 0):
        return number(value, key), 0.0
    parts = list(value)
    if len(parts) not in (1, 2):
        raise InputError(f"{key}: {len(parts)} numbers: give x or (x, y) in m", key=key)
    x, y = number(parts[0], key), number(parts[1], key) if len(parts) == 2 else 0.0
    return x, y


def places(value: Iterable[Any], key: str) -> list[tuple[float, float]]:
    """Places of a sequence."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        raise TypeError(f"{key}: must be a sequence of places, not {type(value).__name__}")
    return [place(one, f"{key}[{index}]") for index, one in enumerate(value)]


def named_places(
    value: Iterable[Any] | Mapping[str, Any] | None, key: str
) -> list[tuple[str | None, tuple[float, float]]] | None:
    """Places of a sequence, or of a mapping from names."""
    if value is None:
        return None
    if isinstance(value, Mapping):
        return [(str(name), place(at, f"{key}[{name!r}]")) for name, at in value.items()]
    return [(None, at) for at in places(value, key)]


def _array(value: Any, key: str, kinds: str, dtype: Any) -> Any:
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise InputError(f"{key}: some of it is masked: fill it or cut it out", key=key)
    try:
        found = np.asarray(value)
    except ValueError as error:
        # Lists of unequal length.
        raise InputError(f"{key}: {error}", key=key) from None
    if found.dtype.kind not in kinds:
        raise TypeError(f"{key}: must be an array of numbers, not of dtype {found.dtype}")
    return np.ascontiguousarray(found, dtype=dtype).reshape(found.shape)


def hits(value: Any, key: str) -> Floats:
    """hits x samples; a single record is one hit."""
    found = _array(value, key, "fiu", np.float64)
    if found.ndim == 1:
        found = found[np.newaxis, :]
    if found.ndim != 2:
        raise InputError(f"{key}: has {found.ndim} dimensions: must be hits x samples", key=key)
    return found  # type: ignore[no-any-return]


def numbers(value: Any, key: str) -> Floats:
    """Finite numbers, in any shape."""
    found = _array(value, key, "fiu", np.float64)
    if not np.isfinite(found).all():
        raise InputError(f"{key}: some of it is no finite number", key=key)
    return found  # type: ignore[no-any-return]


def line(value: Any, key: str, kinds: str = "fiu", dtype: Any = np.float64) -> Any:
    """One row of numbers, which the native module looks through."""
    found = _array(value, key, kinds, dtype)
    if found.ndim != 1:
        raise InputError(f"{key}: has {found.ndim} dimensions: must be a row of numbers", key=key)
    return found


def mapping(value: Any, key: str) -> dict[str, Any]:
    """What is known by name; nothing is an empty one."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise TypeError(f"{key}: must be a mapping of names, not {type(value).__name__}")
    return dict(value)


def words(value: Any, key: str) -> str | None:
    """A text, or nothing."""
    if value is not None and not isinstance(value, str):
        raise TypeError(f"{key}: must be a str, not {type(value).__name__}")
    return value
