# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""When the map of a live session is saved, so that little is lost whenever the node ends."""

import time
from collections.abc import Callable
from concurrent.futures import Future

from oort._core import Map, Saved
from oort.errors import MapFileError
from oort.live.claim import Claim
from oort.live.listener import Listener
from oort.live.paths import make_room, set_aside
from oort.live.saver import Saver
from oort.naming import Naming, service
from oort.session import Session, State

AUTOSAVE_INTERVAL = 15.0  # [s]


class Keeper:
    """Sees to it that changes of the map reach the disk, at the latest every 15 s; used by the mapping thread."""

    def __init__(self, listener: Listener, clock: Callable[[], float], naming: Naming = service) -> None:
        """``clock`` [s] is what the interval goes by."""
        self._naming = naming
        self._listener = listener
        self._clock = clock
        self.saver = Saver(listener.saved, self._failed)
        self._unsaved = False  # the map, not only its places; also set by the saving thread
        self._soon = False
        self._next = float("-inf")  # by the clock
        self._next_by_wall = float("-inf")  # a robot's clock may stand still
        self._claim: Claim | None = None

    # ---- hooks of Session ----

    def save(self, path: str, map_: Map, what: Saved) -> "Future[Saved]":
        """Writes a snapshot beside the mapping."""
        if what is Saved.MAP:
            self._unsaved = False
        try:
            self._claim_path(path)
        except MapFileError as error:
            self._unsaved = self._unsaved or what is Saved.MAP
            return self.saver.fail(error)
        return self.saver.save(path, map_, what)

    def prepare(self, call: str, path: str) -> None:
        """Makes a path ready for the map. Raises MapFileError if that cannot be or another map would be lost."""
        call = self._naming(call)
        self.saver.wait()
        make_room(call, path)
        self._claim_path(path)
        copy = set_aside(call, path)
        if copy:
            self._listener.note(f"{call}: there was another map at {path}; it is kept as {copy}")

    def close(self) -> None:
        """Ends after what was asked for."""
        self.saver.close()
        self._give_up_path()

    def _claim_path(self, path: str) -> None:
        if self._claim is None or not self._claim.is_for(path):
            claim = Claim(path)
            self._give_up_path()
            self._claim = claim

    def _give_up_path(self) -> None:
        if self._claim is not None:
            self._claim.release()
            self._claim = None

    # ---- what happens to the map ----

    def changed(self) -> None:
        """There is something to be saved."""
        self._unsaved = True

    def hurry(self) -> None:
        """Saves as soon as there is something, without waiting for the interval to pass."""
        self._soon = True

    def forget(self) -> None:
        """The map was replaced or dropped, and others may save where it was."""
        self._unsaved = False
        self._give_up_path()

    # ---- saving ----

    def tick(self, session: Session) -> None:
        """Saves if it is time to; what failed is tried again then. While paused all rests."""
        if not self._unsaved or session.state is State.PAUSED or not self.saver.idle or not _can_be_saved(session):
            return
        now, wall = self._clock(), time.monotonic()
        was_set_back = now < self._next - AUTOSAVE_INTERVAL
        if now >= self._next or wall >= self._next_by_wall or was_set_back or self._soon:
            self._next, self._next_by_wall = now + AUTOSAVE_INTERVAL, wall + AUTOSAVE_INTERVAL
            self._soon = False
            session.save()

    def save_now(self, session: Session) -> None:
        """Saves what is not saved yet."""
        if self._unsaved:
            session.save()

    def settle(self, session: Session) -> None:
        """Saves what is not saved yet, and waits until it is on the disk. Raises MapFileError if it is not."""
        self.saver.wait()
        self.save_now(session)
        self.saver.wait()
        if self._unsaved and _can_be_saved(session):
            raise MapFileError(
                f"{self._naming('map/load')}: the map in memory would be lost, for it cannot be saved "
                f"({self.saver.error}); correct that, or call {self._naming('map/clear')} first"
            )

    def _failed(self, why: str) -> None:
        self._unsaved = True
        self._listener.trouble(f"the map was not saved: {why}")


def _can_be_saved(session: Session) -> bool:
    return bool(session.path) and session.mapper.num_nodes > 0
