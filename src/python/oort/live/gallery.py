# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the map of a live session beside the mapping, no oftener than it is worth, and keeps the newest drawing."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future

from oort._core import Map, Parameters, render_map
from oort.errors import StateError
from oort.live.listener import Listener
from oort.live.snapshot import Drawing, Snapshot
from oort.live.worker import Worker
from oort.naming import Naming, service

MAP_TIMEOUT = 10.0  # [s] that latest() waits
_INTERVAL = 1.0  # [s] between drawings while mapping
_SHARE = 0.1  # of the time, at most, that drawing may take as the map grows
_LOOK = 0.2  # [s] between looks at what became of a drawing


class Gallery:
    """A thread that draws revisions of the map; each once, unless it is asked for again."""

    def __init__(
        self, parameters: Parameters, listener: Listener, wake: Callable[[], None], naming: Naming = service
    ) -> None:
        """Drawings go to ``listener`` from the drawing thread; ``wake`` makes the mapping thread call tick()."""
        self._naming = naming
        self.parameters = parameters
        """what maps are drawn with"""
        self._listener = listener
        self._wake = wake
        self._thread = Worker("oort-draw")
        self._asked_for = -1  # the newest revision
        self._last: Future[Drawing] | None = None  # its drawing
        self._soon = False  # somebody waits for it
        self._rest_until = 0.0

        self._changed = threading.Condition()
        self._drawing: Drawing | None = None
        self._oldest = 0  # earlier revisions show a map that is gone
        self._failed = -1  # the newest revision that cannot be drawn
        self._why = ""  # it cannot; empty if the last drawing went well

    # ---- for anyone ----

    @property
    def drawing(self) -> Drawing | None:
        """The newest drawing of the map, if there is one."""
        return self._drawing

    def latest(self, revision: int) -> Drawing:
        """A drawing of this revision or a newer one; after 10 s, what there is. Raises StateError if there is none."""
        deadline = time.monotonic() + MAP_TIMEOUT
        with self._changed:
            while self._failed < revision and (self._drawing is None or self._drawing.revision < revision):
                left = deadline - time.monotonic()
                if left <= 0.0:
                    break
                self._soon = True
                self._wake()
                self._changed.wait(min(left, _LOOK))
            self._soon = False
            if self._drawing is not None:
                return self._drawing
            if self._why:
                raise StateError(f"{self._naming('map/map')}: the map cannot be drawn: {self._why}")
        start, load = self._naming("map/start"), self._naming("map/load")
        raise StateError(
            f"{self._naming('map/map')}: there is no map after {MAP_TIMEOUT:.0f} s; call {start} and drive, or {load}"
        )

    # ---- for the mapping thread ----

    def tick(self, snapshot: Snapshot, map_: Callable[[], Map]) -> None:
        """Draws a revision that nobody has asked for yet, if it is time to."""
        is_new = snapshot.num_nodes > 0 and snapshot.revision != self._asked_for
        idle = self._last is None or self._last.done()
        if is_new and idle and (self._soon or time.monotonic() >= self._rest_until):
            self.draw(snapshot.revision, map_())

    def draw(self, revision: int, map_: Map) -> "Future[Drawing]":
        """Draws a revision after those that were asked for before; one that is there already is shown again."""
        if revision != self._asked_for or self._last is None or self._last.done():
            self._asked_for = revision
            self._last = self._thread.submit(self._draw, revision, map_)
        return self._last

    def forget(self, revision: int) -> None:
        """The map was replaced or dropped: what is older than this revision is not shown any more."""
        with self._changed:
            self._drawing = None
            self._oldest = revision
            self._why = ""

    def close(self) -> None:
        """Ends the thread after what was asked for."""
        self._thread.close()

    # ---- the drawing thread ----

    def _draw(self, revision: int, map_: Map) -> Drawing:
        started = time.monotonic()
        try:
            drawing = self._drawing
            if drawing is None or drawing.revision != revision:
                drawing = Drawing(revision, *render_map(map_, self.parameters), map_)
        except Exception as error:
            self._fail(revision, str(error))
            raise
        else:
            self._show(drawing)
            return drawing
        finally:
            now = time.monotonic()
            self._rest_until = now + max(_INTERVAL - (now - started), (now - started) / _SHARE)

    def _show(self, drawing: Drawing) -> None:
        with self._changed:
            self._why = ""
            if drawing.revision < self._oldest:
                return
            self._drawing = drawing
            self._changed.notify_all()
        self._listener.drawn(drawing)

    def _fail(self, revision: int, why: str) -> None:
        with self._changed:
            is_new = not self._why
            self._failed, self._why = revision, why or "no reason is known"
            self._changed.notify_all()
        if is_new:
            self._listener.trouble(f"the map cannot be drawn: {self._why}")
