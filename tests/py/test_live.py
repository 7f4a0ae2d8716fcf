# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A live session without ROS: the queue, the waiting, what readers see, saving beside the mapping."""

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from oort import MapFileError, Parameters, StateError, load_map
from oort._core import Saved
from oort.events import EventLog, read_events
from oort.live import Drawing, Listener, LiveSession, Snapshot, UnusableScanError
from oort.live.inbox import CallItem, Inbox, ScanItem
from oort.locations import Pose
from oort.recording import Scan
from oort.session import State
from scenes import room_scan


class Recorder(Listener):
    def __init__(self) -> None:
        self.drawings: list[Drawing] = []
        self.saves: list[Saved] = []
        self.troubles: list[str] = []
        self.poses: list[Pose | None] = []

    def scan_taken(self, snapshot: Snapshot) -> None:
        self.poses.append(snapshot.odom_pose)

    def drawn(self, drawing: Drawing) -> None:
        self.drawings.append(drawing)

    def saved(self, what: Saved) -> None:
        self.saves.append(what)

    def trouble(self, text: str) -> None:
        self.troubles.append(text)


@pytest.fixture
def recorder() -> Recorder:
    return Recorder()


@pytest.fixture
def live(recorder: Recorder) -> Iterator[LiveSession]:
    session = LiveSession(Parameters(), recorder)
    yield session
    session.close()


def until(condition: Callable[[], bool], timeout: float = 10.0) -> None:
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.005)


def drive(live: LiveSession, scans: int = 60, start: float = 0.0) -> None:
    for i in range(scans):
        scan = room_scan(0.01 * i, 0.0, 0.02 * i, start + 0.1 * i)
        live.add_scan(lambda scan=scan: scan)  # type: ignore[misc]


def test_stop_waits_for_the_queue(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    path = str(tmp_path / "new" / "map")
    live.call("map/start", [path])
    drive(live, 200)
    live.call("map/stop")
    assert len(live.inbox) == 0
    assert len(recorder.poses) == 200
    assert not live.drops
    assert live.snapshot.state is State.NOT_MAPPING
    assert live.snapshot.odom_pose is None
    assert recorder.saves[-1] is Saved.MAP
    assert len(load_map(path)) == live.snapshot.num_nodes == len(recorder.drawings[-1].map)
    assert live.latest_map() is recorder.drawings[-1]


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
    assert not live.drops


def test_a_call_does_not_wait_for_ever_on_odometry(live: LiveSession, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("oort.live.inbox.PATIENCE_BEFORE_CALL", 0.2)
    live.call("map/start", [""])
    for _ in range(5):
        live.add_scan(lambda: None)
    live.call("map/stop")
    assert live.drops == {"no odometry at its stamp": 5}


def test_scans_that_cannot_be_used_are_counted_by_reason(live: LiveSession, recorder: Recorder) -> None:
    def refuse() -> Scan | None:
        raise UnusableScanError("older than the odometry")

    live.call("map/start", [""])
    live.add_scan(refuse)
    bad = replace(room_scan(0, 0, 0, 0.0), angle_increment=float("nan"))
    live.add_scan(lambda: bad)
    live.call("map/stop")
    assert live.drops == {"older than the odometry": 1, "unusable": 1}
    assert "left out" in recorder.troubles[0]


def test_scans_without_odometry_do_not_hold_up_the_start(live: LiveSession) -> None:
    for _ in range(5):
        live.add_scan(lambda: None)
    started = time.monotonic()
    live.call("map/start", [""])
    assert time.monotonic() - started < 1.0


def test_create_right_after_start(live: LiveSession) -> None:
    live.call("map/start", [""])
    with pytest.raises(StateError, match="none is arriving"):
        live.create_location("dock", "dock")
    ready = threading.Event()
    scan = room_scan(0, 0, 0, 0.0)
    live.add_scan(lambda: scan if ready.is_set() else None)
    live.add_scan(lambda: scan if ready.is_set() else None)
    assert not live.is_ready
    live.create_location("dock", "dock")
    with pytest.raises(StateError, match="ask again later"):
        live.locate("dock", "dock")
    ready.set()
    live.inbox.poke()
    until(lambda: ("dock", "dock") in live.snapshot.places)
    assert live.locate("dock", "dock") == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    assert live.is_ready


def test_places_need_a_localiser_when_nothing_is_mapped(recorder: Recorder, tmp_path: Path) -> None:
    poses: list[Pose] = []
    live = LiveSession(Parameters(), recorder, localiser=lambda: poses[-1] if poses else None)
    with pytest.raises(StateError, match="no map"):
        live.create_location("", "here")
    live.call("map/start", [str(tmp_path / "map")])
    drive(live)
    live.call("map/stop")
    assert not live.is_ready
    with pytest.raises(StateError, match="start a localiser"):
        live.create_location("a", "here")
    poses.append((0.3, 0.1, 0.5))
    assert live.is_ready
    recorder.saves.clear()
    live.create_location("a", "here")
    assert live.locate("a", "here") == pytest.approx((0.3, 0.1, 0.5))
    assert recorder.saves == [Saved.METADATA]
    assert [place[1] for place in load_map(str(tmp_path / "map")).locations] == ["here"]
    live.close()


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


def test_autosave_by_the_given_clock(recorder: Recorder, tmp_path: Path) -> None:
    now = [100.0]
    live = LiveSession(Parameters(), recorder, clock=lambda: now[0])
    live.call("map/start", [str(tmp_path / "map")])
    drive(live, 30)
    until(lambda: recorder.saves == [Saved.MAP] and len(live.inbox) == 0)  # with the first node
    first = len(load_map(str(tmp_path / "map")))
    drive(live, 60, start=3.0)
    until(lambda: len(live.inbox) == 0)
    now[0] += 14.0
    time.sleep(0.3)
    assert len(recorder.saves) == 1
    now[0] += 1.5
    until(lambda: len(recorder.saves) == 2)
    assert len(load_map(str(tmp_path / "map"))) > first
    now[0] += 60.0
    time.sleep(0.5)
    assert len(recorder.saves) == 2  # nothing is new
    live.close()


def test_closing_saves(recorder: Recorder, tmp_path: Path) -> None:
    live = LiveSession(Parameters(), recorder, clock=lambda: 0.0)
    live.call("map/start", [str(tmp_path / "map")])
    drive(live, 200)
    live.close()
    assert len(load_map(str(tmp_path / "map"))) == live.snapshot.num_nodes > 5


def test_a_save_that_fails_is_told_and_made_up_for(
    live: LiveSession, recorder: Recorder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full_disk(*_: object) -> Saved:
        raise MapFileError("no space left on device")

    live.call("map/start", [str(tmp_path / "map")])
    with monkeypatch.context() as patch:
        patch.setattr("oort.live.saver.save", full_disk)
        drive(live)
        with pytest.raises(MapFileError, match="no space"):
            live.call("map/stop")
    assert live.saver.error
    assert "not saved" in recorder.troubles[-1]
    assert live.snapshot.state is State.NOT_MAPPING
    live.close()
    assert len(load_map(str(tmp_path / "map"))) > 0


def test_a_clock_that_is_set_back_makes_a_loose_link(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    drive(live, 30, start=100.0)
    drive(live, 30, start=0.0)
    live.call("map/stop")
    assert "went back by 102.9 s" in recorder.troubles[0]
    assert live.clock_jumps == 1
    assert len(recorder.poses) == 60


def test_has_map_and_clear(live: LiveSession) -> None:
    assert not live.has_map
    live.call("map/start", [""])
    drive(live)
    live.call("map/stop")
    assert live.has_map
    live.call("map/clear")
    assert not live.has_map
    assert live.snapshot.places == {}
    live.call("map/start", [""])


def test_no_map_within_the_time(live: LiveSession, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("oort.live.session.MAP_TIMEOUT", 0.3)
    with pytest.raises(StateError, match="no map"):
        live.latest_map()


def test_the_log_replays(recorder: Recorder, tmp_path: Path) -> None:
    log = EventLog(tmp_path / "events.json")
    live = LiveSession(Parameters(), recorder, event_log=log)
    live.call("map/start", [""])
    drive(live, 3)
    live.create_location("a", "b")
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
