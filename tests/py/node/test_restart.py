# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The node's ends and begins: killed at any moment it leaves whole files, and another one goes on with them."""

import math
import os
import random
import signal
import threading
import time
import xmlrpc.client
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
import rospy as ros_client
from geometry_msgs.msg import Pose2D
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int64, String

from node.client import Client, Heard, until
from node.conftest import NodeFactory
from node.robot import COURSE, SHORT, Course, Robot, of_drive
from node.running import Core, Node
from oort import load_map, read_parameters
from oort.events import SCAN, read_events
from oort.poses import between, compose
from oort.recording.types import Scan
from oort.session import Session
from oort.simulate import SimulationConfig, simulate_drive

LIFE = 1.2  # [s] that a node which will be killed maps at most
PART = 250  # scans, of more than a life


@pytest.fixture(scope="module")
def course() -> Course:
    """Through all rooms of a home."""
    return of_drive(simulate_drive(4, SimulationConfig(minutes=1)))


@pytest.fixture(scope="module")
def home(course: Course, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The map of it, which is large enough for its saving to take a while."""
    base = str(tmp_path_factory.mktemp("home") / "map")
    session = Session(read_parameters(), tuple(course.T_base_laser.tolist()))
    session.start(base)
    limits = course.angle_min, course.angle_increment, course.range_min, course.range_max
    for k, pose in enumerate(course.T_odom_base.tolist()):
        session.add_scan(Scan(course.ranges[k], *limits, 0.1 * k, stamp=f"{0.1 * k:.1f}", odometry=tuple(pose)))
    session.stop()
    return base


@contextmanager
def hurried_clock() -> Iterator[None]:
    """The time of ROS passes so fast that a save is always due."""
    ended = threading.Event()
    clock = ros_client.Publisher("/clock", Clock, queue_size=1)

    def tick() -> None:
        now = 1e9
        while not ended.wait(0.01):
            now += 16.0
            clock.publish(ros_client.Time.from_sec(now))

    thread = threading.Thread(target=tick)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        clock.unregister()


def go_on(client: Client, base: str, path: str, course: Course, start: int) -> None:
    """As a robot does that has come back: with the last map, from about where it stands."""
    x, y, theta = compose(course.T_map_odom, course.T_odom_laser[start]).tolist()
    client.call("map/load", base)
    client.call("map/resume", path, Pose2D(x, y, theta))
    assert client.state == "mapping"


def scans_in(log: Path) -> int:
    return [event.call for event in read_events(log)].count(SCAN)


def wait_for_a_save(folder: Path, timeout: float) -> None:
    """Until files are being written into a folder; looks without a rest, for that does not take long."""
    deadline = time.monotonic() + timeout
    while time.monotonic() < deadline and not any(name.endswith(".new") for name in os.listdir(folder)):
        pass


@pytest.mark.parametrize("kills", [5, pytest.param(100, marks=pytest.mark.slow)])
def test_killed_at_any_moment(
    ros: Core, rospy: Any, node: NodeFactory, course: Course, home: str, tmp_path: Path, kills: int
) -> None:
    """A chain of nodes: each goes on with the map that the one before has left, and is killed while it maps.

    Every second one is killed while it saves.
    """
    chance = random.Random(1)
    ros.set_parameter("/use_sim_time", True)
    base, nodes = home, len(load_map(home))
    with hurried_clock():
        for k in range(kills):
            log, path = tmp_path / f"{k}.json", str(tmp_path / f"{k}" / "map")
            start = chance.randrange(len(course) - PART)
            # With no view pruned, fewer nodes would be a loss.
            running = node(f"_events_log:={log}", "_keep_views:=0")
            with Robot(course[start:]) as robot, Heard("/oort_slam/file_changed", String) as saves:
                robot.wait_for_node()
                go_on(Client(running), base, path, course, start)
                driving = threading.Thread(target=robot.drive, args=(course[start : start + PART],))
                driving.start()
                time.sleep(chance.uniform(0.0, LIFE))
                if k % 2:
                    wait_for_a_save(Path(path).parent, LIFE)
                running.stop(signal.SIGKILL)
                driving.join()
            assert [event.call for event in read_events(log)][:2] == ["map/load", "map/resume"]
            print(f"node {k} has saved {len(saves.messages)} times and leaves", sorted(os.listdir(Path(path).parent)))
            if saves.messages or Path(f"{path}.md5").exists():
                left = len(load_map(path))
                assert left >= nodes
                base, nodes = path, left
    assert nodes > len(load_map(home)), "none of them has saved anything new"


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_saves(rospy: Any, node: NodeFactory, tmp_path: Path, ending: signal.Signals) -> None:
    """All that has come is mapped and saved, though nobody has called map/stop."""
    log, path = tmp_path / "log.json", str(tmp_path / "map")
    running = node(f"_events_log:={log}")
    client = Client(running)
    with Robot(COURSE) as robot, Heard("/oort_slam/file_changed", String) as saves:
        robot.wait_for_node()
        client.call("map/start", path)
        robot.drive(SHORT)
        until(lambda: scans_in(log) == len(SHORT), "all scans are mapped")
        saves.wait()
        nodes = client.call("map/num_nodes")
        assert len(load_map(path)) < nodes, "the last save was with the first node"
    assert running.stop(ending) == 0
    assert len(load_map(path)) == nodes
    assert sorted(file.name for file in tmp_path.glob("map*")) == ["map.map_capnp", "map.map_meta_capnp", "map.md5"]


def test_a_signal_maps_what_is_queued(rospy: Any, node: NodeFactory, tmp_path: Path) -> None:
    """Also where the queue is long: the last node is where the last scan was."""
    way = COURSE[:100]
    slow = replace(way, ranges=np.repeat(way.ranges, 20, axis=1), angle_increment=way.angle_increment / 20)
    running = node()
    client = Client(running)
    with Robot(slow) as robot, Heard("/oort_slam/queue_size", Int64) as queue:
        robot.wait_for_node()
        client.call("map/start", str(tmp_path / "map"))
        robot.base_on = False
        stamps = robot.drive(slow, odometry=False)
        queue.wait_for(lambda size: size.data == len(slow), "all scans are queued")
        robot.tell_odometry(stamps, slow)
        queue.wait_for(lambda size: 0 < size.data < len(slow), "the first scans are mapped")
        assert running.stop() == 0
    last = load_map(str(tmp_path / "map")).node_poses[-1]
    x, y, theta = between(last, compose(slow.T_map_odom, slow.T_odom_laser[-1])).tolist()
    assert math.hypot(x, y) < float(read_parameters().get("linear_update")) + 0.02
    assert abs(theta) < float(read_parameters().get("angular_update")) + 0.02


def process_of(ros: Core, node: str) -> int:
    """The process id, which the node itself tells."""
    slave: Any
    with xmlrpc.client.ServerProxy(ros.master("lookupNode", node)) as slave:
        return int(slave.getPid("/oort_tests")[2])


def test_respawned_by_roslaunch(ros: Core, rospy: Any, home: str, course: Course, tmp_path: Path) -> None:
    """Killed, it comes back ten seconds later by itself; its client loads the map and goes on."""
    command = ["roslaunch", "oort", "oort.launch", "respawn:=true", "scan:=scan_reduced_mapping"]
    log = tmp_path / "log.json"
    command.append(f"events_log:={log}")
    launched = Node(ros, "oort_slam", command, tmp_path / "roslaunch.log", tmp_path)
    client = Client(launched)
    first, second = str(tmp_path / "first" / "map"), str(tmp_path / "second" / "map")
    try:
        launched.wait_for_service("map/stop")
        killed = process_of(ros, "/oort_slam")
        with Robot(course, "scan_reduced_mapping") as robot:
            robot.wait_for_node()
            client.call("map/start", first)
            robot.drive(course[:200])
            until(lambda: scans_in(log) == 200, "all scans are mapped")
            until(lambda: Path(f"{first}.md5").exists(), "the first save")
            os.kill(killed, signal.SIGKILL)
            until(lambda: not ros.service_answers("/oort_slam/map/stop"), "it is gone")
        launched.wait_for_service("map/stop", 40.0)
        assert process_of(ros, "/oort_slam") != killed
        assert scans_in(Path(f"{log}.1")) == 200, "the log of the killed one stays"
        assert client.state == "not_mapping"
        with Robot(course[200:], "scan_reduced_mapping") as robot:
            robot.wait_for_node()
            go_on(client, first, second, course, 200)
            robot.drive(course[200:400])
            client.call("map/stop")
        assert len(load_map(second)) == client.call("map/num_nodes") > len(load_map(first))
    finally:
        assert launched.stop() == 0
