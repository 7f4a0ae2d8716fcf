# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the map of a live session beside the mapping, no oftener than it is worth."""

import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

from oort._core import Map, OccupancyGrid, Parameters, render_map
from oort.locations import Pose

_INTERVAL = 1.0  # [s] between drawings while mapping
_SHARE = 0.1  # of the time, at most, that drawing may take as the map grows


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A map as it was at one moment."""

    revision: int
    """counts up with every change of the map"""
    grid: OccupancyGrid
    cleaned: OccupancyGrid
    """without speckle noise"""
    map: Map
    places: Mapping[tuple[str, str], Pose]


class Drawer:
    """A thread that draws snapshots and hands them on."""

    def __init__(self, parameters: Parameters, done: Callable[[Drawing], None]) -> None:
        """``done`` is called from the drawing thread."""
        self._parameters = parameters
        self._done = done
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="oort-draw")
        self._busy_until = 0.0
        self._last: Future[Drawing] | None = None

    @property
    def due(self) -> bool:
        """Whether the next drawing while mapping may begin."""
        return time.monotonic() >= self._busy_until and (self._last is None or self._last.done())

    def draw(self, revision: int, map_: Map, places: Mapping[tuple[str, str], Pose]) -> "Future[Drawing]":
        """Draws a snapshot, after those that were asked for before."""
        self._last = self._thread.submit(self._draw, revision, map_, places)
        return self._last

    def close(self) -> None:
        """Ends the thread after what was asked for."""
        self._thread.shutdown()

    def _draw(self, revision: int, map_: Map, places: Mapping[tuple[str, str], Pose]) -> Drawing:
        started = time.monotonic()
        drawing = Drawing(revision, *render_map(map_, self._parameters), map_, places)
        self._done(drawing)
        now = time.monotonic()
        self._busy_until = now + max(_INTERVAL - (now - started), (now - started) / _SHARE)
        return drawing
