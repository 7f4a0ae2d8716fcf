# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Places that are made while the queue may be behind."""

import threading
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future, wait

from oort.errors import StateError
from oort.live.figures import Figures
from oort.live.inbox import Answer, Inbox
from oort.live.listener import Listener
from oort.live.snapshot import Snapshot
from oort.locations import Pose
from oort.naming import Naming, service
from oort.session import State

_CREATE = "graph_loc/create"
_PATIENCE = 1.0  # [s] that a place may take if nothing else is in the queue


class Places:
    """Creates and locates places. Thread-safe."""

    def __init__(
        self,
        inbox: Inbox,
        figures: Figures,
        listener: Listener,
        snapshot: Callable[[], Snapshot],
        localiser: Callable[[], Pose | None],
        naming: Naming = service,
    ) -> None:
        """Reads the session as it is now by ``snapshot``, and T_map_sensor while nothing is mapped by ``localiser``."""
        self._naming = naming
        self._inbox = inbox
        self._figures = figures
        self._listener = listener
        self._snapshot = snapshot
        self._localiser = localiser
        self._lock = threading.Lock()
        self._requested: Counter[tuple[str, str]] = Counter()  # places whose create waits in the queue

    @property
    def is_ready(self) -> bool:
        """Whether a place can be created now."""
        snapshot = self._snapshot()
        if snapshot.state is State.MAPPING:
            return snapshot.odom_pose is not None
        return snapshot.state is State.NOT_MAPPING and snapshot.num_nodes > 0 and self._localiser() is not None

    def create(self, name_space: str, id: str) -> None:
        """Records where the robot is now. While the queue is behind, returns at once: the place is known in its turn.

        Raises StateError if is_ready is false and no scan is on its way either.
        """
        behind = len(self._inbox) > 1
        pose = self._pose()
        place = name_space, id
        with self._lock:
            self._requested[place] += 1
        future = self._inbox.add_call(_CREATE, [name_space, id, *([] if pose is None else [pose])])
        wait([future], 0.0 if behind else _PATIENCE)
        if not future.done():
            future.add_done_callback(lambda done: self._made_late(place, done))
            return
        self._forget_request(place)
        for save in future.result().saves:
            save.result()

    def locate(self, name_space: str, id: str) -> Pose:
        """Where a place is now in the map frame. Raises StateError if it is not known, or not yet."""
        locate = self._naming("graph_loc/locate")
        place = name_space, id
        snapshot = self._snapshot()
        if self._requested[place] or place in snapshot.waiting:
            raise StateError(f"{locate}: mapping has not reached {name_space!r}/{id!r} yet; ask again later")
        if place not in snapshot.places:
            shows = self._naming("graph_loc/list")
            raise StateError(f"{locate}: no place {name_space!r}/{id!r}; {shows} shows the known ones")
        return snapshot.places[place]

    def here(self, call: str) -> Pose:
        """T_map_sensor as a localiser tells it. Raises StateError, naming the call that needs it, if none does."""
        pose = self._localiser()
        if pose is None:
            raise StateError(
                f"{call}: nothing is being mapped, and there is no fresh transform from map to sensor; start a "
                f"localiser and wait until {self._naming('graph_loc/is_ready')} is true"
            )
        x, y, theta = map(float, pose)  # what goes into the events log
        return x, y, theta

    def _pose(self) -> Pose | None:
        """T_map_sensor for a place that is created now; None: mapping will know. Raises StateError."""
        create = self._naming(_CREATE)
        snapshot = self._snapshot()
        if snapshot.state is State.MAPPING:
            if snapshot.odom_pose is None and not self._figures.scans_arrive:
                raise StateError(
                    f"{create}: no scan has been mapped and none is arriving, so the robot's place is not known; "
                    "check the scan topic"
                )
            return None
        if snapshot.state is State.PAUSED:
            raise StateError(f"{create}: mapping is paused; call {self._naming('map/resume_from_paused')} first")
        if snapshot.num_nodes == 0:
            start, load = self._naming("map/start"), self._naming("map/load")
            raise StateError(f"{create}: there is no map; call {start} or {load} first")
        return self.here(create)

    def _made_late(self, place: tuple[str, str], future: "Future[Answer]") -> None:
        self._forget_request(place)
        error = future.exception()
        if error is not None:
            self._listener.trouble(str(error))

    def _forget_request(self, place: tuple[str, str]) -> None:
        with self._lock:
            self._requested[place] -= 1
            if not self._requested[place]:
                del self._requested[place]
