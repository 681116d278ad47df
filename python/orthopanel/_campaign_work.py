"""Tasks of a campaign on `dask.distributed`."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from contextlib import ExitStack
from functools import partial
from importlib import import_module
from typing import Any
from uuid import uuid4

from . import _native
from ._errors import InputError, RefusedError

PACKAGES = ["pandas", "pyarrow", "dask.dataframe", "distributed"]


def needed() -> tuple[Any, Any]:
    """`pyarrow` with `pyarrow.parquet`, and `dask.dataframe`.

    Raises:
        ImportError: with the way out where one of them is not installed.
    """
    for name in PACKAGES:
        try:
            import_module(name)
        except ImportError as error:
            raise ImportError(f"orthopanel.campaign needs Dask: pip install orthopanel[campaign] ({error})") from error
    import_module("pyarrow.parquet")
    return import_module("pyarrow"), import_module("dask.dataframe")


def results(
    does: Callable[[Any, Any], Any], tasks: Mapping[int, Any], given: Any, client: Any, retries: int
) -> Generator[tuple[int, Any, bool], None, None]:
    """Does `does(task, given)` of every task: its number, its rows, and whether they are final, as they come."""
    if not tasks:
        return
    distributed = import_module("distributed")
    with ExitStack() as stack:
        on = client if client is not None else _current(distributed)
        if on is None:
            on = stack.enter_context(_local(distributed))
        if not isinstance(on, distributed.Client):
            raise TypeError(f"client: must be a dask.distributed.Client, not {type(on).__name__}")
        if on.asynchronous:
            raise TypeError("client: is asynchronous: give one that is not")
        name = does.__name__.strip("_")
        submit = partial(on.submit, _task, does, retries=retries, pure=False)
        futures = {submit(task, given, key=f"{name}-{uuid4().hex}"): number for number, task in tasks.items()}
        # Whatever ends this early ends what is under way.
        stack.callback(lambda: on.cancel(list(futures), force=True))
        for future, result in distributed.as_completed(futures, loop=on.loop, with_results=True, raise_errors=False):
            number = futures.pop(future)
            if future.status == "finished":
                rows, is_final = result
            elif future.status == "error":
                rows, is_final = _failed(tasks[number], result[1]), False
            else:
                raise RuntimeError("the cluster is gone: the same call again goes on where this one ended")
            future.release()
            yield number, rows, is_final


def _task(does: Callable[[Any, Any], Any], task: Any, given: Any) -> tuple[Any, bool]:
    """On a worker."""
    _limit_threads()
    try:
        return does(task, given), True
    except (InputError, RefusedError) as refused:
        return _failed(task, refused), True


def _failed(task: Any, error: BaseException) -> list[dict[str, Any]]:
    common = {"run": task[0], **task[1].constants} if isinstance(task, tuple) else task.common()
    told = str(error) if isinstance(error, (InputError, RefusedError)) else f"{type(error).__name__}: {error}"
    return [{**common, "failed": told}]


def _limit_threads() -> None:
    """One pool a process, of as many threads as the worker has: tasks side by side share it."""
    try:
        worker = import_module("distributed").get_worker()
    except ValueError:
        return
    _native.limit_threads(worker.state.nthreads)


def _current(distributed: Any) -> Any:
    try:
        return distributed.default_client()
    except ValueError:
        return None


def _local(distributed: Any) -> Any:
    cores = import_module("dask.system").CPU_COUNT
    return distributed.Client(n_workers=cores, threads_per_worker=1, dashboard_address=None, set_as_default=False)
