"""Results of a campaign: a folder with a Parquet file a task."""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ._campaign_work import needed

# Of a task that is to be done once more by the next campaign: `.again`.
NAME = re.compile(r"(?P<number>\d{6,})-(?P<key>[0-9a-f]{24})(?P<again>\.again)?\.parquet")

TEXTS = {"failed", "effects", "alternatives", "notes"}


def digest(of: Any) -> str:
    """What tells a task from any other: of what JSON holds."""
    return hashlib.sha256(json.dumps(of, sort_keys=True, default=repr).encode()).hexdigest()[:24]


class Parts:
    """Files of the tasks with these keys in a folder, in their order; those of other tasks stay as they are."""

    def __init__(self, folder: Path, keys: Sequence[str]) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        # Two tasks may be alike: each has its own file.
        seen: dict[str, int] = {}
        self.keys = []
        for key in keys:
            seen[key] = seen.get(key, 0) + 1
            self.keys.append(key if seen[key] == 1 else digest([key, seen[key]]))
        there = self._there()
        for number, key in enumerate(self.keys):
            for path in there.get(key, []):
                if ".again" in path.suffixes:
                    path.unlink()
                else:
                    path.rename(self._path(number))
        self.missing = [number for number in range(len(self.keys)) if not self._path(number).exists()]

    def write(self, number: int, rows: Any, is_final: bool) -> None:
        """Puts a task's rows in place at once: dictionaries, or a DataFrame."""
        arrow, _ = needed()
        if isinstance(rows, list):
            table = arrow.Table.from_pylist(rows)
        else:
            table = arrow.Table.from_pandas(rows, preserve_index=False).replace_schema_metadata(None)
        self._put(self._path(number, again=not is_final), table)

    def table(self) -> Any:
        """All of them as a Dask dataframe."""
        arrow, dataframe = needed()
        there = self._there()
        paths = [path for key in self.keys for path in there.get(key, [])]
        schemas = [arrow.parquet.read_schema(path) for path in paths]
        whole = arrow.unify_schemas(schemas, promote_options="permissive")
        # Nowhere given: a text, or a number.
        types = {True: arrow.string(), False: arrow.float64()}
        fields = [field.with_type(types[field.name in TEXTS]) if arrow.types.is_null(field.type) else field for field in whole]
        whole = arrow.schema(fields)
        # What failed has fewer columns, and a constant that is nowhere given has no type: readers take those of the first file.
        for path, schema in zip(paths, schemas, strict=True):
            if schema != whole:
                table = arrow.parquet.read_table(path, partitioning=None)
                columns = [
                    table[field.name].cast(field.type) if field.name in table.column_names else arrow.nulls(len(table), field.type)
                    for field in whole
                ]
                self._put(path, arrow.table(columns, schema=whole))
        return dataframe.read_parquet([os.fspath(path) for path in paths])

    def _path(self, number: int, again: bool = False) -> Path:
        return self.folder / f"{number:06d}-{self.keys[number]}{'.again' if again else ''}.parquet"

    def _put(self, path: Path, table: Any) -> None:
        arrow, _ = needed()
        draft = path.with_suffix(".writing")
        # Not compressed: the command reads them too.
        arrow.parquet.write_table(table, draft, compression="none")
        os.replace(draft, path)

    def _there(self) -> dict[str, list[Path]]:
        found: dict[str, list[Path]] = {}
        for path in sorted(self.folder.iterdir()):
            if named := NAME.fullmatch(path.name):
                found.setdefault(named["key"], []).append(path)
        return found

