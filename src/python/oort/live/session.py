# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A session that keeps up with a robot: a queue, and threads for mapping, drawing and saving."""

import atexit
import logging
import math
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, wait
from typing import Any, TypeVar

from oort import history
from oort._core import Map, Parameters, Saved, ScanOutcome, ScanResult
from oort.diagnosis import Trouble
from oort.errors import StateError
from oort.events import SCAN, EventLog, scan_entry
from oort.live.figures import Figures
from oort.live.gallery import Gallery
from oort.live.inbox import UNUSABLE, Answer, CallItem, Inbox, Resolve, ScanItem
from oort.live.keeper import Keeper
from oort.live.listener import Listener, guarded
from oort.live.paths import check_absolute
from oort.live.places import Places
from oort.live.snapshot import Snapshot, glance, look_at
from oort.locations import Pose
from oort.naming import Naming, service
from oort.recording import Scan
from oort.session import Session, State

_START, _RESUME, _STOP, _LOAD, _CLEAR = "map/start", "map/resume", "map/stop", "map/load", "map/clear"
_REJECT = "map/reject"
_DOCKED, _REDRAW, _CREATE = "map/notify_docked", "map/republish_maps", "graph_loc/create"
_WORK = "(work)"  # not a call of Session, and in no log
_CHANGE_MAP = (_LOAD, _CLEAR, _REJECT, _DOCKED, _STOP)
_SHOW_MAP = (_LOAD, _RESUME, _REJECT, _STOP, _REDRAW)

_BACKWARDS = 1.0  # [s]; a scan that is older than the last one by more says that the clock was set back
_LOOK_EVERY = 100  # scans, between looks for what is wrong with the setup
_IDLE = 0.2  # [s] between looks at the clock when nothing comes
_CLOSING = 5.0  # [s] for what is ready in the queue when the session is closed

_Result = TypeVar("_Result")


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
        naming: Naming = service,
        draws: bool = True,
    ) -> None:
        """Starts the threads.

        ``clock`` [s] is what saving goes by; ``localiser`` tells T_map_sensor while nothing is being mapped, or None.
        ``naming`` is how messages name the calls; ``draws``: whether the map is drawn when it changes.
        """
        self._naming = naming
        self.draws = draws
        """whether the map is drawn when it changes"""
        self._listener = guarded(listener)
        self.inbox = Inbox()
        self.figures = Figures()
        self.gallery = Gallery(parameters, self._listener, self.inbox.wake, naming)
        self.keeper = Keeper(self._listener, clock, naming)
        self.places = Places(self.inbox, self.figures, self._listener, lambda: self._snapshot, localiser, naming)

        self.troubles: Sequence[Trouble] = ()
        """what mapping shows to be wrong with the robot's setup; replaced now and then, never changed"""
        self._observed = 0

        self._clock = clock
        self._event_log = event_log
        self._session = Session(parameters, save=self._save, prepare=self.keeper.prepare, naming=naming)
        self._snapshot = Snapshot()
        self._mount: Pose | None = None  # not yet told to the session
        self._saves: list[Future[Saved]] = []  # of the call that is being made
        self._docking: Future[bool] | None = None  # until it is known what came of the last notify_docked
        self._reported_frame: Pose | None = None  # seen from the frame of the latest scan's odometry
        self._last_scan_time = -math.inf
        self._closing = False
        self.failure = ""
        """why mapping ended that nobody ended: a fault of Oort's own, or memory that is used up; empty if it goes on"""
        self._worker = threading.Thread(target=self._run, name="oort-map", daemon=True)
        self._worker.start()
        atexit.register(self.close)  # a program may end without: its map is saved all the same

    # ---- for any thread ----

    @property
    def snapshot(self) -> Snapshot:
        """The session between two events."""
        return self._snapshot

    @property
    def sensor_on_base(self) -> Pose:
        """T_base_sensor."""
        return self._mount or self._session.sensor_on_base

    @property
    def has_map(self) -> bool:
        """Whether there is a map to show."""
        snapshot = self._snapshot
        return snapshot.num_nodes > 0 and (snapshot.state is State.NOT_MAPPING or self.gallery.drawing is not None)

    def add_scan(self, resolve: Resolve, last_resort: Resolve | None = None) -> None:
        """Queues a scan; ``resolve`` makes it once its odometry is known, ``last_resort`` when none comes any more."""
        self.figures.arrived()
        self.inbox.add_scan(resolve, last_resort)

    def mount_sensor(self, sensor_on_base: Pose) -> None:
        """Says where the sensor sits on the base (T_base_sensor), before the first scan can be resolved."""
        self._mount = sensor_on_base

    def call(self, name: str, args: Sequence[Any] = ()) -> Any:
        """Makes a call of Session in its turn; returns when it took effect, was saved and, where it shows, drawn.

        notify_docked waits on, while scans come, until it is known whether what is seen fits the dock; None if that is
        not known when scans stop. Raises StateError or MapFileError if the call cannot be made or its result not be
        saved.
        """
        if name in (_START, _RESUME, _LOAD) and args:
            check_absolute(self._naming(name), args[0])
        answer = self.inbox.add_call(name, args).result()
        if answer.drawing is not None:
            wait([answer.drawing])
        for save in answer.saves:
            save.result()
        return self._await(answer.result) if isinstance(answer.result, Future) else answer.result

    def _await(self, docking: "Future[bool]") -> bool | None:
        """What came of looking for the dock: scans go on meanwhile, and without them so does nothing."""
        while not wait([docking], _IDLE).done:
            silent = len(self.inbox) == 0 and not self.figures.scans_arrive
            if silent or self._closing or self._snapshot.state is not State.MAPPING:
                return docking.result() if docking.done() else None
        return docking.result()

    def run(self, work: Callable[[Session], _Result]) -> _Result:
        """Does something with the session that changes no map, in its turn; returns when what it saved is on the disk.

        Raises MapFileError if its result cannot be saved.
        """
        result: _Result = self.call(_WORK, [work])
        return result

    def restore(self, number: int) -> None:
        """Makes an earlier version of the map (oort.history) the map again, and loads it.

        Raises StateError while a map is being made or where none is saved, InputError if there is no such version,
        MapFileError if it cannot be read or written.
        """

        def go_back(session: Session) -> str:
            if session.state is not State.NOT_MAPPING:
                raise StateError(f"map/restore: the state is {session.state.value}; call {self._naming(_STOP)} first")
            if not session.path:
                raise StateError(f"map/restore: the map has no path; call {self._naming(_LOAD)} first")
            self.keeper.settle(session)
            history.restore(session.path, number)
            return session.path

        self.call(_LOAD, [self.run(go_back)])

    def redraw(self) -> None:
        """Shows the listener the map again. Raises StateError if there is none."""
        drawing = self.inbox.add_call(_REDRAW, ()).result().drawing
        if drawing is None:
            raise StateError(
                f"{self._naming(_REDRAW)}: there is no map; call {self._naming(_START)} and drive, or "
                f"{self._naming(_LOAD)}"
            )
        drawing.result()

    def close(self) -> None:
        """Maps what is ready, saves the map, and ends the threads."""
        atexit.unregister(self.close)
        self._closing = True
        self.inbox.wake()
        self._worker.join()
        self.inbox.close(StateError("Oort is being shut down"))
        self.keeper.close()
        self.gallery.close()

    # ---- the mapping thread ----

    def _run(self) -> None:
        """Nobody must wait for a thread that is gone: who does hears why, and calls to come are refused."""
        try:
            self._work()
        except Exception as error:
            logging.getLogger("oort").debug("mapping ended", exc_info=True)
            self.failure = f"mapping ended by a fault of Oort's own ({type(error).__name__}: {error})"
            self._listener.trouble(self.failure)
            self.inbox.close(StateError(self.failure))
            if self._docking is not None:
                self._docking.set_exception(StateError(self.failure))

    def _work(self) -> None:
        deadline = math.inf
        while time.monotonic() < deadline:
            item = self.inbox.head(self._session.state is State.MAPPING, _IDLE)
            if isinstance(item, ScanItem):
                self._take(item)
                self.inbox.pop()
            elif item is not None:
                self._make(item)
            self.keeper.tick(self._session)
            if self.draws:
                self.gallery.tick(self._snapshot, lambda: self._session.map)
            if self._closing:
                deadline = -math.inf if item is None else min(deadline, time.monotonic() + _CLOSING)
        self.keeper.save_now(self._session)

    def _take(self, item: ScanItem) -> None:
        if self._session.state is not State.MAPPING:
            self.figures.scans_while_paused += self._session.state is State.PAUSED
            return
        if item.scan is None:
            self._leave_out(item.refused, item.why)
            return
        started = time.monotonic()
        try:
            result = self._map(item.scan)
        except Exception as error:  # the mapping goes on
            self._leave_out(UNUSABLE, str(error) or repr(error))
            return
        if item.scan.mount is not None:  # it joins the main laser's next
            return
        self._look_at_dock()
        self.figures.mapped(result, time.monotonic() - started, item.scan)
        self._listener.scan_taken(self._snapshot)
        self.figures.delays.add(1e3 * (time.monotonic() - item.arrived))
        self._look_for_troubles(item.scan)

    def _look_for_troubles(self, scan: Scan) -> None:
        self._session.observe(scan)
        self._observed += 1
        if self._observed % _LOOK_EVERY == 0:
            known = {trouble.code for trouble in self.troubles}
            self.troubles = tuple(self._session.troubles())
            for trouble in self.troubles:
                if trouble.code not in known:
                    self._listener.trouble(str(trouble))

    def _leave_out(self, reason: str, why: str) -> None:
        told = self.figures.drops.add(reason, why)
        if told:
            self._listener.trouble(told)

    def _map(self, scan: Scan) -> ScanResult | None:
        if self._mount is not None:
            self._session.mount_sensor(self._mount)
            self._mount = None
        if scan.time < self._last_scan_time - _BACKWARDS:
            self._interrupt(self._last_scan_time - scan.time)
        self._last_scan_time = scan.time
        result = self._session.add_scan(scan)
        self.figures.last_stamp = scan.stamp
        self._reported_frame = scan.reported_frame
        self._log(scan.time, SCAN, scan_entry(scan))
        if result is not None and (result.outcome is ScanOutcome.NODE or result.corrected):
            self.keeper.changed()
            self._snapshot = look_at(self._session, self._snapshot, self._reported_frame, map_changed=True)
        else:
            self._snapshot = glance(self._session, self._snapshot, self._reported_frame)
        return result

    def _interrupt(self, seconds: float) -> None:
        """A bag played again, or a restarted base: what odometry says across it means nothing."""
        self.figures.clock_jumps += 1
        self._listener.trouble(
            f"the scans' clock went back by {seconds:.1f} s: the map goes on with a very uncertain link. If a "
            f"recording was begun again, call {self._naming(_CLEAR)} and {self._naming(_START)}"
        )
        self._call("map/pause", ())
        self._call("map/resume_from_paused", ())

    def _make(self, item: CallItem) -> None:
        try:
            answer = self._answer(item.name, item.args)
        except Exception as error:  # the caller's; the mapping goes on
            self.inbox.pop()
            item.result.set_exception(error)
            return
        self.inbox.pop()
        item.result.set_result(answer)

    def _answer(self, name: str, args: Sequence[Any]) -> Answer:
        before = self._snapshot
        if name == _LOAD:
            self.keeper.settle(self._session)
        self._saves = []
        result = self._result(name, args)
        was_pruned = self._session.mapper.num_nodes < before.num_nodes
        changed = name in _CHANGE_MAP or was_pruned
        self._snapshot = look_at(self._session, before, self._reported_frame, map_changed=changed)
        saves, self._saves = self._saves, []
        self._follow_up(name, before)
        self._listener.call_made(self._snapshot)
        drawing = None
        if self.draws and name in _SHOW_MAP and self._snapshot.num_nodes > 0:
            drawing = self.gallery.draw(self._snapshot.revision, self._session.map)
        return Answer(result, saves, drawing)

    def _result(self, name: str, args: Sequence[Any]) -> Any:
        if name == _REDRAW:
            return None
        if name == _WORK:
            return args[0](self._session)
        result = self._call(name, args)
        if name == _DOCKED:
            self._docking = result = self._docking or Future()
        self._look_at_dock(forgotten=name in (_LOAD, _CLEAR, _REJECT))
        return result

    def _look_at_dock(self, forgotten: bool = False) -> None:
        """Tells who waits for it what came of notify_docked; ``forgotten``: nothing will."""
        if self._docking is None:
            return
        found = self._session.mapper.dock_closure_found
        if found is None and not forgotten:
            return
        if found is False:
            self._listener.trouble(f"{self._naming(_DOCKED)}: nothing was linked: what is seen does not fit the dock")
        self._docking.set_result(bool(found))
        self._docking = None

    def _follow_up(self, name: str, before: Snapshot) -> None:
        """What a call means beyond the session itself."""
        if name in (_LOAD, _CLEAR, _REJECT):
            self.keeper.forget()
            self.figures.forget()
            self.troubles = ()
            self.gallery.forget(self._snapshot.revision)
        if name in (_START, _RESUME):
            self.keeper.hurry()
        if name in (_START, _DOCKED):
            self.keeper.changed()
        if name == _STOP and before.waiting:
            places = ", ".join(f"{space!r}/{id!r}" for space, id in sorted(before.waiting))
            self._listener.trouble(
                f"{self._naming(_CREATE)}: no scan came before {self._naming(_STOP)}, so {places} has no pose"
            )
        change = before.state, self._snapshot.state
        if change == (State.NOT_MAPPING, State.MAPPING):
            self._last_scan_time = -math.inf
        if change == (State.MAPPING, State.PAUSED):
            self.keeper.save_now(self._session)
        if name not in _CHANGE_MAP and self._snapshot.places != before.places:
            self._listener.places_changed(self._snapshot)

    def _call(self, name: str, args: Sequence[Any]) -> Any:
        result = self._session.call(name, args)
        self._log(self._clock(), name, args)
        return result

    def _log(self, t: float, name: str, args: Sequence[Any]) -> None:
        try:
            if self._event_log is not None:
                self._event_log.add(t, name, args)
        except Exception as error:
            self._listener.trouble(f"the events log lacks {name}: {error}")

    def _save(self, path: str, map_: Map, what: Saved) -> None:
        """How the session's maps reach the disk."""
        self._saves.append(self.keeper.save(path, map_, what))
