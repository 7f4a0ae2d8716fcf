# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A process for each piece of work, so that its memory and its CPU time are its own and its failure is, too."""

import multiprocessing
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Generic, TypeVar

T = TypeVar("T")

_CONTEXT = multiprocessing.get_context("fork")  # a child has all that is loaded, and work need not be pickled


@dataclass(frozen=True)
class Failure:
    """Work that did not end well, and why."""

    reason: str


@dataclass(frozen=True)
class _Running(Generic[T]):
    index: int
    process: multiprocessing.process.BaseProcess


def run_all(work: Sequence[Callable[[], T]], at_once: int) -> Iterator[tuple[int, T | Failure]]:
    """Runs each in a forked process, so many at once; yields the place in ``work`` and the result as they end."""
    waiting = list(enumerate(work))[::-1]
    running: dict[Connection, _Running[T]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < at_once:
                index, call = waiting.pop()
                receiver, sender = _CONTEXT.Pipe(duplex=False)
                process = _CONTEXT.Process(target=_run, args=(call, sender), daemon=True)
                process.start()
                sender.close()
                running[receiver] = _Running(index, process)
            for ready in wait(list(running)):
                assert isinstance(ready, Connection)
                done = running.pop(ready)
                yield done.index, _receive(ready, done.process)
    finally:
        for left in running.values():
            left.process.terminate()


def _run(call: Callable[[], T], sender: Connection) -> None:
    try:
        result: T | Failure = call()
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        result = Failure(f"{type(error).__name__}: {error} ({where.name}, line {where.lineno})")
    sender.send(result)
    sender.close()


def _receive(receiver: Connection, process: multiprocessing.process.BaseProcess) -> T | Failure:
    try:
        result: T | Failure = receiver.recv()
    except EOFError:
        process.join()
        return Failure(f"the process ended with {process.exitcode}")
    finally:
        receiver.close()
    process.join()
    return result
