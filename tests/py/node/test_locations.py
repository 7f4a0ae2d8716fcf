# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The services graph_loc/* through a client of ROS: what each does, and what it says when it cannot."""

import time
import uuid
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
from geometry_msgs.msg import Point

from node.client import Client, until
from node.robot import COURSE, SHORT, Course, Localiser, Robot
from node.running import Core
from oort import load_map
from oort.poses import compose

pytest_plugins = ["node.fixtures"]
pytestmark = pytest.mark.usefixtures("cleared")


def pose(stamped: Any) -> list[float]:
    """x [m], y [m], theta [rad] of a PoseStamped in the map."""
    assert stamped.header.frame_id == "map"
    at = stamped.pose
    assert (at.position.z, at.orientation.x, at.orientation.y) == (0.0, 0.0, 0.0)
    return [at.position.x, at.position.y, 2.0 * np.arctan2(at.orientation.z, at.orientation.w)]


def located(client: Client, name_space: str, id: str) -> list[float]:
    return pose(client.call("graph_loc/locate", name_space, id))


def listed(client: Client, name_space: str, use_as_prefix: bool = False) -> list[tuple[str, str]]:
    answer = client.call("graph_loc/list", name_space, use_as_prefix)
    return list(zip(answer.nspaces, answer.ids, strict=True))


def points(*xy: tuple[float, float]) -> list[Point]:
    return [Point(x, y, 7.0) for x, y in xy]


@pytest.fixture
def places(client: Client, mapped: Course) -> list[tuple[str, str]]:
    """Places in a map, made in this order."""
    names = [("dock", "dock"), ("kitchen", "1"), ("kitchen", "2"), ("kitchen/table", "1"), ("hall", "mirror")]
    spaces, ids = zip(*names, strict=True)
    client.call("graph_loc/create_points", spaces, points(*((0.1 * k, 0.0) for k in range(5))), ids)
    return names


# ---- create while mapping ----


def test_create_right_after_start(client: Client, robot: Robot) -> None:
    """As long as scans arrive, nobody needs to wait for the first of them."""
    robot.laser_on = True
    time.sleep(0.2)
    client.call("map/start", "")
    client.call("graph_loc/create", "dock", "dock")
    until(lambda: listed(client, "dock") == [("dock", "dock")], "the place", 1.0)
    assert located(client, "dock", "dock") == [0.0, 0.0, 0.0]


def test_create_without_scans(client: Client) -> None:
    time.sleep(1.0)  # since the last test's scans
    client.call("map/start", "")
    refusal = client.refusal("graph_loc/create", "dock", "dock")
    assert "no scan has been mapped and none is arriving" in refusal
    assert "check the scan topic" in refusal
    assert not client.call("graph_loc/is_ready")


def test_create_where_the_robot_is(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    robot.drive(SHORT)
    client.call("map/stop")
    client.call("map/clear")
    client.call("map/start", path)
    robot.drive(SHORT)
    assert client.call("graph_loc/is_ready")
    client.call("graph_loc/create", "a", "here")
    expected = compose(SHORT.T_map_odom, SHORT.T_odom_laser[-1])
    assert located(client, "a", "here") == pytest.approx(expected.tolist(), abs=0.02)
    client.call("map/stop")
    assert [place[:2] for place in load_map(path).locations] == [("a", "here")]


def test_create_while_the_queue_is_behind(client: Client, robot: Robot) -> None:
    client.call("map/start", "")
    robot.drive(COURSE[:10])
    robot.base_on = False
    stamps = robot.drive(COURSE[10:30], odometry=False)
    started = time.monotonic()
    client.call("graph_loc/create", "a", "there")
    assert time.monotonic() - started < 0.5
    refusal = client.refusal("graph_loc/locate", "a", "there")
    assert refusal == "graph_loc/locate: mapping has not reached 'a'/'there' yet; ask again later"
    robot.tell_odometry(stamps, COURSE[10:30])
    until(lambda: listed(client, "a"), "the place")
    expected = compose(COURSE.T_map_odom, COURSE.T_odom_laser[29])
    assert located(client, "a", "there") == pytest.approx(expected.tolist(), abs=0.02)


def test_create_again_moves_the_place(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    robot.drive(COURSE[:1])
    client.call("graph_loc/create", "dock", "dock")
    robot.drive(SHORT)
    client.call("graph_loc/create", "dock", "dock")
    assert listed(client, "dock") == [("dock", "dock")]
    expected = compose(SHORT.T_map_odom, SHORT.T_odom_laser[-1])
    assert located(client, "dock", "dock") == pytest.approx(expected.tolist(), abs=0.02)
    assert len(load_map(path).locations) == 1


def test_an_empty_id_is_made_up(client: Client, robot: Robot) -> None:
    client.call("map/start", "")
    robot.drive(COURSE[:1])
    client.call("graph_loc/create", "a", "")
    client.call("graph_loc/create", "a", "")
    (_, first), (_, second) = listed(client, "a")
    assert uuid.UUID(first) != uuid.UUID(second)
    assert located(client, "a", first) == [0.0, 0.0, 0.0]


# ---- create when nothing is mapped ----


def test_create_needs_a_map(client: Client, mapped: Course) -> None:
    with Localiser(mapped.T_map_odom):
        until(lambda: client.call("graph_loc/is_ready"), "readiness")
        client.call("map/clear")
        assert not client.call("graph_loc/is_ready")
        assert "there is no map; call map/start or map/load first" in client.refusal("graph_loc/create", "a", "1")


def test_create_needs_mapping_that_goes_on(client: Client, robot: Robot) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/pause")
    assert not client.call("graph_loc/is_ready")
    refusal = client.refusal("graph_loc/create", "a", "1")
    assert refusal == "graph_loc/create: mapping is paused; call map/resume_from_paused first"


def test_create_needs_a_localiser(client: Client, robot: Robot, mapped: Course, path: str) -> None:
    until(lambda: not client.call("graph_loc/is_ready"), "the silence of the last test's localiser", 3.0)
    refusal = client.refusal("graph_loc/create", "a", "1")
    assert "start a localiser and wait until graph_loc/is_ready is true" in refusal
    turned = compose((0.3, -0.2, 0.1), mapped.T_map_odom)  # a localiser knows better than Oort's last word
    with Localiser(turned):
        until(lambda: client.call("graph_loc/is_ready"), "readiness")
        time.sleep(0.2)  # at first tf interpolates between what the last test's localiser said and this one
        client.call("graph_loc/create", "a", "1")
    expected = compose(turned, mapped.T_odom_laser[-1])
    assert located(client, "a", "1") == pytest.approx(expected.tolist(), abs=1e-6)
    assert [place[:2] for place in load_map(path).locations] == [("a", "1")]
    until(lambda: not client.call("graph_loc/is_ready"), "the localiser's silence", 3.0)
    assert "start a localiser" in client.refusal("graph_loc/create", "a", "2")


# ---- create_points ----


def test_create_points(client: Client, mapped: Course, path: str) -> None:
    client.call("graph_loc/create_points", ["a", "b"], points((0.5, 0.2), (-0.3, 0.4)), ["1", "1"])
    assert located(client, "a", "1") == pytest.approx([0.5, 0.2, 0.0])
    assert located(client, "b", "1") == pytest.approx([-0.3, 0.4, 0.0])
    saved = load_map(path)
    nodes = {node for _, _, node, _ in saved.locations}
    assert nodes == {int(np.argmin(np.hypot(*(saved.node_poses[:, :2] - (0.1, 0.3)).T)))}
    client.call("graph_loc/create_points", [], [], [])
    assert len(load_map(path).locations) == 2


def test_create_points_of_unlike_lengths(client: Client, mapped: Course) -> None:
    refusal = client.refusal("graph_loc/create_points", ["a"], points((0, 0), (1, 1)), ["1", "2"])
    assert "got 1 namespaces, 2 points and 2 ids; give one namespace and one id per point" in refusal
    assert client.call("graph_loc/list_namespaces") == []


def test_create_points_without_a_map(client: Client) -> None:
    refusal = client.refusal("graph_loc/create_points", ["a"], points((0, 0)), ["1"])
    assert "map something first" in refusal


# ---- read ----


def test_list(client: Client, places: list[tuple[str, str]]) -> None:
    assert listed(client, "kitchen") == places[1:3]
    assert listed(client, "kitchen", use_as_prefix=True) == places[1:4]
    assert listed(client, "k") == listed(client, "cellar") == listed(client, "cellar", use_as_prefix=True) == []
    assert listed(client, "k", use_as_prefix=True) == places[1:4]
    assert listed(client, "", use_as_prefix=True) == places
    assert client.call("graph_loc/list_namespaces") == ["dock", "kitchen", "kitchen/table", "hall"]


def test_locate_what_is_not_known(client: Client, places: list[tuple[str, str]]) -> None:
    refusal = client.refusal("graph_loc/locate", "kitchen", "3")
    assert refusal == "graph_loc/locate: no place 'kitchen'/'3'; graph_loc/list shows the known ones"
    client.call("map/clear")
    client.refusal("graph_loc/locate", "kitchen", "1")
    assert client.call("graph_loc/list_namespaces") == []


def test_places_outlive_the_node_on_disk(client: Client, places: list[tuple[str, str]], path: str) -> None:
    before = {place: located(client, *place) for place in places}
    client.call("map/clear")
    client.call("map/load", path)
    assert listed(client, "", use_as_prefix=True) == places
    assert {place: located(client, *place) for place in places} == before


# ---- delete ----


def test_delete(client: Client, places: list[tuple[str, str]], path: str) -> None:
    assert client.call("graph_loc/delete", "kitchen", "1") is True
    assert client.call("graph_loc/delete", "kitchen", "1") is False
    assert client.call("graph_loc/delete", "cellar", "1") is False
    assert listed(client, "kitchen") == [("kitchen", "2")]
    assert [place[:2] for place in load_map(path).locations] == [places[0], *places[2:]]


def test_clear(client: Client, places: list[tuple[str, str]], path: str) -> None:
    def clear(name_space: str, use_as_prefix: bool) -> list[tuple[str, str]]:
        answer = client.call("graph_loc/clear", name_space, use_as_prefix)
        return list(zip(answer.nspaces, answer.ids, strict=True))

    assert clear("kitchen", False) == places[1:3]
    assert clear("kitchen", True) == places[3:4]
    assert clear("cellar", True) == []
    assert [place[:2] for place in load_map(path).locations] == [places[0], places[4]]
    assert clear("", True) == [places[0], places[4]]
    assert client.call("graph_loc/list_namespaces") == []
    assert load_map(path).locations == []


# ---- typed ----


def test_as_typed(ros: Core, client: Client, places: list[tuple[str, str]]) -> None:
    def typed(*call: str) -> str:
        return ros.run("rosservice", "call", *call).stdout

    kitchen = " ".join(typed("/oort_slam/graph_loc/list", "kitchen", "true").split())
    assert kitchen == "nspaces: - kitchen - kitchen - kitchen/table ids: - '1' - '2' - '1'"
    assert 'frame_id: "map"' in typed("/oort_slam/graph_loc/locate", "dock", "dock")
    half = ros.run("rosservice", "call", "/oort_slam/graph_loc/create", "dock")  # it has two fields
    assert half.returncode == 2
    assert "Expected: ['nspace', 'id']" in half.stderr
