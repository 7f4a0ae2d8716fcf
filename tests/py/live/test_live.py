# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A live session without ROS: the queue, the waiting, what readers see, and what must not end its threads."""

import math
import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from helpers.live_rig import Recorder, drive, driven, until
from helpers.scenes import room_scan
from oort import InputError, MapFileError, Parameters, StateError, load_map
from oort._core import Saved
from oort.events import EventLog, read_events
from oort.live import Drawing, LiveSession, Snapshot, UnusableScanError
from oort.live.figures import Drops, Figures, Tracking
from oort.live.inbox import CallItem, Inbox, ScanItem
from oort.recording import Scan
from oort.session import State


def test_stop_waits_for_the_queue(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    path = str(tmp_path / "new" / "map")
    live.call("map/start", [path])
    drive(live, 200)
    live.call("map/stop")
    assert len(live.inbox) == 0
    assert len(recorder.poses) == 200
    assert not live.figures.drops.counts
    assert live.snapshot.state is State.NOT_MAPPING
    assert live.snapshot.odom_pose is None
    assert recorder.saves[-1] is Saved.MAP
    assert len(load_map(path)) == live.snapshot.num_nodes == len(recorder.drawings[-1].map)
    assert live.gallery.latest(live.snapshot.revision) is recorder.drawings[-1]


def test_scans_wait_for_their_odometry(live: LiveSession, recorder: Recorder) -> None:
    known: list[Scan] = []
    live.call("map/start", [""])
    scans = [room_scan(0.02 * i, 0.0, 0.0, 0.1 * i) for i in range(20)]
    for scan in scans:
        live.add_scan(lambda scan=scan: scan if scan in known else None)  # type: ignore[misc]
    assert live.inbox.waiting()[0] == 20
    time.sleep(0.1)
    assert not recorder.poses
    known.extend(scans)
    live.inbox.poke()
    until(lambda: len(recorder.poses) == 20)
    assert not live.figures.drops.counts


def test_the_delay_ends_when_the_pose_is_told(live: LiveSession, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not when it has been looked whether anything is wrong, every so many scans."""
    monkeypatch.setattr(live, "_look_for_troubles", lambda _: time.sleep(0.3))
    live.call("map/start", [""])
    driven(live, 2)  # the second waits for the first
    spread = live.figures.delays.spread
    assert spread is not None and spread.p50 < 250.0


def test_a_call_does_not_wait_for_ever_on_odometry(live: LiveSession, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("oort.live.inbox.PATIENCE_BEFORE_CALL", 0.2)
    live.call("map/start", [""])
    for _ in range(5):
        live.add_scan(lambda: None)
    live.call("map/stop")
    assert live.figures.drops.counts == {"no odometry at its stamp": 5}


def test_scans_that_cannot_be_used_are_counted_by_reason(live: LiveSession, recorder: Recorder) -> None:
    def refuse() -> Scan | None:
        raise UnusableScanError("older than the odometry")

    live.call("map/start", [""])
    live.add_scan(refuse)
    bad = replace(room_scan(0, 0, 0, 0.0), angle_increment=float("nan"))
    live.add_scan(lambda: bad)
    live.call("map/stop")
    assert live.figures.drops.counts == {"older than the odometry": 1, "unusable": 1}
    assert "left out" in recorder.troubles[0]


def test_scans_without_odometry_do_not_hold_up_the_start(live: LiveSession) -> None:
    for _ in range(5):
        live.add_scan(lambda: None)
    started = time.monotonic()
    live.call("map/start", [""])
    assert time.monotonic() - started < 1.0


def test_errors_of_calls(live: LiveSession, tmp_path: Path) -> None:
    for name, args, message in (
        ("map/start", ["relative/map"], "not absolute"),
        ("map/load", ["relative/map"], "not absolute"),
        ("map/load", [str(tmp_path / "none")], "none"),
        ("map/resume", [str(tmp_path / "x"), [0, 0, 0]], "map/load first"),
        ("map/pause", [], "map/start first"),
        ("map/resume_from_paused", [], "map/start first"),
        ("map/notify_docked", [], "needs mapping"),
    ):
        with pytest.raises((StateError, MapFileError), match=message):
            live.call(name, args)
    (tmp_path / "file").touch()
    with pytest.raises(MapFileError, match="cannot be made"):
        live.call("map/start", [str(tmp_path / "file" / "map")])
    with pytest.raises(StateError, match="no map"):
        live.redraw()
    assert live.snapshot.state is State.NOT_MAPPING


def test_a_failed_load_keeps_the_map(live: LiveSession, tmp_path: Path) -> None:
    live.call("map/start", [str(tmp_path / "map")])
    drive(live)
    live.call("map/stop")
    nodes = live.snapshot.num_nodes
    with pytest.raises(MapFileError):
        live.call("map/load", [str(tmp_path / "none")])
    assert live.snapshot.num_nodes == nodes
    assert live.has_map


def test_a_clock_that_is_set_back_makes_a_loose_link(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    drive(live, 30, start=100.0)
    drive(live, 30, start=0.0)
    live.call("map/stop")
    assert "went back by 102.9 s" in recorder.troubles[0]
    assert live.figures.clock_jumps == 1
    assert len(recorder.poses) == 60


def test_the_log_replays(recorder: Recorder, tmp_path: Path) -> None:
    log = EventLog(tmp_path / "events.json")
    live = LiveSession(Parameters(), recorder, event_log=log)
    live.call("map/start", [""])
    drive(live, 3)
    live.places.create("a", "b")
    with pytest.raises(StateError):
        live.call("map/load", ["relative"])
    live.call("map/stop")
    live.close()
    events = read_events(tmp_path / "events.json")
    assert [event.call for event in events] == ["map/start", "scan", "scan", "scan", "graph_loc/create", "map/stop"]
    assert events[1].args == ["0.000000"]


def test_inbox_is_in_order_and_counts_the_head() -> None:
    inbox = Inbox()
    scan = room_scan(0, 0, 0, 0.0)
    inbox.add_scan(lambda: scan)
    inbox.add_call("map/stop", [])
    assert isinstance(inbox.head(True, 0.0), ScanItem)
    assert len(inbox) == 2
    inbox.pop()
    assert isinstance(inbox.head(True, 0.0), CallItem)
    inbox.pop()
    assert inbox.head(True, 0.0) is None


def test_a_scan_that_cannot_be_made_holds_up_no_other(live: LiveSession, recorder: Recorder) -> None:
    ready = threading.Event()

    def tilted() -> Scan | None:
        if ready.is_set():
            raise InputError("the laser is tilted by 12 degrees")
        return None

    scans = [room_scan(0.01 * i, 0.0, 0.0, 0.1 * i) for i in range(5)]
    live.call("map/start", [""])
    live.add_scan(tilted)
    for scan in scans:
        live.add_scan(lambda scan=scan: scan if ready.is_set() else None)  # type: ignore[misc]
    ready.set()
    live.inbox.poke()
    live.add_scan(tilted)
    until(lambda: len(live.inbox) == 0, 1.0)
    assert len(recorder.poses) == 5
    assert live.figures.drops.counts == {"unusable": 2}
    assert recorder.troubles == ["a scan was left out: the laser is tilted by 12 degrees"]


def test_a_listener_that_fails_ends_nothing(tmp_path: Path) -> None:
    class Broken(Recorder):
        def scan_taken(self, snapshot: Snapshot) -> None:
            raise RuntimeError("no")

        def call_made(self, snapshot: Snapshot) -> None:
            raise RuntimeError("no")

        def drawn(self, drawing: Drawing) -> None:
            raise RuntimeError("no")

        def saved(self, what: Saved) -> None:
            raise RuntimeError("no")

        def trouble(self, text: str) -> None:
            raise RuntimeError("no")

    live = LiveSession(Parameters(), Broken())
    live.call("map/start", [str(tmp_path / "map")])
    live.add_scan(lambda: replace(room_scan(0, 0, 0, 0.0), angle_increment=float("nan")))
    drive(live)
    live.call("map/stop")
    live.redraw()
    assert live.figures.scans_mapped == 60
    assert not live.keeper.saver.error
    assert len(load_map(str(tmp_path / "map"))) == live.snapshot.num_nodes > 0
    live.close()


def test_a_log_that_fails_is_told_and_ends_nothing(recorder: Recorder) -> None:
    class Broken(EventLog):
        def __init__(self) -> None: ...

        def add(self, t: float, call: str, args: Any) -> None:
            raise TypeError("not to be written")

    live = LiveSession(Parameters(), recorder, event_log=Broken())
    live.call("map/start", [""])
    driven(live, 3)
    assert live.figures.scans_mapped == 3
    assert recorder.troubles[0] == "the events log lacks map/start: not to be written"
    live.close()


def test_calls_after_the_end_fail_at_once(live: LiveSession) -> None:
    live.close()
    for call in (lambda: live.call("map/stop"), live.redraw):
        with pytest.raises(StateError, match="being shut down"):
            call()
    live.add_scan(lambda: None)
    assert len(live.inbox) == 0


def test_the_caller_of_stop_hears_of_it_after_the_listener(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    drive(live)
    live.call("map/stop")
    assert [snapshot.state for snapshot in recorder.calls] == [State.MAPPING, State.NOT_MAPPING]
    assert recorder.calls[-1].odom_pose is None


def test_a_new_chain_may_be_of_any_time(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    live.call("map/start", [""])
    drive(live, start=100.0)
    live.call("map/stop")
    live.call("map/resume", [str(tmp_path / "map"), [0.0, 0.0, 0.0]])
    driven(live, start=0.0)
    assert live.figures.clock_jumps == 0
    assert not recorder.troubles


def test_a_place_that_is_no_dock_is_told(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    driven(live, 1)
    live.places.create("dock", "dock")
    driven(live)
    blind = room_scan(0, 0, 0, 0.0).ranges * float("nan")
    live.add_scan(lambda: replace(room_scan(0.6, 0, 1.2, 7.0), ranges=blind))
    before = live.snapshot.closures
    live.call("map/notify_docked")
    for k in range(100):  # beside these it is looked for
        live.add_scan(lambda k=k: replace(room_scan(0.6, 0, 1.2, 7.1 + 0.1 * k), ranges=blind))  # type: ignore[misc]
    until(lambda: len(recorder.troubles) > 0)
    assert live.snapshot.closures == before
    assert recorder.troubles[-1].startswith("map/notify_docked: nothing was linked")


def test_scans_are_mapped_while_the_dock_is_looked_for(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    driven(live, 1)
    live.places.create("dock", "dock")
    poses = [(0.5 * math.sin(a), 0.7 * math.sin(2.0 * a)) for a in np.linspace(0.1, 2.0 * np.pi, 60)[:-1]]
    for k, (x, theta) in enumerate(poses):  # to and fro, back to the dock
        live.add_scan(lambda x=x, theta=theta, k=k: room_scan(x, 0.0, theta, 1.0 + 0.1 * k))  # type: ignore[misc]
    until(lambda: len(live.inbox) == 0)
    mapped, nodes = len(recorder.poses), live.snapshot.num_nodes
    answers: list[object] = []
    asking = [threading.Thread(target=lambda: answers.append(live.call("map/notify_docked"))) for _ in range(2)]
    for caller in asking:
        caller.start()
    for k in range(100):
        live.add_scan(lambda k=k: room_scan(0.0, 0.0, 0.0, 8.0 + 0.1 * k))  # type: ignore[misc]
        time.sleep(0.01)
        if len(answers) == 2:
            break
    for caller in asking:
        caller.join()
    assert answers == [True, True]
    assert len(recorder.poses) > mapped + 2  # what was found took effect with one of these
    assert live.snapshot.num_nodes == nodes + 1
    assert live.run(lambda session: session.mapper.statistics["docks"]["tried"]) == 1


def test_without_scans_nobody_waits_for_the_dock(live: LiveSession) -> None:
    live.call("map/start", [""])
    driven(live)
    assert live.call("map/notify_docked") is None
    live.call("map/stop")
    assert live.run(lambda session: session.mapper.dock_closure_found) is not None


# ---- figures ----


def test_drops_are_told_once_in_a_while(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("oort.live.figures.time.monotonic", lambda: now[0])
    drops = Drops()
    assert drops.of_late() == []
    assert drops.add("late", "it was late") == "a scan was left out: it was late"
    assert drops.add("odd", "it was odd") == "a scan was left out: it was odd"
    now[0] += 9.0
    assert drops.add("late", "it was late") == ""
    assert drops.of_late() == ["late"]
    now[0] += 1.1
    assert drops.add("late", "it was very late") == "2 scans were left out: it was very late"
    assert drops.counts == {"late": 3, "odd": 1}
    now[0] += 5.1
    assert drops.of_late() == []


def test_tracking_is_what_the_last_scan_says_while_mapping() -> None:
    figures = Figures()
    assert figures.tracking(State.MAPPING) is Tracking.IDLE
    for told in ("tracking", "uncertain", "lost"):
        figures.mapped(SimpleNamespace(tracking=told), 0.001)  # type: ignore[arg-type]
        assert figures.tracking(State.MAPPING) is Tracking(told)
    assert figures.tracking(State.PAUSED) is Tracking.IDLE
    figures.forget()
    assert figures.tracking(State.MAPPING) is Tracking.IDLE


def test_clear_forgets_how_tracking_went(live: LiveSession) -> None:
    live.call("map/start", [""])
    driven(live)
    assert live.figures.tracking(State.MAPPING) is Tracking.TRACKING
    live.call("map/clear")
    assert live.figures.tracking(State.MAPPING) is Tracking.IDLE
