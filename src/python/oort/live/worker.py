# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A thread for one piece of work after another."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

_Result = TypeVar("_Result")


class Worker:
    """Does what it is given in a thread of its own, in order."""

    def __init__(self, name: str) -> None:
        """``name`` is the thread's."""
        self._pool = ThreadPoolExecutor(1, thread_name_prefix=name)

    def submit(self, work: Callable[..., _Result], *args: Any) -> "Future[_Result]":
        """Does it after what was given before; at once, where Python is ending and has no threads any more."""
        try:
            return self._pool.submit(work, *args)
        except RuntimeError:
            done: Future[_Result] = Future()
            try:
                done.set_result(work(*args))
            except Exception as error:
                done.set_exception(error)
            return done

    def close(self) -> None:
        """Ends the thread after what it was given."""
        self._pool.shutdown()
