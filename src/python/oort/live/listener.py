# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Who is told of what happens in a live session."""

import logging
from collections.abc import Callable
from functools import partial
from typing import Any

from oort._core import Saved
from oort.live.snapshot import Drawing, Snapshot


class Listener:
    """What a live session tells; called from its threads, so be quick, and do not call back and wait."""

    def scan_taken(self, snapshot: Snapshot) -> None:
        """A scan was mapped."""

    def call_made(self, snapshot: Snapshot) -> None:
        """A call took effect; its caller is answered when this returns."""

    def places_changed(self, snapshot: Snapshot) -> None:
        """Places came, went or moved, and nothing else of the map changed."""

    def drawn(self, drawing: Drawing) -> None:
        """The map was drawn, or is to be shown again."""

    def saved(self, what: Saved) -> None:
        """Files were written: all of a map, or only its places."""

    def note(self, text: str) -> None:
        """Something that its owner should know."""

    def trouble(self, text: str) -> None:
        """Something went wrong that no caller waits to hear of."""


def guarded(listener: Listener) -> Listener:
    """The same listener, but its errors are logged: they must not end a thread of the session."""
    guard = Listener()
    for name in vars(Listener):
        if not name.startswith("_"):
            setattr(guard, name, partial(_tell, getattr(listener, name)))
    return guard


def _tell(method: Callable[[Any], None], what: Any) -> None:
    try:
        method(what)
    except Exception:
        logging.getLogger(__name__).exception("a listener failed")
