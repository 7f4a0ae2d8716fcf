# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The queue of the node: everything in its turn, nothing lost, and nobody who only asks has to wait."""

import re
import statistics
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("rospy")
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point
from rosgraph_msgs.msg import Log
from std_msgs.msg import Int64

from node.client import Client, Heard, figures, until
from node.robot import COURSE, EXTRAPOLATED, SHORT, Course, Robot, around_the_room
from oort import read_parameters
from oort.node.messages import rotation, yaw
from oort.poses import compose
from oort.recording.laser_scan import scan_from_message
from oort.recording.motion import Placement
from oort.session import Session

pytest_plugins = ["node.fixtures"]
pytestmark = pytest.mark.usefixtures("cleared")

READING = (
    ("map/state",),
    ("map/num_nodes",),
    ("map/name",),
    ("graph_loc/is_ready",),
    ("graph_loc/list", "", True),
    ("graph_loc/locate", "way", "a"),
)
FIGURES = ("scans received", "scans processed", "scans dropped")
LAPS = around_the_room(2)[:200]


def counted() -> list[int]:
    """FIGURES as they are now, not as they were when a message was made that is on its way."""
    asked = rospy.Time.now()
    with Heard("/diagnostics", DiagnosticArray) as diagnostics:
        told = figures(diagnostics.wait_for(lambda message: message.header.stamp > asked, "diagnostics of now"))
    return [int(told[name]) for name in FIGURES]


def wait_for_queue(size: int) -> None:
    with Heard("/oort_slam/queue_size", Int64) as queue:
        queue.wait_for(lambda told: told.data == size, f"{size} in the queue")


def map_of(course: Course, stamps: Sequence[rospy.Time], base: Path) -> Path:
    """The map of these scans, made without the node and saved."""
    session = Session(read_parameters(), tuple(course.T_base_laser.tolist()))
    session.start(str(base))
    for stamp, ranges, (x, y, theta) in zip(stamps, course.ranges, course.T_odom_base.tolist(), strict=True):
        scan = scan_from_message(
            whole_seconds=stamp.secs,
            nanoseconds=stamp.nsecs,
            angle_min=float(np.float32(course.angle_min)),
            angle_increment=float(np.float32(course.angle_increment)),
            range_min=float(np.float32(course.range_min)),
            range_max=float(np.float32(course.range_max)),
            ranges=ranges,
            placement=Placement((x, y, yaw(rotation(theta)))),
            upside_down=False,
        )
        session.add_scan(scan)
    session.stop()
    return base


def test_scans_whose_odometry_never_comes_are_named_and_counted(client: Client, robot: Robot) -> None:
    """They wait, and a call after them waits for them no longer than two seconds.

    The first test with this node, for it warns no oftener than every ten seconds.
    """
    client.call("map/start", "")
    robot.drive(SHORT)
    until(lambda: client.call("graph_loc/is_ready"), "the node is ready")
    before = client.figures()
    robot.base_on = False
    with Heard("/rosout", Log, "/oort_slam") as log, Heard("/diagnostics", DiagnosticArray) as diagnostics:
        time.sleep(2.0 * EXTRAPOLATED)
        robot.drive(COURSE[40:54], rate=500.0, odometry=False)
        complaint = log.wait_for(lambda line: "scans waiting" in line.msg, "a warning").msg
        assert re.fullmatch(r"no odom -> base_footprint since \d+\.\d s; 14 scans waiting", complaint)
        told = diagnostics.wait_for(lambda message: "scans wait:" in message.status[0].message, "a diagnosis")
        assert told.status[0].message.startswith("14 scans wait: no odom -> base_footprint since ")
        assert figures(told)["scans waiting"] == "14"
        client.call("map/stop")
        assert len([line for line in log.messages if "scans waiting" in line.msg]) == 1, "said now and then only"
    after = client.figures()
    reason = "scans dropped, no odometry at its stamp"
    assert int(after[reason]) - int(before.get(reason, "0")) == 14
    assert after["scans processed"] == before["scans processed"]


def test_stop_waits_for_late_odometry_and_nothing_is_lost(
    client: Client, robot: Robot, path: str, tmp_path: Path
) -> None:
    before = counted()
    robot.base_on = False
    client.call("map/start", path)
    stamps = robot.drive(LAPS, rate=500.0, odometry=False)
    wait_for_queue(200)
    with ThreadPoolExecutor() as threads:
        stopped = threads.submit(client.call, "map/stop")
        wait_for_queue(201)
        robot.tell_odometry(stamps[:100], LAPS[:100])
        wait_for_queue(101)
        assert not stopped.done()
        assert client.state == "mapping", "it takes effect in its turn"
        robot.tell_odometry(stamps[100:], LAPS[100:])
        stopped.result(20.0)
    assert client.state == "not_mapping"
    with Heard("/oort_slam/queue_size", Int64) as queue:
        assert queue.wait().data == 0
    assert [now - then for now, then in zip(counted(), before, strict=True)] == [200, 200, 0]
    again = map_of(LAPS, stamps, tmp_path / "map")
    for ending in ("map_capnp", "map_meta_capnp"):
        assert Path(f"{path}.{ending}").read_bytes() == Path(f"{again}.{ending}").read_bytes()


def test_pause_comes_in_its_turn(client: Client, robot: Robot) -> None:
    """The scans before it are mapped though their odometry came after it, and none after it."""
    before = counted()
    robot.base_on = False
    client.call("map/start", "")
    stamps = robot.drive(SHORT, rate=500.0, odometry=False)
    with ThreadPoolExecutor() as threads:
        paused = threads.submit(client.call, "map/pause")
        wait_for_queue(len(SHORT) + 1)
        later = robot.drive(COURSE[40:60], rate=500.0, odometry=False)
        wait_for_queue(len(SHORT) + 21)
        assert client.state == "mapping"
        robot.tell_odometry(stamps + later, COURSE[:60])
        paused.result(20.0)
    assert client.state == "paused"
    wait_for_queue(0)
    assert [now - then for now, then in zip(counted(), before, strict=True)] == [60, 40, 0]


def test_places_are_known_in_their_turn(client: Client, robot: Robot) -> None:
    """While the queue is behind, create returns at once; the place is where the robot was when it was asked for."""
    client.call("map/start", "")
    robot.drive(COURSE[:10])
    until(lambda: client.call("graph_loc/is_ready"), "the node is ready")
    robot.base_on = False
    parts = [COURSE[10:30], COURSE[30:50]]
    stamps = []
    for name, part in zip("ab", parts, strict=True):
        stamps.append(robot.drive(part, rate=500.0, odometry=False))
        wait_for_queue(20 * len(stamps) + len(stamps) - 1)
        client.call("graph_loc/create", "way", name)
    assert client.call("graph_loc/list", "way", False).ids == []
    assert "has not reached 'way'/'a' yet" in client.refusal("graph_loc/locate", "way", "a")
    robot.tell_odometry(stamps[0], parts[0])
    until(lambda: client.call("graph_loc/list", "way", False).ids == ["a"], "a is known")
    assert "has not reached 'way'/'b' yet" in client.refusal("graph_loc/locate", "way", "b")
    robot.tell_odometry(stamps[1], parts[1])
    until(lambda: client.call("graph_loc/list", "way", False).ids == ["a", "b"], "b is known")
    for name, part in zip("ab", parts, strict=True):
        x, y, theta = compose(COURSE.T_map_odom, part.T_odom_laser[-1]).tolist()
        pose = client.call("graph_loc/locate", "way", name).pose
        assert (pose.position.x, pose.position.y) == pytest.approx((x, y), abs=0.03)
        assert yaw(pose.orientation) == pytest.approx(theta, abs=0.03)


def test_create_right_after_start(client: Client, robot: Robot) -> None:
    """Clients of the original had to wait a second, for there was no pose yet."""
    robot.laser_on = True
    received = counted()[0]
    until(lambda: counted()[0] > received, "scans arrive")
    for _ in range(5):
        client.call("map/start", "")
        client.call("graph_loc/create", "dock", "dock")
        until(lambda: client.call("graph_loc/list", "dock", False).ids == ["dock"], "the dock is known")
        position = client.call("graph_loc/locate", "dock", "dock").pose.position
        assert (position.x, position.y) == pytest.approx((0.0, 0.0), abs=0.01)
        client.call("map/clear")


def test_readers_do_not_wait_for_a_busy_node(client: Client, robot: Robot) -> None:
    """Seconds of mapping are queued; those who ask get many answers before stop returns."""
    fine = replace(LAPS, ranges=np.repeat(LAPS.ranges, 40, axis=1), angle_increment=LAPS.angle_increment / 40)
    client.call("map/start", "")
    robot.drive(fine[:5])
    client.call("graph_loc/create", "way", "a")
    until(lambda: client.call("graph_loc/list", "way", False).ids == ["a"], "a is known")
    robot.base_on = False
    stamps = robot.drive(fine[5:], odometry=False)
    wait_for_queue(len(stamps))
    waits = []
    with ThreadPoolExecutor() as threads:
        stopped = threads.submit(client.call, "map/stop")
        wait_for_queue(len(stamps) + 1)
        robot.tell_odometry(stamps, fine[5:])
        while not stopped.done():
            for question in READING:
                started = time.monotonic()
                client.call(*question)
                waits.append(time.monotonic() - started)
        stopped.result()
    assert len(waits) > 20 * len(READING)
    assert statistics.median(waits) < 0.1
    assert max(waits) < 1.0


def test_many_clients_at_once(client: Client, robot: Robot) -> None:
    """No answer gets lost, and every place is there in the end."""
    client.call("map/start", "")
    robot.laser_on = True
    until(lambda: client.call("graph_loc/is_ready"), "the node is ready")

    def visit(number: int) -> None:
        for k in range(10):
            client.call("graph_loc/create", f"client/{number}", str(k))
            client.call("graph_loc/list", "client", True)
            client.call("graph_loc/create_points", [f"point/{number}"], [Point(k, number, 0.0)], [str(k)])
            client.call("map/map")
            if k % 2:
                assert client.call("graph_loc/delete", f"client/{number}", str(k))

    with ThreadPoolExecutor(8) as threads:
        visits = [threads.submit(visit, number) for number in range(8)]
        robot.drive(COURSE)
        for visited in visits:
            visited.result(60.0)
    client.call("map/stop")
    listed = client.call("graph_loc/list", "client", True)
    expected = {(f"client/{number}", str(k)) for number in range(8) for k in range(0, 10, 2)}
    assert set(zip(listed.nspaces, listed.ids, strict=True)) == expected
    assert len(client.call("graph_loc/list", "point", True).ids) == 80
