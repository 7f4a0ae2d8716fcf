# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Saves the map of a live session beside the mapping."""

import time
from collections.abc import Callable
from concurrent.futures import Future, wait

from oort._core import Map, Saved
from oort.errors import MapFileError
from oort.live.worker import Worker
from oort.session import save

NAMES = {Saved.MAP: "map", Saved.METADATA: "meta"}
"""What the node's ~file_changed says of what was written."""


class Saver:
    """A thread that writes maps one after another, so that the last one asked for is what stays."""

    def __init__(self, saved: Callable[[Saved], None], failed: Callable[[str], None]) -> None:
        """``saved`` and ``failed`` hear of each save from the saving thread."""
        self._tell_saved = saved
        self._tell_failed = failed
        self._thread = Worker("oort-save")
        self._last: Future[Saved] | None = None
        self.error = ""
        """why the last save failed; empty if it did not"""
        self.last_saved = ""
        """"map", or "meta" where only the places were written; empty if nothing was"""
        self._saved_at: float | None = None

    @property
    def idle(self) -> bool:
        """Whether nothing is being written."""
        return self._last is None or self._last.done()

    @property
    def seconds_since_save(self) -> float | None:
        """Since files were written last [s]; None if none were."""
        return None if self._saved_at is None else time.monotonic() - self._saved_at

    def wait(self) -> None:
        """Returns when nothing is being written."""
        if self._last is not None:
            wait([self._last])

    def save(self, path: str, map_: Map, what: Saved) -> "Future[Saved]":
        """Writes a snapshot when those before it are written; the result, or MapFileError."""
        self._last = self._thread.submit(self._save, path, map_, what)
        return self._last

    def fail(self, error: MapFileError) -> "Future[Saved]":
        """A save that cannot even begin."""
        self.error = str(error)
        self._tell_failed(self.error)
        failed: Future[Saved] = Future()
        failed.set_exception(error)
        return failed

    def close(self) -> None:
        """Ends the thread after what was asked for."""
        self._thread.close()

    def _save(self, path: str, map_: Map, what: Saved) -> Saved:
        try:
            written = save(path, map_, what)
        except Exception as error:
            self.error = str(error) or repr(error)
            self._tell_failed(self.error)
            raise
        self.error, self.last_saved, self._saved_at = "", NAMES[written], time.monotonic()
        self._tell_saved(written)
        return written
