# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the work on many recordings is done: processes of this machine, or a Dask cluster."""

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

from oort.errors import InputError, OortError
from oort.inputs import check_regular, quoted

_Task = TypeVar("_Task")
_Result = TypeVar("_Result")

RETRIES = 2
"""How often a cluster begins a task anew whose worker failed; a worker that merely went away costs no try."""
_SECONDS_TO_CONNECT = 20


@contextlib.contextmanager
def open_pool(jobs: int, cluster: str | None) -> Iterator[Executor]:
    """So many threads, each of which may start a process; or the workers of the Dask cluster at an address.

    What is handed to the pool must be able to travel to another machine. Raises InputError if there is no such cluster,
    or if its workers have another version of Oort, whose maps would not have the same bytes.
    """
    if cluster is None:
        pool = ThreadPoolExecutor(max(1, jobs))
        try:
            yield pool
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError('--cluster needs Dask: pip install "oort[cluster]"') from error
    try:
        client = Client(cluster, timeout=_SECONDS_TO_CONNECT)
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(f"no Dask scheduler answers at {cluster}: {error}") from error
    with client:
        _check_versions(client.run(_version))
        executor = client.get_executor(pure=False, retries=RETRIES)
        try:
            yield executor
        finally:
            executor.shutdown(wait=False)


def in_pool(
    pool: Executor, work: Callable[[_Task], _Result], tasks: Iterable[_Task]
) -> Iterator[tuple[_Task, _Result | OortError]]:
    """Each task with its result, as they come; with an error if it took down every worker that had it."""
    futures = {pool.submit(work, task): task for task in tasks}
    for future in as_completed(list(futures)):
        task, error = futures.pop(future), future.exception()  # popped: a result may be large
        if error is None:
            yield task, future.result()
        elif type(error).__name__ == "KilledWorker":
            yield task, OortError("every worker of the cluster that had it died")
        else:
            raise error


@contextlib.contextmanager
def local_copy(recording: str, beside: Sequence[str] = ()) -> Iterator[str]:
    """The path of a recording here: itself, or of what is behind a URL that fsspec knows a copy that is soon gone.

    With the copy come the files beside it that are called as it is up to the first dot, with these endings.
    """
    if not is_url(recording):
        yield recording
        return
    with tempfile.TemporaryDirectory(prefix="oort-") as place:
        name = recording.partition("://")[2].rstrip("/").rpartition("/")[2]
        if name in ("", ".", "..") or "\0" in name:
            raise InputError(f"{quoted(recording)} does not end in the name of a recording")
        path = Path(place) / name
        system, inner = _file_system(recording)
        if "file" in system.protocol and os.path.exists(inner):
            check_regular(Path(inner), recording)
        try:
            system.get(inner, str(path), recursive=system.isdir(inner))
            for ending in beside:
                folder, _, name = inner.rstrip("/").rpartition("/")
                name = name.split(".")[0] + ending
                if system.exists(f"{folder}/{name}"):
                    system.get(f"{folder}/{name}", f"{place}/{name}")
        except Exception as error:  # each kind of storage has its own
            raise InputError(f"{recording}: cannot be fetched: {str(error) or type(error).__name__}") from error
        yield str(path)


def fingerprint(recording: str) -> str:
    """Another one for a recording that was changed. Raises InputError if there is none."""
    if is_url(recording):
        system, inner = _file_system(recording)
        try:
            told = f"{recording} {system.ukey(inner)}"
        except Exception as error:
            raise InputError(f"{recording} cannot be found: {str(error) or type(error).__name__}") from error
    else:
        try:
            stat = os.stat(recording)
        except (OSError, ValueError) as error:
            raise InputError(f"{quoted(recording)} does not exist") from error
        told = f"{os.path.abspath(recording)} {stat.st_size} {stat.st_mtime_ns}"
    return hashlib.sha256(told.encode()).hexdigest()


def is_url(recording: str) -> bool:
    """Whether it is fetched with fsspec: s3://bucket/drive.bag and the like."""
    return "://" in recording


def _file_system(url: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs
    except ImportError as error:
        raise InputError(f'{url}: URLs need fsspec: pip install "oort[cluster]"') from error
    try:
        system, inner = url_to_fs(url)
    except Exception as error:  # each kind of storage has its own
        raise InputError(f"{quoted(url)}: {str(error) or type(error).__name__}") from error
    return system, str(inner)


def _version() -> str:
    try:
        return version("oort")
    except Exception:  # on a worker, where any trouble with it is told as this one
        return "no Oort"


def _check_versions(workers: dict[str, str]) -> None:
    wrong = {address: theirs for address, theirs in workers.items() if theirs != _version()}
    if wrong:
        told = ", ".join(f"{address} has {theirs}" for address, theirs in sorted(wrong.items()))
        raise InputError(f"the workers must have Oort {_version()}, as here, but {told}")
