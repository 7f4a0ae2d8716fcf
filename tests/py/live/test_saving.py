# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""When and where a live session saves: what is new reaches the disk, and no other map is lost for it."""

import math
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from helpers.live_rig import Recorder, drive, driven, until
from helpers.scenes import room_scan
from oort import InputError, MapFileError, Parameters, StateError, load_map
from oort._core import Map, Saved
from oort.live import LiveSession
from oort.session import State, save


class Clocked:
    """A session that saves by a clock that the test sets."""

    def __init__(self, recorder: Recorder) -> None:
        self.now = 100.0
        self.session = LiveSession(Parameters(), recorder, clock=lambda: self.now)

    def wait_for_autosave(self) -> None:
        self.now += 15.5
        time.sleep(0.4)
        until(lambda: self.session.keeper.saver.idle)


@pytest.fixture
def clocked(recorder: Recorder) -> Iterator[Clocked]:
    clocked = Clocked(recorder)
    yield clocked
    clocked.session.close()


def full_disk(*_: object) -> Saved:
    raise MapFileError("no space left on device")


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
    assert live.keeper.saver.error
    assert "not saved" in recorder.troubles[-1]
    assert live.snapshot.state is State.NOT_MAPPING
    live.close()
    assert len(load_map(str(tmp_path / "map"))) > 0


def test_a_save_that_fails_in_whatever_way(
    live: LiveSession, recorder: Recorder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> Saved:
        raise OSError("the stick was pulled")

    live.call("map/start", [str(tmp_path / "map")])
    with monkeypatch.context() as patch:
        patch.setattr("oort.live.saver.save", broken)
        drive(live)
        with pytest.raises(OSError, match="pulled"):
            live.call("map/stop")
    assert live.keeper.saver.error == "the stick was pulled"
    assert "the map was not saved: the stick was pulled" in recorder.troubles


def test_a_stop_that_could_not_save_is_made_up_for(
    clocked: Clocked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    live, path = clocked.session, str(tmp_path / "map")
    live.call("map/start", [path])
    with monkeypatch.context() as patch:
        patch.setattr("oort.live.saver.save", full_disk)
        drive(live)
        with pytest.raises(MapFileError):
            live.call("map/stop")
    assert live.snapshot.state is State.NOT_MAPPING
    clocked.wait_for_autosave()
    assert len(load_map(path)) == live.snapshot.num_nodes
    assert not live.keeper.saver.error


def test_a_dock_is_saved(clocked: Clocked, tmp_path: Path) -> None:
    live, path = clocked.session, str(tmp_path / "map")
    live.call("map/start", [path])
    driven(live, 1)
    live.places.create("dock", "dock")
    for angle in np.linspace(0.0, 2.0 * np.pi, 60).tolist():  # to and fro, back to the dock
        scan = room_scan(0.5 * math.sin(angle), 0.0, 0.7 * math.sin(2.0 * angle), 1.0 + angle)
        live.add_scan(lambda scan=scan: scan)  # type: ignore[misc]
    until(lambda: len(live.inbox) == 0)
    clocked.wait_for_autosave()
    live.call("map/notify_docked")
    before = live.snapshot.closures
    for k in range(100):  # beside these it is linked
        live.add_scan(lambda k=k: room_scan(0.0, 0.0, 0.0, 7.4 + 0.1 * k))  # type: ignore[misc]
    until(lambda: len(live.inbox) == 0)
    assert live.snapshot.closures > before
    clocked.wait_for_autosave()
    saved = load_map(path)
    assert len(saved) == live.snapshot.num_nodes
    edges = saved.switchable_edges
    assert len(edges["i"]) == live.snapshot.closures
    assert sum(edges["i"] < edges["j"]) == 1  # the dock's; those of loops lead from the newer node to the older


def test_a_new_path_is_saved_to_soon(clocked: Clocked, tmp_path: Path) -> None:
    live = clocked.session
    live.call("map/start", [str(tmp_path / "a")])
    driven(live)
    live.call("map/start", [str(tmp_path / "b")])
    until(lambda: (tmp_path / "b.md5").exists(), 2.0)
    assert len(load_map(str(tmp_path / "b"))) == live.snapshot.num_nodes


def test_pausing_saves(clocked: Clocked, recorder: Recorder, tmp_path: Path) -> None:
    live, path = clocked.session, str(tmp_path / "map")
    live.call("map/start", [path])
    driven(live, 1)
    until(lambda: recorder.saves == [Saved.MAP])
    driven(live)
    live.call("map/pause")
    until(lambda: len(recorder.saves) == 2)
    assert len(load_map(path)) == live.snapshot.num_nodes > 1
    live.call("map/pause")
    clocked.wait_for_autosave()
    assert len(recorder.saves) == 2


def test_a_load_saves_what_it_replaces(clocked: Clocked, tmp_path: Path) -> None:
    live = clocked.session
    live.call("map/start", [str(tmp_path / "old")])
    driven(live, 30)
    live.call("map/stop")
    live.call("map/clear")
    live.call("map/start", [str(tmp_path / "new")])
    driven(live, 60)
    nodes = live.snapshot.num_nodes
    live.call("map/load", [str(tmp_path / "old")])
    assert len(load_map(str(tmp_path / "new"))) == nodes > live.snapshot.num_nodes


def test_a_load_does_not_lose_what_cannot_be_saved(
    clocked: Clocked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    live = clocked.session
    live.call("map/start", [str(tmp_path / "old")])
    driven(live, 30)
    live.call("map/stop")
    live.call("map/clear")
    monkeypatch.setattr("oort.live.saver.save", full_disk)
    live.call("map/start", [str(tmp_path / "new")])
    driven(live, 60)
    with pytest.raises(MapFileError, match=r"map in memory would be lost.*no space.*map/clear first"):
        live.call("map/load", [str(tmp_path / "old")])
    assert live.snapshot.state is State.MAPPING
    live.call("map/clear")
    live.call("map/load", [str(tmp_path / "old")])


def test_a_load_waits_for_the_save_under_way(
    live: LiveSession, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    go_on = threading.Event()

    def slow(path: str, map_: Map, what: Saved) -> Saved:
        assert go_on.wait(10.0)
        return save(path, map_, what)

    path = str(tmp_path / "map")
    monkeypatch.setattr("oort.live.saver.save", slow)
    live.call("map/start", [path])
    driven(live)
    nodes = live.snapshot.num_nodes
    threading.Timer(0.3, go_on.set).start()
    live.call("map/load", [path])
    assert live.snapshot.num_nodes == nodes
    assert len(load_map(path)) == nodes


# ---- another map at the path ----


def mapped(live: LiveSession, path: str, scans: int) -> int:
    """Makes a map and forgets it; its nodes."""
    live.call("map/start", [path])
    driven(live, scans)
    live.call("map/stop")
    nodes = live.snapshot.num_nodes
    live.call("map/clear")
    return nodes


def test_another_map_at_the_path_is_set_aside(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    path = str(tmp_path / "map")
    old, new = mapped(live, path, 90), mapped(live, path, 30)
    assert old > new
    assert len(load_map(path)) == new
    assert len(load_map(f"{path}.previous")) == old
    assert recorder.notes == [f"map/start: there was another map at {path}; it is kept as {path}.previous"]
    mapped(live, path, 90)
    assert len(load_map(f"{path}.previous")) == new, "the one before last is gone"


def test_resume_sets_another_map_aside(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    a, b = str(tmp_path / "a"), str(tmp_path / "b")
    mapped(live, a, 30)
    old = mapped(live, b, 90)
    live.call("map/load", [a])
    live.call("map/resume", [b, [0.0, 0.0, 0.0]])
    assert len(load_map(f"{b}.previous")) == old
    assert recorder.notes[-1].startswith("map/resume: ")


def test_the_own_path_is_not_set_aside(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    path = str(tmp_path / "map")
    live.call("map/start", [path])
    driven(live)
    live.call("map/pause")
    live.call("map/start", [f"{path}.map_capnp"])
    assert not recorder.notes
    assert not list(tmp_path.glob("*.previous*"))


def test_a_damaged_map_is_not_overwritten(live: LiveSession, tmp_path: Path) -> None:
    path = tmp_path / "map"
    mapped(live, str(path), 30)
    (tmp_path / "map.map_capnp").write_bytes(b"damaged")
    with pytest.raises(MapFileError, match=r"holds another map, which cannot be kept.*move its files away"):
        live.call("map/start", [str(path)])
    assert live.snapshot.state is State.NOT_MAPPING
    assert (tmp_path / "map.map_capnp").read_bytes() == b"damaged"


def test_the_begin_of_a_first_save_is_no_map(live: LiveSession, recorder: Recorder, tmp_path: Path) -> None:
    (tmp_path / "map.map_capnp.new").write_bytes(b"cut short")
    mapped(live, str(tmp_path / "map"), 30)
    assert not recorder.notes


def test_a_start_that_is_refused_makes_no_folder(live: LiveSession, tmp_path: Path) -> None:
    live.call("map/start", [""])
    driven(live)
    live.call("map/stop")
    with pytest.raises(StateError, match="map/clear first"):
        live.call("map/start", [str(tmp_path / "new" / "map")])
    assert not (tmp_path / "new").exists()


def resumed(live: LiveSession, a: str, b: str) -> int:
    """Maps to a, resumes to b and drives on; the nodes before that."""
    before = mapped(live, a, 30)
    live.call("map/load", [a])
    live.call("graph_loc/create_points", [["rooms"], [[0.5, 0.0]], ["kitchen"]])
    live.call("map/resume", [b, [0.0, 0.0, 0.0]])
    live.call("graph_loc/clear", ["rooms", False])
    driven(live, 90)
    return before


@pytest.mark.parametrize("stopped", [False, True])
def test_a_rejected_session_brings_back_the_map(live: LiveSession, tmp_path: Path, stopped: bool) -> None:
    a, b = str(tmp_path / "a"), str(tmp_path / "b")
    before = resumed(live, a, b)
    after = live.snapshot.num_nodes
    assert after > before
    if stopped:
        live.call("map/stop")
    live.call("map/reject")
    assert live.snapshot.state is State.NOT_MAPPING
    assert live.snapshot.num_nodes == len(load_map(b)) == len(load_map(a)) == before
    assert list(live.snapshot.places) == [("rooms", "kitchen")]
    assert len(load_map(f"{b}.previous")) == after, "what was rejected is kept"
    with pytest.raises(StateError, match=r"map/reject: no map was gone on with"):
        live.call("map/reject")


def test_an_accepted_session_cannot_be_rejected(live: LiveSession, tmp_path: Path) -> None:
    resumed(live, str(tmp_path / "a"), str(tmp_path / "b"))
    live.call("map/accept")
    with pytest.raises(StateError, match=r"map/reject: no map was gone on with"):
        live.call("map/reject")


def test_an_earlier_version_is_restored(live: LiveSession, tmp_path: Path) -> None:
    path = str(tmp_path / "map")
    old = mapped(live, path, 90)
    new = mapped(live, path, 30)
    live.call("map/load", [path])
    live.restore(1)
    assert live.snapshot.num_nodes == len(load_map(path)) == old
    assert len(load_map(f"{path}.previous")) == new
    with pytest.raises(InputError, match="no version 7"):
        live.restore(7)
    live.call("map/clear")
    with pytest.raises(StateError, match="the map has no path"):
        live.restore(1)
