# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the node says by itself: maps, transforms, the queue, saved files, diagnostics."""

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point, Pose2D
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import Int64, String
from visualization_msgs.msg import MarkerArray

from node.client import Client, Heard, HeardTransforms, figures, until
from node.robot import COURSE, EXTRAPOLATED, SHORT, Course, Robot
from oort import OccupancyGrid as Grid
from oort import Parameters, load_map, render_map
from oort.node.messages import yaw

pytest_plugins = ["node.fixtures"]
pytestmark = pytest.mark.usefixtures("cleared")


def seconds(message: Any) -> float:
    stamp: float = message.header.stamp.to_sec()
    return stamp


# ---- map and map_cleaned ----


def assert_shows(message: OccupancyGrid, grid: Grid) -> None:
    info = message.info
    assert (info.width, info.height) == (grid.width, grid.height)
    assert info.resolution == pytest.approx(grid.resolution)  # a float32
    assert (info.origin.position.x, info.origin.position.y) == grid.origin
    assert (info.origin.position.z, info.origin.orientation.w) == (0.0, 1.0)
    assert np.array_equal(np.array(message.data, np.int8).reshape(grid.height, grid.width), grid.cells)


def test_maps_are_there_for_who_comes_late(mapped: Course, path: str) -> None:
    with Heard("map", OccupancyGrid) as heard, Heard("map_cleaned", OccupancyGrid) as heard_cleaned:
        message, cleaned = heard.wait(), heard_cleaned.wait()
    for one in (message, cleaned):
        assert one.header.frame_id == "map"
        assert 0.0 <= time.time() - seconds(one) < 5.0
        assert one.info.map_load_time == one.header.stamp
    drawn, drawn_cleaned = render_map(load_map(path), Parameters())
    assert_shows(message, drawn)
    assert_shows(cleaned, drawn_cleaned)


def test_maps_while_mapping(client: Client, robot: Robot) -> None:
    """No oftener than once a second, and the last one when it stops."""
    with Heard("map", OccupancyGrid) as heard:
        started = time.time()
        client.call("map/start", "")
        robot.drive(COURSE, rate=40.0)  # three seconds
        stamps = [stamp for stamp in map(seconds, heard.messages) if stamp >= started]
        assert 2 <= len(stamps) <= 4
        assert np.diff(stamps).min() > 0.9
        stopped = time.time()
        client.call("map/stop")
        heard.wait_for(lambda message: seconds(message) >= stopped, "the last map", 1.0)


def test_calls_that_show_a_map(client: Client, mapped: Course, path: str) -> None:
    def assert_shows_both(*call: Any) -> None:
        called = time.time()
        client.call(*call)
        for topic in (heard, cleaned):
            topic.wait_for(lambda message: seconds(message) >= called, f"{call[0]} shows", 2.0)

    with Heard("map", OccupancyGrid) as heard, Heard("map_cleaned", OccupancyGrid) as cleaned:
        assert_shows_both("map/republish_maps")
        assert_shows_both("map/load", path)
        assert_shows_both("map/resume", f"{path}2", Pose2D(0.0, 0.0, 0.0))
        assert_shows_both("map/stop")


def test_clear_leaves_what_was_shown(client: Client, mapped: Course) -> None:
    client.call("map/clear")
    with Heard("map", OccupancyGrid) as heard:
        assert heard.wait().info.width > 0


def test_graph_for_who_comes_late(client: Client, mapped: Course) -> None:
    with Heard("/oort_slam/graph", MarkerArray) as heard:
        markers = {marker.ns: marker for marker in heard.wait().markers}
    assert len(markers["nodes"].points) == client.call("map/num_nodes")
    assert markers["chain"].header.frame_id == "map"


# ---- map -> odom ----


@pytest.fixture
def poses(client: Client) -> Iterator[HeardTransforms]:
    with HeardTransforms(client.name) as poses:
        yield poses


def value(transform: Any) -> tuple[float, float, float]:
    where = transform.transform
    return where.translation.x, where.translation.y, yaw(where.rotation)


def test_map_to_odom_while_mapping(client: Client, robot: Robot, poses: HeardTransforms) -> None:
    client.call("map/start", "")
    time.sleep(0.2)
    assert not poses.told  # nothing is known yet
    robot.drive(SHORT)
    until(lambda: len(poses.told) >= len(SHORT), "a transform for each scan")
    assert {(told.header.frame_id, told.child_frame_id) for told in poses.told} == {("map", "odom")}
    assert value(poses.told[-1]) == pytest.approx(SHORT.T_map_odom.tolist(), abs=0.05)
    before = len(poses.told)
    time.sleep(1.0)
    assert len(poses.told) - before >= 15, "without scans it goes on"
    stamps = [seconds(told) for told in poses.told]
    assert np.diff(stamps).min() > 0.0
    assert -0.2 < stamps[-1] - time.time() < 0.06


def test_map_to_odom_while_paused(client: Client, robot: Robot, poses: HeardTransforms) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/pause")
    last = len(poses.told) - 1
    robot.drive(COURSE[60:100])  # somebody carries it
    time.sleep(0.5)
    told = poses.told[last:]
    assert len(told) > 10
    assert {value(one) for one in told} == {value(told[0])}
    assert seconds(told[-1]) - seconds(told[0]) > 0.5


def test_no_map_to_odom_after_stop(client: Client, robot: Robot, poses: HeardTransforms) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/stop")
    time.sleep(0.1)  # for what is on its way
    before = len(poses.told)
    robot.drive(SHORT)
    time.sleep(0.3)
    assert len(poses.told) == before > 0


# ---- ~queue_size, ~file_changed ----


def test_queue_size(client: Client, robot: Robot) -> None:
    with Heard("/oort_slam/queue_size", Int64) as heard:
        started = time.monotonic()
        heard.wait(11)
        assert 0.8 < time.monotonic() - started < 1.6
        assert {message.data for message in heard.messages} == {0}
        robot.base_on = False
        client.call("map/start", "")
        stamps = robot.drive(SHORT[:20], odometry=False)
        heard.wait_for(lambda message: message.data == 20, "twenty in the queue")
        robot.tell_odometry(stamps, SHORT[:20])
        until(lambda: heard.messages[-1].data == 0, "an empty queue")


def test_file_changed(client: Client, robot: Robot, path: str) -> None:
    with Heard("/oort_slam/file_changed", String) as heard:

        def assert_next(said: str) -> None:
            expected.append(said)
            heard.wait(len(expected))
            time.sleep(0.05)
            assert [message.data for message in heard.messages] == expected

        expected: list[str] = []
        client.call("map/start", path)
        robot.drive(SHORT[:1])
        assert_next("map")
        client.call("graph_loc/create", "a", "1")
        assert_next("meta")
        robot.drive(SHORT)
        client.call("graph_loc/create", "a", "2")
        assert_next("map")  # for its node is not on the disk yet
        client.call("map/stop")
        assert_next("map")
        client.call("graph_loc/create_points", ["a"], [Point()], ["3"])
        assert_next("meta")
        client.call("map/load", path)
        client.call("graph_loc/delete", "a", "1")
        assert_next("meta")
        client.call("graph_loc/clear", "", True)
        assert_next("meta")
        client.call("map/clear")
        client.call("graph_loc/delete", "a", "1")
        client.call("map/stop")
        time.sleep(0.3)
        assert len(heard.messages) == len(expected)


# ---- diagnostics ----


def test_diagnostics_while_mapping(client: Client, robot: Robot, path: str) -> None:
    before = client.figures()
    client.call("map/start", path)
    robot.drive(COURSE, rate=100.0)
    all_scans = str(int(before["scans processed"]) + len(COURSE))
    with Heard("/diagnostics", DiagnosticArray) as heard:
        message = heard.wait_for(lambda message: figures(message)["scans processed"] == all_scans, "all scans", 10.0)
    (status,) = message.status
    assert (status.level, status.name, status.hardware_id) == (DiagnosticStatus.OK, "oort_slam: mapping", "oort")
    assert abs(time.time() - seconds(message)) < 1.0
    now = figures(message)
    assert status.message == f"Mapping, {now['nodes']} nodes"
    assert (now["state"], now["path"], now["tracking"]) == ("mapping", path, "tracking")
    assert int(now["nodes"]) == client.call("map/num_nodes")
    assert now["scans dropped"] == before["scans dropped"]
    assert 10.0 < float(now["scan rate [Hz]"]) < 110.0  # over the last five seconds
    assert float(now["inlier ratio"]) > 0.8
    assert 0.0 < float(now["ms per scan, median"]) < float(now["delay [ms], worst"])


def test_diagnostics_without_scans(client: Client) -> None:
    client.call("map/start", "")
    with Heard("/diagnostics", DiagnosticArray) as heard:
        message = heard.wait_for(lambda message: message.status[0].level, "a warning", 4.0)
    assert message.status[0].level == DiagnosticStatus.WARN
    assert message.status[0].message.startswith("No scan on /scan for ")


def test_odometry_that_comes_three_seconds_late(client: Client, robot: Robot) -> None:
    before = client.figures()
    client.call("map/start", "")
    robot.base_on = False
    scans = SHORT[:20]
    stamps = robot.drive(scans, odometry=False)
    with Heard("/diagnostics", DiagnosticArray) as heard:
        message = heard.wait_for(lambda message: "scans wait" in message.status[0].message, "a warning")
    assert message.status[0].level == DiagnosticStatus.WARN
    assert "20 scans wait: no odom -> base_footprint since " in message.status[0].message
    assert figures(message)["scans waiting"] == "20"
    assert "no odom -> base_footprint since " in client.node.output
    assert " s; 20 scans waiting" in client.node.output
    time.sleep(max(0.0, stamps[0].to_sec() + 3.0 - time.time()))
    robot.tell_odometry(stamps, scans)
    client.call("map/stop")
    after = client.figures()
    assert int(after["scans processed"]) - int(before["scans processed"]) == 20
    assert after["scans dropped"] == before["scans dropped"]


def test_scans_that_cannot_be_mapped_are_counted(client: Client, robot: Robot) -> None:
    def dropped(reason: str) -> int:
        return int(now.get(f"scans dropped, {reason}", 0)) - int(before.get(f"scans dropped, {reason}", 0))

    before = client.figures()
    client.call("map/start", "")
    robot.drive(replace(SHORT[:3], ranges=SHORT.ranges[:3, :0]))
    robot.base_on = False
    robot.drive(SHORT[:5], odometry=False)
    robot.drive(replace(SHORT[:2], angle_increment=float("nan")))
    time.sleep(2.0 * EXTRAPOLATED)
    robot.drive(SHORT[:4], odometry=False)
    started = time.monotonic()
    client.call("map/stop")
    assert 1.5 < time.monotonic() - started < 3.0  # as long as a call lets scans wait
    now = client.figures()
    assert (dropped("without readings"), dropped("unusable"), dropped("no odometry at its stamp")) == (3, 2, 4)
    assert "a scan was left out: " in client.node.output
