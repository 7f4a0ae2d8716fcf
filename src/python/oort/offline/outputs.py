# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of a run one by one: what goes wrong with one is told, and costs no other."""

from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


class Outputs:
    """What a run has written, and what it could not write."""

    def __init__(self) -> None:
        """Nothing so far."""
        self.written: list[str] = []
        self.failed: list[str] = []
        """a sentence for each"""

    def write(self, names: str, work: Callable[[], object]) -> None:
        """Does what writes the files of these names."""
        if self.work_out(names, work) is not None:
            self.written.append(names)

    def work_out(self, what: str, work: Callable[[], T]) -> T | bool | None:
        """What a step gives (True for None), or None if it failed."""
        try:
            result = work()
        except Exception as error:  # a drive of hours stands behind: whatever it is, the rest is to be saved
            self.failed.append(f"{what} was not written: {error or type(error).__name__}")
            return None
        return True if result is None else result
