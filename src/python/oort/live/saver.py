# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Saves the map of a live session beside the mapping."""

import os
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from oort._core import Map, Saved, normalise_map_path
from oort.errors import MapFileError, StateError
from oort.session import save

NAMES = {Saved.MAP: "map", Saved.METADATA: "meta"}
"""What the node's ~file_changed says of what was written."""


class Saver:
    """A thread that writes maps one after another, so that the last one asked for is what stays."""

    def __init__(self, saved: Callable[[Saved], None], trouble: Callable[[str], None]) -> None:
        """``saved`` and ``trouble`` are called from the saving thread."""
        self._tell_saved = saved
        self._tell_trouble = trouble
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="oort-save")
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

    def save(self, path: str, map_: Map, what: Saved) -> "Future[Saved]":
        """Writes a snapshot when those before it are written; the result, or MapFileError."""
        self._last = self._thread.submit(self._save, path, map_, what)
        return self._last

    def close(self) -> None:
        """Ends the thread after what was asked for."""
        self._thread.shutdown()

    def _save(self, path: str, map_: Map, what: Saved) -> Saved:
        try:
            written = save(path, map_, what)
        except MapFileError as error:
            self.error = str(error)
            self._tell_trouble(f"the map was not saved: {error}")
            raise
        self.error, self.last_saved, self._saved_at = "", NAMES[written], time.monotonic()
        self._tell_saved(written)
        return written


def check_absolute(call: str, path: Any) -> None:
    """Raises StateError for a relative path: nobody knows what a node's paths would be relative to."""
    if isinstance(path, str) and path and not os.path.isabs(path):
        raise StateError(f"{call}: the path {path!r} is not absolute; give the whole path, such as /home/me/map")


def make_room(call: str, path: Any) -> None:
    """Makes the folder that a map will be saved into. Raises MapFileError now rather than after the drive."""
    check_absolute(call, path)
    if not isinstance(path, str) or not path:
        return
    folder = Path(normalise_map_path(path)).parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MapFileError(f"{call}: the folder {folder} cannot be made: {error.strerror}") from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise MapFileError(f"{call}: the folder {folder} cannot be written to; choose another path")
