# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Places while the queue may be behind: asked for, waiting for their turn or their pose, known, or given up."""

import threading
from pathlib import Path

import numpy as np
import pytest

from helpers.live_rig import Recorder, drive, driven, until
from helpers.scenes import room_scan
from oort import Parameters, StateError, load_map
from oort._core import Saved
from oort.events import EventLog, read_events
from oort.live import LiveSession
from oort.locations import Pose


def test_create_right_after_start(live: LiveSession) -> None:
    live.call("map/start", [""])
    with pytest.raises(StateError, match="none is arriving"):
        live.places.create("dock", "dock")
    ready = threading.Event()
    scan = room_scan(0, 0, 0, 0.0)
    live.add_scan(lambda: scan if ready.is_set() else None)
    live.add_scan(lambda: scan if ready.is_set() else None)
    assert not live.places.is_ready
    live.places.create("dock", "dock")
    with pytest.raises(StateError, match="ask again later"):
        live.places.locate("dock", "dock")
    ready.set()
    live.inbox.poke()
    until(lambda: ("dock", "dock") in live.snapshot.places)
    assert live.places.locate("dock", "dock") == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    assert live.places.is_ready


def test_places_need_a_localiser_when_nothing_is_mapped(recorder: Recorder, tmp_path: Path) -> None:
    poses: list[Pose] = []
    live = LiveSession(Parameters(), recorder, localiser=lambda: poses[-1] if poses else None)
    with pytest.raises(StateError, match="no map"):
        live.places.create("", "here")
    live.call("map/start", [str(tmp_path / "map")])
    drive(live)
    live.call("map/stop")
    assert not live.places.is_ready
    with pytest.raises(StateError, match="start a localiser"):
        live.places.create("a", "here")
    poses.append((0.3, 0.1, 0.5))
    assert live.places.is_ready
    recorder.saves.clear()
    live.places.create("a", "here")
    assert live.places.locate("a", "here") == pytest.approx((0.3, 0.1, 0.5))
    assert recorder.saves == [Saved.METADATA]
    assert [place[1] for place in load_map(str(tmp_path / "map")).locations] == ["here"]
    live.close()


def test_a_place_waits_for_the_first_node(live: LiveSession, tmp_path: Path) -> None:
    path = str(tmp_path / "map")
    live.call("map/start", [path])
    live.call("graph_loc/create", ["dock", "dock"])
    with pytest.raises(StateError, match="ask again later"):
        live.places.locate("dock", "dock")
    driven(live, 1)
    assert live.places.locate("dock", "dock") == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    until(lambda: live.keeper.saver.idle)
    assert [place[:2] for place in load_map(path).locations] == [("dock", "dock")]


def test_a_place_after_a_pause_waits_for_a_scan_and_is_saved(
    live: LiveSession, recorder: Recorder, tmp_path: Path
) -> None:
    path = str(tmp_path / "map")
    live.call("map/start", [path])
    driven(live)
    live.call("map/pause")
    live.call("map/resume_from_paused")
    live.places.create("a", "b")
    with pytest.raises(StateError, match="ask again later"):
        live.places.locate("a", "b")
    until(lambda: live.keeper.saver.idle)
    driven(live, 1, start=10.0)
    live.places.locate("a", "b")
    until(lambda: live.keeper.saver.idle)
    assert [place[:2] for place in load_map(path).locations] == [("a", "b")]


def test_a_place_that_no_scan_followed_is_given_up(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    live.call("graph_loc/create", ["a", "b"])
    live.call("map/stop")
    assert recorder.troubles == ["graph_loc/create: no scan came before map/stop, so 'a'/'b' has no pose"]
    with pytest.raises(StateError, match="no place 'a'/'b'"):
        live.places.locate("a", "b")
    live.call("map/start", [""])
    driven(live, 1)
    assert not live.snapshot.places


def test_a_localisers_pose_goes_into_the_log(recorder: Recorder, tmp_path: Path) -> None:
    pose = np.array([0.3, 0.1, 0.5], np.float32)
    log = EventLog(tmp_path / "events.json")
    live = LiveSession(Parameters(), recorder, event_log=log, localiser=lambda: tuple(pose))
    live.call("map/start", [""])
    driven(live)
    live.call("map/stop")
    live.places.create("a", "b")
    live.close()
    assert read_events(tmp_path / "events.json")[-1].args == ["a", "b", pose.tolist()]
    assert not recorder.troubles


def test_a_place_that_fails_in_its_turn_is_told(live: LiveSession, recorder: Recorder) -> None:
    live.call("map/start", [""])
    live.add_scan(lambda: None)
    stopping = threading.Thread(target=live.call, args=["map/clear"])
    stopping.start()
    until(lambda: len(live.inbox) == 2)
    live.places.create("a", "b")
    stopping.join()
    until(lambda: bool(recorder.troubles) and "graph_loc" in recorder.troubles[-1])
    assert recorder.troubles[-1].count("graph_loc/create: ") == 1
