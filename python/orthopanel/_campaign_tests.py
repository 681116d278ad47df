"""Tests of a campaign, and the rows of what was found."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _native
from ._campaign_parts import digest
from ._errors import InputError, OrthopanelError, RefusedError
from ._fit import Fit
from ._model import Model
from ._test import Test, identify, trace
from ._trace import Trace


@dataclass(frozen=True)
class Entry:
    """A test, its panel's name, the file that it was named by, and the SHA-256 of all that it is of; why it cannot be read."""

    panel: str
    file: str
    sha256: str
    test: Test | None
    refused: OrthopanelError | None = None

    @classmethod
    def of(cls, test: Any, panel: str | None = None) -> Entry:
        """Of a test, or of its file."""
        if isinstance(test, Test):
            return cls(panel or "", panel or "", _sha256(test), test)
        file = os.fspath(test)
        path = Path(file) / "test.toml" if os.path.isdir(file) else Path(file)
        name = panel or (path.absolute().parent.name if path.stem == "test" else path.stem)
        try:
            read = Test.load(path)
            return cls(name, file, _sha256(read), read)
        except OrthopanelError as refused:
            content = path.read_bytes() if path.is_file() else b""
            return cls(name, file, hashlib.sha256(content).hexdigest(), None, refused)

    def read(self) -> Test:
        """The test.

        Raises:
            OrthopanelError: why there is none.
        """
        if self.refused is not None:
            raise self.refused
        assert self.test is not None
        return self.test

    def common(self) -> dict[str, Any]:
        """What stands in each of its rows."""
        return {"panel": self.panel, "test": self.file, "sha256": self.sha256, "version": _native.__version__, "failed": None}


def lot(tests: Any, how: Any) -> list[tuple[str, Entry]]:
    """Each test with what tells its task from others."""
    if isinstance(tests, Mapping):
        entries = [Entry.of(test, str(panel)) for panel, test in tests.items()]
    elif isinstance(tests, (str, os.PathLike)):
        entries = [Entry.of(file) for file in _files(tests)]
    elif isinstance(tests, Iterable):
        entries = []
        for number, test in enumerate(tests, start=1):
            entries += [Entry.of(test, str(number))] if isinstance(test, Test) else [Entry.of(file) for file in _files(test)]
    else:
        raise TypeError(f"tests: must be files, folders or Tests, not {type(tests).__name__}")
    return [(digest([how, entry.panel, entry.file, entry.sha256]), entry) for entry in entries]


def identified(entry: Entry, options: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The rows of an identification."""
    fit = identify(entry.read(), progress=False, **options)
    error = fit.error
    told = {
        "verdict": "not-traced",
        "effects": None,
        "notes": " | ".join(dict.fromkeys(fit.notes)) or None,
        "error_percent": error["frequency_rms_percent"],
        "left_out_error_percent": error["left_one_out_percent"],
    }
    return _rows(entry, fit, told)


def traced(entry: Entry, reference: Test | None) -> list[dict[str, Any]]:
    """The rows of a trace."""
    why = trace(entry.read(), reference=reference, progress=False)
    error = why.error
    told = {
        "verdict": why.verdict,
        "effects": " + ".join(effect["id"] for effect in why.to_dict()["effects"]) or None,
        "alternatives": " + ".join(why.alternatives) or None,
        "notes": " | ".join(dict.fromkeys(why.notes)) or None,
        "error_before": error["before"]["fitted"],
        "error_after": error["after"]["fitted"],
    }
    return _rows(entry, why, told)


def _rows(entry: Entry, of: Fit | Trace, told: dict[str, Any]) -> list[dict[str, Any]]:
    try:
        models = of.models
    except (InputError, RefusedError) as refused:
        # Nothing explains the records, and no base model does: the refusal stands, beside the verdict.
        return [{**entry.common(), "failed": str(refused), "structure": None, **told, "answer": of.to_json()}]
    rows = []
    for piece, model in models.items():
        common = entry.common()
        if len(models) > 1 or not common["panel"]:
            common["panel"] = piece
        content = {"answer": of.to_json(), "model": model.to_json()}
        rows.append({**common, "structure": model.structure, **told, **_constants(model), **content})
    return rows


def _constants(model: Model) -> dict[str, float | None]:
    """Columns of a model's constants, as `orthopanel batch` has them."""
    found: dict[str, float | None] = {}
    of = model.to_dict()
    for name, value in of["constants"].items():
        found[name], found[f"{name}_std"] = (value["value"], value.get("std")) if isinstance(value, dict) else (value, None)
    correlation = of.get("correlation", {"names": [], "matrix": []})
    for row, first in enumerate(correlation["names"]):
        for column, second in enumerate(correlation["names"][:row]):
            if first in of["constants"] and second in of["constants"]:
                found[f"corr:{':'.join(sorted((first, second)))}"] = correlation["matrix"][row][column]
    return found


def _files(path: Any) -> list[str]:
    """A file as it is; of a folder every `test.toml` in it and below."""
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"tests: must be files, folders or Tests, not {type(path).__name__}")
    named = str(os.fspath(path))
    if not os.path.isdir(named):
        return [named]
    found = sorted(os.path.join(folder, "test.toml") for folder, _, files in os.walk(named) if "test.toml" in files)
    if not found:
        raise InputError(f"{named}: holds no test.toml", file=named)
    return found


def _sha256(test: Test) -> str:
    """Of what a test is made of; as of `orthopanel batch` where it is a file."""
    whole = hashlib.sha256()
    kind, text, *_ = test._made
    whole.update(hashlib.sha256(text.encode()).hexdigest().encode())
    for file in dict.fromkeys(test._held.files):
        whole.update(hashlib.sha256(Path(file).read_bytes()).hexdigest().encode())
    for method, arguments in test._calls:
        whole.update(method.encode())
        for of in arguments:
            array = of.tobytes() if hasattr(of, "tobytes") else json.dumps(of).encode()
            whole.update(f"{getattr(of, 'shape', '')}".encode() + array)
    return whole.hexdigest()
