# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A session that keeps up with a robot: a queue, and threads for mapping, drawing and saving."""

import enum
import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any

from oort._core import Map, Parameters, Saved, ScanResult
from oort.errors import InputError, StateError
from oort.events import SCAN, EventLog
from oort.live.drawer import Drawer, Drawing
from oort.live.inbox import CallItem, Inbox, Resolve, ScanItem
from oort.live.saver import Saver, check_absolute, make_room
from oort.live.snapshot import Snapshot, look_at
from oort.live.window import Rate, Window
from oort.locations import Pose
from oort.session import Session, State

AUTOSAVE_INTERVAL = 15.0  # [s] (REQUIREMENTS O-38)
MAP_TIMEOUT = 10.0  # [s] that latest_map() waits (O-33)
REDRAW = "map/republish_maps"
_CREATE = "graph_loc/create"
_BACKWARDS = 1.0  # [s]; a scan that is older than the last one by more says that the clock was set back
_SILENCE = 1.0  # [s] without a scan: none are arriving
_IDLE = 0.2  # [s] between looks at the clock when nothing comes
_CREATE_WAIT = 1.0  # [s] that a place may take if nothing else is in the queue
_CLOSING = 5.0  # [s] for what is ready in the queue when the session is closed
_NEVER = float("-inf")
_TRACKED = ("ok", "degenerate")  # what the scan matcher says of a scan that it could place
_LOST = 20  # scans in a row that it could not place: two seconds


class Tracking(enum.Enum):
    """How well the robot's place is known."""

    IDLE = "idle"
    """nothing is being mapped"""
    TRACKING = "tracking"
    UNCERTAIN = "uncertain"
    """the last scans did not fit what was seen before; odometry tells where they were"""
    LOST = "lost"
    """it has been so for long"""


class Listener:
    """What a live session tells; called from its threads, so be quick, and do not call back and wait."""

    def scan_taken(self, snapshot: Snapshot) -> None:
        """A scan was mapped."""

    def drawn(self, drawing: Drawing) -> None:
        """The map was drawn."""

    def saved(self, what: Saved) -> None:
        """Files were written: all of a map, or only its places."""

    def trouble(self, text: str) -> None:
        """Something went wrong that no caller waits to hear of."""


class LiveSession:
    """A Session with a queue in front. Thread-safe: what only reads never waits for mapping, drawing or saving."""

    def __init__(
        self,
        parameters: Parameters,
        listener: Listener,
        *,
        clock: Callable[[], float] = time.monotonic,
        localiser: Callable[[], Pose | None] = lambda: None,
        event_log: EventLog | None = None,
    ) -> None:
        """Starts the threads.

        ``clock`` [s] is what saving goes by; ``localiser`` tells T_map_sensor while nothing is being mapped, or None.
        """
        self.inbox = Inbox()
        self.saver = Saver(listener.saved, self._on_trouble)
        self.last_result: ScanResult | None = None
        self.scans_arrived = 0
        self.arrivals = Rate()
        self.scans_mapped = 0
        self.drops: Counter[str] = Counter()
        """scans that were not mapped though they should have been, by reason"""
        self.milliseconds = Window()
        """to map a scan"""
        self.delays = Window()
        """[ms] from a scan's arrival until it is mapped and told"""
        self.clock_jumps = 0
        self._misses = 0  # scans in a row that did not fit what was seen before

        self._listener = listener
        self._clock = clock
        self._localiser = localiser
        self._event_log = event_log
        self._session = Session(parameters, save=self._save_beside)
        self._snapshot = Snapshot()
        self._lock = threading.Lock()
        self._requested: Counter[tuple[str, str]] = Counter()  # places whose create waits in the queue
        self._mount: Pose | None = None  # not yet told to the session

        self._saves: list[Future[Saved]] = []  # of the call that is being made
        self._unsaved = False  # the map, not only its places
        self._save_soon = False
        self._next_autosave = _NEVER

        self._drawer = Drawer(parameters, self._on_drawn)
        self._drawing: Drawing | None = None
        self._drawn = threading.Condition()
        self._draw_soon = False
        self._oldest_shown = 0  # drawings of earlier revisions show a map that is gone

        self._last_scan_time = _NEVER
        self._last_arrival = _NEVER
        self._closing = False
        self._worker = threading.Thread(target=self._work, name="oort-map", daemon=True)
        self._worker.start()

    # ---- what comes in ----

    def add_scan(self, resolve: Resolve) -> None:
        """Queues a scan; ``resolve`` makes it once its odometry is known."""
        self.scans_arrived += 1
        self._last_arrival = time.monotonic()
        self.arrivals.add(self._last_arrival)
        self.inbox.add_scan(resolve)

    def mount_sensor(self, sensor_on_base: Pose) -> None:
        """Says where the sensor sits on the base (T_base_sensor), before the first scan can be resolved."""
        self._mount = sensor_on_base

    def call(self, name: str, args: Sequence[Any] = ()) -> Any:
        """Makes a call of Session in its turn; returns when it took effect, was saved and, where it shows, drawn.

        Raises StateError or MapFileError if the call cannot be made or its result not be saved.
        """
        if name in ("map/start", "map/resume") and args:
            make_room(name, args[0])
        elif name == "map/load" and args:
            check_absolute(name, args[0])
        result, consequences = self.inbox.add_call(name, args).result()
        for consequence in consequences:
            consequence.result()
        return result

    def create_location(self, name_space: str, id: str) -> None:
        """Records where the robot is now. While the queue is behind, returns at once: the place is known in its turn.

        Raises StateError if is_ready is false and no scan is on its way either.
        """
        behind = len(self.inbox) > 1
        pose = self._pose_to_create()
        with self._lock:
            self._requested[name_space, id] += 1
        future = self.inbox.add_call(_CREATE, [name_space, id, *([] if pose is None else [pose])])
        try:
            _, saves = future.result(0.0 if behind else _CREATE_WAIT)
        except TimeoutError:
            future.add_done_callback(self._tell_failure)
            return
        for save in saves:
            save.result()

    def redraw(self) -> None:
        """Draws the map again and tells the listener. Raises StateError if there is none."""
        if self._snapshot.num_nodes == 0:
            raise StateError(f"{REDRAW}: there is no map; call map/start and drive, or map/load")
        self.call(REDRAW)

    def close(self) -> None:
        """Maps what is ready, saves the map, and ends the threads."""
        self._closing = True
        self.inbox.wake()
        self._worker.join()
        self.inbox.abandon(StateError("Oort is being shut down"))
        self.saver.close()
        self._drawer.close()

    # ---- what readers see ----

    @property
    def snapshot(self) -> Snapshot:
        """The session between two events."""
        return self._snapshot

    @property
    def tracking(self) -> Tracking:
        """How well the robot's place is known."""
        if self._snapshot.state is not State.MAPPING or self.last_result is None:
            return Tracking.IDLE
        if self._misses == 0:
            return Tracking.TRACKING
        return Tracking.UNCERTAIN if self._misses < _LOST else Tracking.LOST

    @property
    def seconds_without_scan(self) -> float:
        """Since the last scan arrived [s]; inf if none did."""
        return time.monotonic() - self._last_arrival

    @property
    def is_ready(self) -> bool:
        """Whether a place can be created now."""
        snapshot = self._snapshot
        if snapshot.state is State.MAPPING:
            return snapshot.odom_pose is not None
        return snapshot.state is State.NOT_MAPPING and snapshot.num_nodes > 0 and self._localiser() is not None

    @property
    def has_map(self) -> bool:
        """Whether there is a map to show."""
        snapshot = self._snapshot
        return snapshot.num_nodes > 0 and (snapshot.state is State.NOT_MAPPING or self._drawing is not None)

    def locate(self, name_space: str, id: str) -> Pose:
        """Where a place is now in the map frame. Raises StateError if it is not known, or not yet."""
        if self._requested[name_space, id]:
            raise StateError(f"graph_loc/locate: mapping has not reached {name_space!r}/{id!r} yet; ask again later")
        pose = self._snapshot.places.get((name_space, id))
        if pose is None:
            raise StateError(f"graph_loc/locate: no place {name_space!r}/{id!r}; graph_loc/list shows the known ones")
        return pose

    def latest_map(self) -> Drawing:
        """The newest map. Raises StateError if there is none within 10 s."""
        wanted = self._snapshot.revision
        deadline = time.monotonic() + MAP_TIMEOUT
        with self._drawn:
            while self._drawing is None or self._drawing.revision < wanted:
                left = deadline - time.monotonic()
                if left <= 0.0:
                    break
                self._draw_soon = True
                self.inbox.wake()
                self._drawn.wait(min(left, _IDLE))
            if self._drawing is None:
                raise StateError(
                    f"map/map: there is no map after {MAP_TIMEOUT:.0f} s; call map/start and drive, or map/load"
                )
            return self._drawing

    # ---- the mapping thread ----

    def _work(self) -> None:
        deadline = float("inf")
        while time.monotonic() < deadline:
            item = self.inbox.head(self._session.state is State.MAPPING, _IDLE)
            if isinstance(item, ScanItem):
                self._take(item)
                self.inbox.pop()
            elif item is not None:
                self._make(item)
            self._tick()
            if self._closing:
                deadline = _NEVER if item is None else min(deadline, time.monotonic() + _CLOSING)
        if self._unsaved:
            self._session.save()

    def _take(self, item: ScanItem) -> None:
        if self._session.state is not State.MAPPING:
            return
        if item.scan is None:
            self.drops[item.refused] += 1
            return
        started = time.monotonic()
        try:
            self._map(item)
        except Exception as error:  # whatever is wrong with one scan, the mapping goes on
            self.drops["unusable"] += 1
            self._listener.trouble(f"a scan was left out: {error}")
            return
        self.scans_mapped += 1
        self.milliseconds.add(1e3 * (time.monotonic() - started))
        self._listener.scan_taken(self._snapshot)
        self.delays.add(1e3 * (time.monotonic() - item.arrived))

    def _map(self, item: ScanItem) -> None:
        scan = item.scan
        assert scan is not None
        if self._mount is not None:
            self._session.mount_sensor(self._mount)
            self._mount = None
        if scan.time < self._last_scan_time - _BACKWARDS:
            self._interrupt(self._last_scan_time - scan.time)
        self._last_scan_time = scan.time
        self.last_result = self._session.add_scan(scan)
        self._log(scan.time, SCAN, [scan.stamp])
        made_node = self.last_result is not None and self.last_result.outcome == "node"
        if self.last_result is not None and self.last_result.status:
            self._misses = 0 if self.last_result.status in _TRACKED else self._misses + 1
        self._look(made_node)
        self._unsaved = self._unsaved or made_node

    def _interrupt(self, seconds: float) -> None:
        """A bag played again, or a restarted base: what odometry says across it means nothing."""
        self.clock_jumps += 1
        self._listener.trouble(
            f"the scans' clock went back by {seconds:.1f} s: the map goes on with a very uncertain link. If a "
            "recording was begun again, call map/clear and map/start"
        )
        self._session_call("map/pause", ())
        self._session_call("map/resume_from_paused", ())

    def _make(self, item: CallItem) -> None:
        self._saves = []
        before = self._session.state
        try:
            result = None if item.name == REDRAW else self._session_call(item.name, item.args)
        except Exception as error:  # the caller's; the mapping goes on
            self._forget_request(item)
            self.inbox.pop()
            item.result.set_exception(error)
            return
        if item.name in ("map/load", "map/clear"):
            self._forget()
        self._look(True)
        if self._session.state is State.MAPPING and before is State.NOT_MAPPING:
            self._save_soon = True
        consequences: list[Future[Any]] = list(self._saves)
        if item.name in (REDRAW, "map/stop", "map/load", "map/resume") and self._snapshot.num_nodes > 0:
            consequences.append(self._draw())
        self._forget_request(item)
        self.inbox.pop()
        item.result.set_result((result, consequences))

    def _session_call(self, name: str, args: Sequence[Any]) -> Any:
        result = self._session.call(name, args)
        self._log(self._clock(), name, args)
        return result

    def _log(self, t: float, name: str, args: Sequence[Any]) -> None:
        if self._event_log is not None:
            try:
                self._event_log.add(t, name, args)
            except InputError as error:
                self._listener.trouble(str(error))

    def _forget(self) -> None:
        """What there was of the map before a load or clear."""
        self._last_scan_time = _NEVER
        self._unsaved = False
        self.last_result = None
        with self._drawn:
            self._drawing = None
            self._oldest_shown = self._snapshot.revision + 1

    def _look(self, changed: bool) -> None:
        self._snapshot = look_at(self._session, self._snapshot, changed)

    def _tick(self) -> None:
        """Draws and saves if it is time."""
        drawn = self._drawing is not None and self._drawing.revision == self._snapshot.revision
        if self._snapshot.num_nodes > 0 and not drawn and (self._draw_soon or self._drawer.due):
            self._draw_soon = False
            self._draw()
        if self._session.state is not State.MAPPING or not self._unsaved or not self.saver.idle:
            return
        now = self._clock()
        was_set_back = now < self._next_autosave - AUTOSAVE_INTERVAL
        if now >= self._next_autosave or was_set_back or self._save_soon:
            self._next_autosave = now + AUTOSAVE_INTERVAL
            self._save_soon = False
            self._session.save()
            self._saves.clear()

    # ---- drawing and saving ----

    def _draw(self) -> "Future[Drawing]":
        return self._drawer.draw(self._snapshot.revision, self._session.map, self._snapshot.places)

    def _on_drawn(self, drawing: Drawing) -> None:
        with self._drawn:
            if drawing.revision < self._oldest_shown:
                return
            self._drawing = drawing
            self._drawn.notify_all()
        self._listener.drawn(drawing)

    def _save_beside(self, path: str, map_: Map, what: Saved) -> None:
        """How the session's maps reach the disk."""
        if what is Saved.MAP:
            self._unsaved = False
        self._saves.append(self.saver.save(path, map_, what))

    def _on_trouble(self, text: str) -> None:
        self._unsaved = True  # what was not saved is tried again
        self._listener.trouble(text)

    # ---- places that wait for their turn ----

    def _pose_to_create(self) -> Pose | None:
        """T_map_sensor for a place that is created now; None: mapping will know. Raises StateError."""
        snapshot = self._snapshot
        if snapshot.state is State.MAPPING:
            if snapshot.odom_pose is None and self.seconds_without_scan > _SILENCE:
                raise StateError(
                    "graph_loc/create: no scan has been mapped and none is arriving, so the robot's place is not "
                    "known; check the scan topic"
                )
            return None
        if snapshot.state is State.PAUSED:
            raise StateError("graph_loc/create: mapping is paused; call map/resume_from_paused first")
        if snapshot.num_nodes == 0:
            raise StateError("graph_loc/create: there is no map; call map/start or map/load first")
        pose = self._localiser()
        if pose is None:
            raise StateError(
                "graph_loc/create: nothing is being mapped, and there is no fresh transform from map to sensor; "
                "start a localiser and wait until graph_loc/is_ready is true"
            )
        return pose

    def _forget_request(self, item: CallItem) -> None:
        if item.name == _CREATE:
            place = (item.args[0], item.args[1])
            with self._lock:
                self._requested[place] -= 1
                if not self._requested[place]:
                    del self._requested[place]

    def _tell_failure(self, future: "Future[Any]") -> None:
        error = future.exception()
        if error is not None:
            self._listener.trouble(f"graph_loc/create: {error}")
