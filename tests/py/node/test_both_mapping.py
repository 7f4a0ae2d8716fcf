# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The mapping node, in ROS 1 or in ROS 2: the same tests run under the Python of either (scripts/test.sh)."""

import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("sensor_msgs", reason="there is no ROS (scripts/setup.sh --ros or --ros2)")
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import Int64, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from helpers.course import COURSE, SHORT
from node.peer import Peer, Program, running, until
from node.rover import Rover
from oort import load_map
from oort.node.messages import yaw
from oort.poses import between

NODE = "/oort_slam"


@pytest.fixture(scope="module")
def slam(graph: Peer, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Program]:
    """The node, which runs as long as the tests here do."""
    with running(graph, tmp_path_factory.mktemp("slam")) as program:
        yield program


@pytest.fixture
def ask(peer: Peer, slam: Program) -> Any:
    """Calls a service of the node without a map; returns what it answers, which must be a success."""

    def call(service: str, kind: str = "Empty", **fields: Any) -> Any:
        reply = peer.call(f"{NODE}/{service}", kind, **fields)
        assert reply.success, reply.message
        return reply.response

    call("map/clear")
    return call


def test_a_drive(peer: Peer, ask: Any, tmp_path: Path) -> None:
    base = str(tmp_path / "maps" / "home")
    queue = peer.hear(f"{NODE}/queue_size", Int64)
    saved = peer.hear(f"{NODE}/file_changed", String)
    told = peer.hear("/diagnostics", DiagnosticArray)
    tf = peer.hear("/tf", TFMessage)
    rover = Rover(peer, COURSE)
    ask("map/start", "SetString", data=base)
    assert ask("map/state", "GetString").data == "mapping"
    rover.drive(COURSE)
    until(lambda: told and told[-1].status[0].message.startswith("Mapping, "), "diagnostics are content")
    assert told[-1].status[0].name == "oort_slam: mapping"
    assert told[-1].status[0].level == DiagnosticStatus.OK
    figures = {item.key: item.value for item in told[-1].status[0].values}
    assert figures["scans dropped"] == "0"
    ask("map/stop")
    nodes = ask("map/num_nodes", "GetUInt").data
    assert nodes == len(load_map(base).node_poses) > 10
    assert ask("map/has_map", "GetBool").data
    assert ask("map/name", "GetString").data == base
    until(lambda: "map" in [message.data for message in saved], "the map was saved")
    assert queue

    ours = [one for message in list(tf) for one in message.transforms if one.child_frame_id == "odom"]
    assert {one.header.frame_id for one in ours} == {"map"}
    last = ours[-1].transform
    pose = last.translation.x, last.translation.y, yaw(last.rotation)
    assert np.abs(between(COURSE.T_map_odom, pose)).max() < 0.03


def test_the_map_for_a_late_joiner(peer: Peer, ask: Any) -> None:
    rover = Rover(peer, SHORT)
    ask("map/start", "SetString", data="")
    rover.drive(SHORT)
    ask("map/stop")
    for topic in ("/map", "/map_cleaned"):
        heard = peer.hear(topic, OccupancyGrid, latched=True)
        until(heard.__len__, f"{topic} comes to who listens late")
        cells = np.array(heard[0].data)
        assert heard[0].header.frame_id == "map"
        assert len(cells) == heard[0].info.width * heard[0].info.height
        assert set(np.unique(cells)) == {-1, 0, 100}
    asked = ask("map/map", "GetMap").map
    assert asked.info.width == heard[0].info.width
    markers = peer.hear(f"{NODE}/graph", MarkerArray)
    until(lambda: markers, "the graph comes to who listens late")
    assert {"nodes", "chain"} <= {marker.ns for marker in markers[0].markers}


def test_a_session_is_taken_back(peer: Peer, ask: Any, tmp_path: Path) -> None:
    home, today = str(tmp_path / "home"), str(tmp_path / "today")
    rover = Rover(peer, SHORT)
    ask("map/start", "SetString", data=home)
    rover.drive(SHORT)
    ask("map/stop")
    before = ask("map/num_nodes", "GetUInt").data
    ask("map/resume", "MapResume", new_map_loc=today)
    rover.drive(SHORT)
    ask("map/stop")
    ask("map/reject")
    assert ask("map/num_nodes", "GetUInt").data == len(load_map(today)) == before
    lines = ask("map/history", "GetStrings").data
    assert [line.split()[0] for line in lines] == ["1"]
    assert lines[0].endswith(f"{today}.previous")
    ask("map/restore", "SetString", data="1")
    assert ask("map/num_nodes", "GetUInt").data == len(load_map(today)) > before
    reply = peer.call(f"{NODE}/map/restore", "SetString", data="two")
    assert not reply.success
    assert "map/history lists them" in reply.message


def test_places(peer: Peer, ask: Any) -> None:
    rover = Rover(peer, SHORT)
    ask("map/start", "SetString", data="")
    rover.drive(SHORT)
    ask("graph_loc/create", "LocCreate", nspace="dock", id="1")
    points = [Point(x=1.0, y=0.0, z=0.0), Point(x=1.0, y=1.0, z=0.0)]
    ask("graph_loc/create_points", "LocCreatePoints", nspaces=["room", "room"], points=points, ids=["a", "b"])
    ask("map/notify_docked")
    ask("map/stop")
    assert ask("graph_loc/list_namespaces", "GetStrings").data == ["dock", "room"]
    listed = ask("graph_loc/list", "LocNamespace", nspace="ro", use_as_prefix=True)
    assert (listed.nspaces, listed.ids) == (["room", "room"], ["a", "b"])
    where = ask("graph_loc/locate", "LocLocate", nspace="room", id="a").pose
    assert (where.header.frame_id, where.pose.position.x) == ("map", pytest.approx(1.0, abs=0.05))
    assert ask("graph_loc/delete", "LocDelete", nspace="room", id="a").success
    assert not peer.call(f"{NODE}/graph_loc/delete", "LocDelete", nspace="room", id="a").success
    assert ask("graph_loc/clear", "LocNamespace", nspace="", use_as_prefix=True).ids == ["1", "b"]


@pytest.mark.parametrize(
    ("service", "kind", "fields", "told"),
    [
        ("map/pause", "Empty", {}, "map/pause: nothing is being mapped"),
        ("map/start", "SetString", {"data": "maps/home"}, "map/start: the path 'maps/home' is not absolute"),
        ("map/load", "SetString", {"data": "/nowhere/map"}, "map/load: /nowhere: cannot open the folder"),
        ("map/republish_maps", "Empty", {}, "there is no map; call map/start and drive, or map/load"),
        ("graph_loc/locate", "LocLocate", {"nspace": "a", "id": "b"}, "graph_loc/locate: "),
        ("graph_loc/create", "LocCreate", {"nspace": "a", "id": "b"}, "graph_loc/create: "),
    ],
)
def test_failures_say_why(peer: Peer, ask: Any, service: str, kind: str, fields: dict[str, Any], told: str) -> None:
    reply = peer.call(f"{NODE}/{service}", kind, **fields)
    assert not reply.success
    assert told in reply.message
    assert ask("map/state", "GetString").data == "not_mapping"


def test_scans_that_wait_are_told_of(peer: Peer, ask: Any) -> None:
    told = peer.hear("/diagnostics", DiagnosticArray)
    rover = Rover(peer, SHORT)
    ask("map/start", "SetString", data="")
    stamps = rover.drive(SHORT[:5], odometry=False)
    until(lambda: told and "5 scans wait: " in told[-1].status[0].message, "a warning")
    assert told[-1].status[0].level == DiagnosticStatus.WARN
    for number, stamp in enumerate(stamps):
        rover.tell_odometry(SHORT, number, stamp)
    ask("map/stop")
    assert ask("map/num_nodes", "GetUInt").data >= 1


# ---- nodes of their own ----


def test_a_kill_and_on_again(peer: Peer, tmp_path: Path) -> None:
    """What a killed node has saved is a whole map, with which the next one goes on."""
    base = str(tmp_path / "home")
    node = "/oort_killed"
    with running(peer, tmp_path, name=node[1:]) as program:
        rover = Rover(peer, COURSE)
        saved = peer.hear(f"{node}/file_changed", String)
        peer.call(f"{node}/map/start", "SetString", data=base)
        rover.drive(COURSE[:60])
        until(lambda: saved, "the map was saved")
        program.end(signal.SIGKILL)
    peer.forget()
    with running(peer, tmp_path, name="oort_again", load=base):
        rover = Rover(peer, COURSE)
        before = peer.call("/oort_again/map/num_nodes", "GetUInt").response.data
        assert before >= 1
        resumed = peer.call("/oort_again/map/resume", "MapResume", new_map_loc=f"{base}2")
        assert resumed.success, resumed.message
        rover.drive(COURSE[:60])
        assert peer.call("/oort_again/map/stop", "Empty").success
        assert peer.call("/oort_again/map/num_nodes", "GetUInt").response.data > before


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_saves(peer: Peer, tmp_path: Path, ending: signal.Signals) -> None:
    base = str(tmp_path / "home")
    name = f"oort_{ending.name.lower()}"
    with running(peer, tmp_path, name=name, base_frame="base_link", linear_update=0.1) as program:
        rover = Rover(peer, SHORT, base="base_link")
        assert peer.call(f"/{name}/map/start", "SetString", data=base).success
        rover.drive(SHORT)
        assert program.end(ending) == 0
        assert len(load_map(base).node_poses) > 5
        assert "Traceback" not in program.output


@pytest.mark.parametrize(
    ("parameters", "told"),
    [
        ({"base_fram": "base_link"}, 'unknown parameter "base_fram"; the nearest known is "base_frame"'),
        ({"load": "/nowhere/map"}, "/nowhere"),
        ({"min_range": "near"}, "min_range and"),
    ],
)
def test_it_does_not_begin(peer: Peer, tmp_path: Path, parameters: dict[str, Any], told: str) -> None:
    with running(peer, tmp_path, name="oort_wrong", ready="", **parameters) as program:
        assert program.process.wait(30.0) == 2
        (line,) = program.output.splitlines()
        assert line.startswith("[FATAL]")
        assert told in line
