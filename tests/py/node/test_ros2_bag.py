# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""One drive in a bag of ROS 2: played to the node, or replayed with its log or without, it gives the same bytes."""

import time
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="there is no ROS 2 (scripts/setup.sh --ros2)")
from diagnostic_msgs.msg import DiagnosticArray
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from helpers.course import BASE, COURSE, LASER, ODOM
from helpers.recording_files import Bag, yaw_quaternion
from node.peer import running, until
from node.peer_rclpy import RclpyPeer
from oort.cli.replay import main as replay

NODE = "/oort_slam"
KINDS = {"/tf": TFMessage, "/scan": LaserScan}
RATE = 300.0  # [1/s] messages


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """The course at ten scans a second, each a little before odometry tells of its moment."""
    bag = Bag().tf(99.9, BASE, LASER, (*COURSE.T_base_laser[:2], 0.0), topic="/tf_static")
    for number, (x, y, theta) in enumerate(COURSE.T_odom_base.tolist()):
        begin = 100.0 + 0.1 * number
        bag.scan(begin, frame=LASER, ranges=COURSE.ranges[number].tolist())
        last = COURSE.angle_min + (COURSE.ranges.shape[1] - 1) * COURSE.angle_increment
        bag.messages[-1][3]["angles"] = COURSE.angle_min, last, COURSE.angle_increment
        for part in (0.0, 0.04, 0.08):
            bag.tf(begin + part, ODOM, BASE, (x, y, 0.0), yaw_quaternion(theta))
    return bag.ros2(tmp_path / "drive", StoragePlugin.MCAP)


def play(peer: RclpyPeer, bag: Path) -> None:
    """As `ros2 bag play` does: the messages' own bytes in their order."""
    with AnyReader([bag]) as reader:
        messages = [(connection.topic, bytes(raw)) for connection, _, raw in reader.messages()]
    fixed = peer.publisher("/tf_static", TFMessage, latched=True)
    publish = {topic: peer.publisher(topic, kind, reliable=True) for topic, kind in KINDS.items()}
    for topic, raw in messages:
        publish.get(topic, fixed)(raw)
        time.sleep(1.0 / RATE)


def files(base: Path) -> list[bytes]:
    return [base.with_name(base.name + ending).read_bytes() for ending in (".map_capnp", ".map_meta_capnp")]


def test_the_same_bytes(peer: RclpyPeer, tmp_path: Path, bag: Path) -> None:
    log, base = tmp_path / "events.json", tmp_path / "map"
    with running(peer, tmp_path, events_log=log):
        told = peer.hear("/diagnostics", DiagnosticArray)
        assert peer.call(f"{NODE}/map/start", "SetString", data=str(base)).success
        play(peer, bag)
        until(lambda: told and _figure(told[-1], "scans received") == str(len(COURSE)), "all scans have come")
        assert peer.call(f"{NODE}/map/stop", "Empty").success
        until(lambda: _figure(told[-1], "scans processed") == str(len(COURSE)), "all scans are mapped")
    played = files(base)
    for name, options in {"log": ["--events", str(log)], "alone": []}.items():
        assert replay([str(bag), *options, "--out", str(tmp_path / name), "--quiet"]) == 0
        assert files(tmp_path / name / "map") == played, name


def _figure(message: DiagnosticArray, key: str) -> str:
    return str({item.key: item.value for item in message.status[0].values}[key])
