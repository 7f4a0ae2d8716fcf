# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Figures over the last while: how long things take, and how often they come. Thread-safe."""

import threading
from collections import deque
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Spread:
    """What is usual and what is worst among samples; each value is one of them."""

    p50: float
    p99: float
    max: float


class Window:
    """The last samples of something measured."""

    def __init__(self, size: int = 600) -> None:
        """Keeps ``size`` samples; the default is a minute of a sensor at 10 Hz."""
        self._samples: deque[float] = deque(maxlen=size)
        self._lock = threading.Lock()

    def __len__(self) -> int:
        """How many samples are kept now."""
        return len(self._samples)

    def add(self, value: float) -> None:
        """Takes a sample."""
        with self._lock:
            self._samples.append(value)

    @property
    def spread(self) -> Spread | None:
        """Of the samples that are kept; None if there are none."""
        with self._lock:
            samples = list(self._samples)
        if not samples:
            return None
        p50, p99 = np.quantile(samples, [0.5, 0.99], method="inverted_cdf").tolist()
        return Spread(p50, p99, max(samples))


class Rate:
    """How often something comes, going by a clock that the caller reads."""

    def __init__(self, horizon: float = 5.0) -> None:
        """Looks ``horizon`` [s] back."""
        self._horizon = horizon
        self._times: deque[float] = deque()
        self._lock = threading.Lock()

    def add(self, now: float) -> None:
        """It came now [s]. A clock that was set back begins anew."""
        with self._lock:
            if self._times and now < self._times[-1]:
                self._times.clear()
            self._times.append(now)
            self._forget(now)

    def hertz(self, now: float) -> float:
        """How often it came of late [1/s]; 0 if it came fewer than two times."""
        with self._lock:
            self._forget(now)
            if len(self._times) < 2 or self._times[-1] == self._times[0]:
                return 0.0
            return (len(self._times) - 1) / (self._times[-1] - self._times[0])

    def _forget(self, now: float) -> None:
        while self._times and self._times[0] < now - self._horizon:
            self._times.popleft()
