# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes' log: Python's own, which the middleware takes to ROS."""

import logging
import math
import time
from collections.abc import Callable

log = logging.getLogger("oort.node")

COMPLAIN = 10.0
"""[s] between two warnings about the same"""


class Seldom:
    """Says the same kind of thing at most every so often."""

    def __init__(self, period: float = COMPLAIN, say: Callable[[str], None] = log.warning) -> None:
        """``period`` [s] of the wall's clock."""
        self._period = period
        self._say = say
        self._next = -math.inf

    def __call__(self, text: str) -> None:
        """Says it, unless that was done a moment ago."""
        now = time.monotonic()
        if now >= self._next:
            self._next = now + self._period
            self._say(text)


def once(say: Callable[[str], None] = log.warning) -> Seldom:
    """Says something the first time only."""
    return Seldom(math.inf, say)


class Forward(logging.Handler):
    """Takes the log to a middleware's functions, by the name of the level."""

    def __init__(self, by_level: dict[str, Callable[[str], None]]) -> None:
        """One function for each of INFO, WARNING, ERROR and CRITICAL."""
        super().__init__(logging.INFO)
        self._by_level = by_level

    def emit(self, record: logging.LogRecord) -> None:
        """Takes one line."""
        self._by_level[record.levelname](record.getMessage())

    def install(self) -> None:
        """In the place of what was there."""
        log.setLevel(logging.INFO)
        log.propagate, log.disabled = False, False
        log.handlers = [self]
