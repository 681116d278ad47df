"""Campaigns: many tests identified or traced, many models simulated, on one machine or a cluster.

>>> import orthopanel as op
>>> lot = op.campaign.trace("measurements/2026-11", "traced/")  # doctest: +SKIP
>>> lot.groupby("effects")["e_x"].mean().compute()  # doctest: +SKIP

Work goes through ``dask.distributed``: to the client that is given, else to the current one, else to a ``LocalCluster`` with one process a
core for as long as the call lasts. Needs ``pip install orthopanel[campaign]``.

**What is done lies on disk.** Each result is a Parquet file in the folder as soon as this process has it; only this process writes, so workers
share no file system unless tests name files. The same call again does what is missing: a result is kept for as long as its
test (with every file that it names) or its model, the options and the version are the same. A worker that dies costs what it was at; its
task goes to another one.

**What fails is a row** with the reason in ``failed``. What the data or the model refuse is final. Any other exception is tried again
``retries`` times, and once more by the next call.

Every worker process computes on as many threads as it has for tasks, however many cores there are.
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Union

from . import _campaign_tests, _progress
from ._campaign_parts import Parts, digest
from ._campaign_work import needed, results
from ._errors import InputError
from ._model import Model
from ._native import __version__
from ._test import Test
from ._test import identify as _identify

__all__ = ["fmu", "identify", "runs", "trace"]

Tests = Union[str, os.PathLike[str], Iterable[Union[str, os.PathLike[str], Test]], Mapping[str, Union[str, os.PathLike[str], Test]]]
"""A test file, or a folder: every ``test.toml`` in it and below; several of them; or tests, by a mapping with the names of their panels."""


def identify(
    tests: Tests,
    out: str | os.PathLike[str],
    *,
    client: Any = None,
    retries: int = 2,
    progress: bool | _progress.Tell | None = None,
    **options: Any,
) -> Any:
    """Identifies a lot of panels.

    Args:
        tests: Files, folders or tests. Files that a test names are read by the workers.
        out: Folder of the results, made where it is not there.
        client: A ``dask.distributed.Client``.
        retries: Of a task that raised.
        progress: As of `orthopanel.identify`; a step is a test.
        **options: As of `orthopanel.identify`.

    Returns:
        A Dask dataframe, a row a panel, with the columns of ``orthopanel batch``: ``panel``, ``test``, ``sha256``, ``version``, ``failed``,
        ``structure``, ``verdict`` (``"not-traced"``), ``notes``, ``error_percent`` and ``left_out_error_percent`` of the frequencies,
        each constant [Pa, Poisson's ratio 1; shear moduli with k' = 2/3] with ``NAME_std``, and ``corr:NAME:OTHER``; beside them ``answer``
        (JSON, ``orthopanel.identified/1``) and ``model`` (JSON, ``orthopanel.model/1``, for `Model.from_json`). ``orthopanel lot OUT``
        draws it.

    Raises:
        ImportError: where Dask is not installed. InputError: where there is no test. TypeError: for options that are none.
    """
    inspect.signature(_identify).bind(None, **options)
    lot = _campaign_tests.lot(tests, [__version__, "identify", options])
    return _done("identifying", _campaign_tests.identified, lot, out, client, retries, progress, options)


def trace(
    tests: Tests,
    out: str | os.PathLike[str],
    *,
    reference: Test | str | os.PathLike[str] | None = None,
    client: Any = None,
    retries: int = 2,
    progress: bool | _progress.Tell | None = None,
) -> Any:
    """Traces a lot of panels.

    Args:
        tests, out, client, retries, progress: As of `identify`.
        reference: As of `orthopanel.trace`, of all tests.

    Returns:
        As of `identify`, with the models after tracing (`Trace.models`); ``verdict``, ``effects`` (joined by `` + ``), ``alternatives``, ``error_before`` and
        ``error_after`` (fitted, in the measure of the trace) come in place of the errors of the frequencies, and ``answer`` is
        ``orthopanel.trace/2``, with the parameters of the effects.

    Raises:
        ImportError: where Dask is not installed. InputError: where there is no test.
    """
    of = None if reference is None else _campaign_tests.Entry.of(reference)
    against = None if of is None else of.read()
    lot = _campaign_tests.lot(tests, [__version__, "trace", None if of is None else of.sha256])
    return _done("tracing", _campaign_tests.traced, lot, out, client, retries, progress, against)


def runs(
    models: Iterable[Model],
    simulate: Callable[[Model], Any],
    out: str | os.PathLike[str],
    *,
    client: Any = None,
    retries: int = 2,
    progress: bool | _progress.Tell | None = None,
) -> Any:
    """Calls a function with each of many models, as those of ``fit.model.sample(500)``: Monte Carlo runs.

    Args:
        models: The models, in an order that stays.
        simulate: ``simulate(model)``, on a worker: gives a mapping from names to values (one row), or a ``pandas.DataFrame`` (rows). A
            function of a module, or a ``functools.partial`` of one, whose arguments tell one campaign from another; that its code has
            changed is not seen.
        out, client, retries, progress: As of `identify`; a step is a run.

    Returns:
        A Dask dataframe: ``run`` from 0, ``failed``, the model's constants by name, and what ``simulate`` gave.

    Raises:
        ImportError: where Dask is not installed. InputError: where there is no model.
    """
    needed()
    tokenize = import_module("dask.base").tokenize
    all_models = list(models)
    for model in all_models:
        if not isinstance(model, Model):
            raise TypeError(f"models: must be Models, not {type(model).__name__}")
    if not callable(simulate):
        raise TypeError(f"simulate: must be callable, not {type(simulate).__name__}")
    what = tokenize(simulate)
    tasks = [(digest([what, number, model.to_json()]), (number, model)) for number, model in enumerate(all_models)]
    return _done("simulating", _run, tasks, out, client, retries, progress, simulate)


@contextmanager
def fmu(model: Model, **options: Any) -> Iterator[Path]:
    """A model as an FMU for as long as the ``with`` lasts; options as of `Model.export`.

    >>> def simulate(model):
    ...     with op.campaign.fmu(model, fmi=3, modes=10) as path:
    ...         result = fmpy.simulate_fmu(path, stop_time=1.0)
    ...     return {"peak": abs(result["acceleration_1"]).max()}
    """
    with TemporaryDirectory(prefix="orthopanel-") as folder:
        path = Path(folder) / "panel.fmu"
        model.export(path, **options)
        yield path


def _run(of: tuple[int, Model], simulate: Callable[[Model], Any]) -> Any:
    number, model = of
    common = {"run": number, "failed": None, **model.constants}
    found = simulate(model)
    if isinstance(found, Mapping):
        return [{**common, **found}]
    if hasattr(found, "assign") and hasattr(found, "columns"):
        frame = found.assign(**{name: value for name, value in common.items() if name not in found.columns})
        return frame[[*(name for name in common if name not in found.columns), *found.columns]]
    raise InputError(f"simulate: gave {type(found).__name__}: must give a mapping or a pandas.DataFrame", key="simulate")


def _done(
    work: str,
    does: Callable[[Any, Any], Any],
    tasks: list[tuple[str, Any]],
    out: str | os.PathLike[str],
    client: Any,
    retries: int,
    progress: bool | _progress.Tell | None,
    given: Any,
) -> Any:
    needed()
    if not tasks:
        raise InputError(f"{work}: nothing is given", way_out="give at least one")
    parts = Parts(Path(out), [key for key, _ in tasks])
    tell = _progress.teller(progress)
    done = len(tasks) - len(parts.missing)
    try:
        if tell is not None:
            tell(work, done, len(tasks), "")
        missing = {number: tasks[number][1] for number in parts.missing}
        with closing(results(does, missing, given, client, retries)) as found:
            for number, rows, is_final in found:
                parts.write(number, rows, is_final)
                done += 1
                if tell is not None:
                    tell(work, done, len(tasks), "")
    finally:
        _progress.end(tell)
    return parts.table()
