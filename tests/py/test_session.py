# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.scenes import room_scan
from oort import InputError, MapFileError, Parameters, Session, StateError, load_map
from oort.naming import service
from oort.recording import Scan


def drive_around(session: Session, start: float = 0.0, scans: int = 60) -> None:
    for i in range(scans):
        session.add_scan(room_scan(0.01 * i, 0.0, 0.02 * i, start + 0.1 * i))


@pytest.fixture
def session() -> Session:
    return Session(Parameters())


def state_of(session: Session) -> str:
    return session.state.value


def test_who_calls_by_services_hears_of_services() -> None:
    session = Session(Parameters(), naming=service)
    with pytest.raises(StateError, match=r"^map/resume: no map is loaded; call map/load first"):
        session.call("map/resume", ["", [0.0, 0.0, 0.0]])
    with pytest.raises(StateError, match=r"^map/pause: nothing is being mapped; call map/start first"):
        session.call("map/pause")
    with pytest.raises(StateError, match="graph_loc/list shows"):
        session.locations.locate("a", "b")
    session.start()
    with pytest.raises(StateError, match=r"^map/notify_docked: no scan has been mapped"):
        session.call("map/notify_docked")


def test_states(session: Session, tmp_path: Path) -> None:
    assert state_of(session) == "not_mapping"
    assert session.add_scan(room_scan(0, 0, 0, 0.0)) is None
    session.start(str(tmp_path / "map"))
    assert state_of(session) == "mapping"
    drive_around(session)
    session.pause()
    assert state_of(session) == "paused"
    assert session.add_scan(room_scan(0, 0, 0, 100.0)) is None
    session.start(str(tmp_path / "other"))
    assert state_of(session) == "mapping"
    session.stop()
    assert state_of(session) == "not_mapping"
    assert load_map(str(tmp_path / "other")).node_poses.shape == session.map.node_poses.shape
    with pytest.raises(StateError, match=r"Session\.start: .*Session\.clear"):
        session.start("")
    session.clear()
    assert session.mapper.num_nodes == 0
    session.start("")


@pytest.mark.parametrize("call", ["map/pause", "map/resume_from_paused", "map/notify_docked"])
def test_calls_that_need_mapping(session: Session, call: str) -> None:
    with pytest.raises(StateError):
        session.call(call)


def test_unknown_call_and_wrong_arguments(session: Session) -> None:
    with pytest.raises(StateError, match="map/begin"):
        session.call("map/begin")
    with pytest.raises(StateError, match="arguments"):
        session.call("map/start", ["a", "b"])


def test_pose_follows_the_drive(session: Session) -> None:
    session.start()
    drive_around(session)
    assert session.mapper.sensor_pose == pytest.approx((0.59, 0.0, 1.18), abs=0.01)
    assert session.mapper.odom_pose == pytest.approx((0.0, 0.0, 0.0), abs=0.015)


def test_location_before_the_first_scan_gets_its_pose(session: Session) -> None:
    session.start()
    session.create_location("dock", "dock")
    with pytest.raises(StateError, match="no pose yet"):
        session.locations.locate("dock", "dock")
    drive_around(session)
    assert session.locations.locate("dock", "dock") == pytest.approx((0, 0, 0))


def test_locations_by_namespace_and_prefix(session: Session) -> None:
    session.start()
    drive_around(session)
    for space, id in itertools.product(["place", "place/room", "dock"], "ab"):
        session.create_location(space, id)
    assert session.locations.list_ids("place") == [("place", "a"), ("place", "b")]
    assert len(session.locations.list_ids("place", use_as_prefix=True)) == 4
    assert session.locations.list_ids("nowhere") == []
    assert session.locations.list_namespaces() == ["place", "place/room", "dock"]
    assert session.locations.delete("place", "a")
    assert not session.locations.delete("place", "a")
    assert session.locations.clear("place", use_as_prefix=True) == [
        ("place", "b"),
        ("place/room", "a"),
        ("place/room", "b"),
    ]
    assert session.locations.list_ids("", use_as_prefix=True) == [("dock", "a"), ("dock", "b")]
    with pytest.raises(StateError, match=r"Session\.locations\.list_ids"):
        session.locations.locate("place", "a")


def test_empty_ids_are_made_up_and_never_twice(session: Session) -> None:
    session.start()
    drive_around(session)
    first = session.create_location("place", "")
    second = session.create_location("place", "")
    session.locations.delete("place", first)
    third = session.create_location("place", "")
    assert third != second
    assert len(session.locations.list_ids("place")) == 2


def test_clearing_gives_up_places_that_wait_for_a_pose(session: Session) -> None:
    session.start()
    session.create_location("place", "a")
    session.create_location("place/room", "b")
    session.create_location("dock", "dock")
    session.locations.clear("place")
    drive_around(session)
    assert session.locations.list_ids("", use_as_prefix=True) == [("place/room", "b"), ("dock", "dock")]


def test_points_share_a_node_and_keep_their_places(session: Session) -> None:
    session.start()
    drive_around(session)
    session.call("graph_loc/create_points", [["spots", "spots"], [[1.0, 0.5, 0.0], [1.2, -0.5, 0.0]], ["p", "q"]])
    assert session.locations.locate("spots", "p") == pytest.approx((1.0, 0.5, 0.0))
    assert session.locations.locate("spots", "q") == pytest.approx((1.2, -0.5, 0.0))
    nodes = {node for _, id, node, _ in session.mapper.locations if id in "pq"}
    assert len(nodes) == 1
    with pytest.raises(StateError, match="one namespace"):
        session.locations.create_points(["spots"], [], [])


def test_resume_adds_a_chain_and_corrects_the_start_pose(session: Session, tmp_path: Path) -> None:
    session.start(str(tmp_path / "old"))
    drive_around(session, scans=150)
    session.stop()
    old = load_map(str(tmp_path / "old"))

    again = Session(Parameters())
    with pytest.raises(StateError, match=r"Session\.resume: .*Session\.load"):
        again.resume(str(tmp_path / "new"), (0, 0, 0))
    again.load(str(tmp_path / "old"))
    again.resume(str(tmp_path / "new"), (0.15, -0.1, 0.1))  # the truth is 0, 0, 0
    drive_around(again, start=1000.0, scans=150)
    again.stop()
    new = load_map(str(tmp_path / "new"))
    first = len(old.node_ids)
    assert new.node_poses[:first] == pytest.approx(old.node_poses, abs=0.02)
    assert new.node_poses[first] == pytest.approx((0, 0, 0), abs=0.03)
    assert load_map(str(tmp_path / "old")).node_poses == pytest.approx(old.node_poses)


def test_pause_links_loosely_and_stays_one_map(session: Session) -> None:
    session.start()
    drive_around(session, scans=60)
    before = session.mapper.num_nodes
    session.pause()
    session.resume_from_paused()
    drive_around(session, start=50.0, scans=1)
    edges = session.map.edges
    assert session.mapper.num_nodes == before + 1
    assert edges["covariance"][-1, 0, 0] > 100 * edges["covariance"][:-1, 0, 0].max()


def test_parked_robot_adds_nothing(session: Session) -> None:
    session.start()
    drive_around(session)
    nodes = session.mapper.num_nodes
    for i in range(300):
        session.add_scan(room_scan(0.59, 0.0, 1.18, 10.0 + 0.1 * i))
    assert session.mapper.num_nodes == nodes


def test_useless_scans_are_survived(session: Session) -> None:
    session.start()
    drive_around(session)
    nothing = np.full(180, np.nan, np.float32)
    for i, ranges in enumerate([nothing, nothing[:0], np.full(7, np.inf, np.float32)]):
        result = session.add_scan(Scan(ranges, -1.5, 0.02, 0.05, 6.0, 20.0 + i, stamp="20", odometry=(0.6, 0.0, 1.2)))
        assert result is not None and result.outcome == "skipped"
    with pytest.raises(InputError):
        session.add_scan(Scan(nothing, -1.5, 0.1, 0.05, 6.0, 30.0, stamp="30", odometry=(np.nan, 0.0, 0.0)))
    drive_around(session, start=40.0)
    assert session.mapper.sensor_pose == pytest.approx((0.59, 0.0, 1.18), abs=0.02)


def test_resume_far_from_the_map_is_refused(session: Session, tmp_path: Path) -> None:
    session.start()
    drive_around(session)
    session.stop()
    with pytest.raises(StateError, match=r"\(90000, 0\) is 90000 m from the map; give the sensor's pose"):
        session.resume(str(tmp_path / "new"), (90000.0, 0.0, 0.0))
    assert state_of(session) == "not_mapping"
    session.resume(str(tmp_path / "new"), (50.0, 0.0, 0.0))


def test_a_place_that_got_its_pose_is_saved(session: Session, tmp_path: Path) -> None:
    session.start(str(tmp_path / "map"))
    session.create_location("dock", "dock")
    assert not list(tmp_path.iterdir())
    drive_around(session, scans=1)
    assert [place[:2] for place in load_map(str(tmp_path / "map")).locations] == [("dock", "dock")]


def test_a_place_without_a_pose_does_not_outlive_its_drive(session: Session, tmp_path: Path) -> None:
    session.start()
    drive_around(session)
    session.pause()
    session.resume_from_paused()
    session.create_location("a", "b")
    assert session.locations.waiting == [("a", "b")]
    session.stop()
    session.resume(str(tmp_path / "map"), (0.0, 0.0, 0.0))
    drive_around(session, start=10.0)
    assert not session.locations.list_namespaces()


def test_only_other_paths_are_prepared(tmp_path: Path) -> None:
    prepared: list[tuple[str, str]] = []

    def prepare(call: str, path: str) -> None:
        if "no" in path:
            raise MapFileError("no")
        prepared.append((call, path))

    session = Session(Parameters(), prepare=prepare)
    a, b = str(tmp_path / "a"), str(tmp_path / "b")
    with pytest.raises(MapFileError):
        session.start(str(tmp_path / "no"))
    assert (state_of(session), session.path) == ("not_mapping", "")
    for path in (a, f"{a}.map_capnp", "", a):
        session.start(path)
    drive_around(session)
    session.stop()
    with pytest.raises(StateError):
        session.start(b)
    with pytest.raises(StateError):
        session.resume(a, (0.0, 0.0, 0.0))
    session.resume(b, (0.0, 0.0, 0.0))
    assert prepared == [("map/start", a), ("map/start", a), ("map/resume", b)]


def test_same_events_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        session = Session(Parameters())
        session.start(str(tmp_path / name))
        session.create_location("dock", "dock")
        drive_around(session, scans=150)
        session.notify_docked()
        session.stop()
    for suffix in (".map_capnp", ".map_meta_capnp"):
        assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_points_need_ids_of_their_own() -> None:
    locations = Session(Parameters()).locations
    for ids, message in ((["a", ""], "point 1 has an empty id"), (["a", "a"], "2 points for 'n'/'a'")):
        with pytest.raises(StateError, match=message):
            locations.create_points(["n", "n"], [(0.0, 0.0), (1.0, 0.0)], ids)


def test_no_path_and_no_name_holds_a_nul() -> None:
    session = Session(Parameters())
    calls: list[tuple[str, list[Any]]] = [
        ("map/start", ["a\0b"]),
        ("map/load", ["a\0b"]),
        ("graph_loc/create", ["n", "a\0b"]),
        ("graph_loc/create_points", [["n\0"], [[0.0, 0.0]], ["a"]]),
    ]
    for call, args in calls:
        with pytest.raises(StateError, match="NUL character"):
            session.call(call, args)
