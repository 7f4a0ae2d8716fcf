# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What is there in ROS 2 alone: the names that users of slam_toolbox know, namespaces, parameters, qualities, time."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="there is no ROS 2 (scripts/setup.sh --ros2)")
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from helpers.course import COURSE, SHORT
from node.peer import running, until
from node.peer_rclpy import RclpyPeer
from node.rover import Rover
from oort import load_map
from oort.export.map_server import read_map_server

NODE = "/oort_slam"


def ask(peer: RclpyPeer, service: str, kind: str = "Empty", node: str = NODE, **fields: Any) -> Any:
    reply = peer.call(f"{node}/{service}", kind, **fields)
    assert reply.success, reply.message
    return reply.response


@pytest.mark.parametrize("module", ["oort.node", "oort.node.localizer"])
def test_without_the_ros_that_is_asked_for(module: str) -> None:
    asked = {**os.environ, "ROS_VERSION": "1"}
    ended = subprocess.run(
        [sys.executable, "-P", "-m", module], env=asked, capture_output=True, text=True, timeout=60.0, check=False
    )
    assert ended.returncode == 1
    (line,) = ended.stderr.splitlines()
    assert "no module named 'rospy'. The node needs ROS 2, whose setup.bash is to be sourced" in line


def test_slam_toolboxs_names(peer: RclpyPeer, tmp_path: Path) -> None:
    with running(peer, tmp_path):
        refused = peer.call(f"{NODE}/save_map", "SetString", data="maps/home")
        assert refused.message.startswith("save_map: the path 'maps/home' is not absolute")
        poses = peer.hear("/pose", PoseWithCovarianceStamped)
        rover = Rover(peer, COURSE)
        ask(peer, "map/start", "SetString", data=str(tmp_path / "own"))
        stamps = rover.drive(COURSE[:80])
        until(lambda: len(poses) >= 75, "poses of the base")
        assert {peer.seconds(one.header.stamp) for one in poses} <= {peer.seconds(stamp) for stamp in stamps}

        ask(peer, "save_map", "SetString", data=str(tmp_path / "shown" / "home.yaml"))
        grid = peer.call_type(f"{NODE}/dynamic_map", GetMap).map
        saved = read_map_server(tmp_path / "shown" / "home.yaml")
        assert saved.cells.shape == (grid.info.height, grid.info.width)
        info = peer.hear("/map_metadata", MapMetaData, latched=True)
        until(info.__len__, "map_metadata comes to who listens late")
        assert info[-1].resolution == pytest.approx(saved.resolution)

        ask(peer, "serialize_map", "SetString", data=str(tmp_path / "copy"))
        nodes = len(load_map(str(tmp_path / "copy")).node_poses)
        assert nodes > 5
        ask(peer, "pause_new_measurements")
        assert ask(peer, "map/state", "GetString").data == "paused"
        ask(peer, "pause_new_measurements")
        assert ask(peer, "map/state", "GetString").data == "mapping"
        ask(peer, "reset")
        assert load_map(str(tmp_path / "own.previous")), "the map of before is kept"
        assert ask(peer, "map/state", "GetString").data == "mapping"
        assert ask(peer, "map/num_nodes", "GetUInt").data == 0
        ask(peer, "deserialize_map", "SetString", data=str(tmp_path / "copy"))
        assert ask(peer, "map/num_nodes", "GetUInt").data == nodes


def test_two_robots_on_one_machine(peer: RclpyPeer, tmp_path: Path) -> None:
    """Each has its topics and its tf under its namespace; /tf is remapped as nav2's launch files do it."""

    def robot(name: str) -> Any:
        remappings = {"__ns": f"/{name}", "/tf": "tf", "/tf_static": "tf_static"}
        return running(peer, tmp_path, name="slam", remappings=remappings)

    with robot("one"), robot("two"):
        rover = Rover(peer, SHORT, scan="/one/scan", tf="/one/tf")
        heard = {name: peer.hear(f"/{name}/tf", TFMessage) for name in ("one", "two")}
        for name in ("one", "two"):
            ask(peer, "map/start", "SetString", node=f"/{name}/slam", data="")
        rover.drive(SHORT)
        assert ask(peer, "map/stop", node="/one/slam")
        assert ask(peer, "map/num_nodes", "GetUInt", node="/one/slam").data > 2
        assert ask(peer, "map/num_nodes", "GetUInt", node="/two/slam").data == 0
        maps = peer.hear("/one/map", OccupancyGrid, latched=True)
        until(maps.__len__, "the first robot's map")
        assert any(one.header.frame_id == "map" for message in heard["one"] for one in message.transforms)
        assert not heard["two"]


def test_parameters(peer: RclpyPeer, tmp_path: Path) -> None:
    config = tmp_path / "params.yaml"
    config.write_text(
        "/**:\n  ros__parameters:\n    linear_update: 0.5\n    output_map:\n      robot_radius: 0.2\n"
        "    mask: [-0.1, 0.1]\n"
    )
    with running(peer, tmp_path, extra=("--params-file", str(config))):
        names = ["linear_update", "output_map.robot_radius", "base_frame"]
        values = peer.call_type(f"{NODE}/get_parameters", GetParameters, names=names).values
        assert [values[0].double_value, values[1].double_value] == [0.5, 0.2]
        assert values[2].string_value == "base_footprint"
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.1)
        change = Parameter(name="linear_update", value=value)
        (result,) = peer.call_type(f"{NODE}/set_parameters", SetParameters, parameters=[change]).results
        assert not result.successful
        assert result.reason.startswith("linear_update: Oort reads its parameters when it starts; set it there")


def test_qualities(peer: RclpyPeer, tmp_path: Path) -> None:
    with running(peer, tmp_path):
        until(lambda: peer.node.count_publishers("/map"), "map")
        (offered,) = peer.node.get_publishers_info_by_topic("/map")
        assert offered.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        assert offered.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        until(lambda: peer.node.count_subscribers("/scan"), "scan")  # is found on its own
        (asked,) = peer.node.get_subscriptions_info_by_topic("/scan")
        assert asked.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT


def test_simulated_time(peer: RclpyPeer, tmp_path: Path) -> None:
    with running(peer, tmp_path, use_sim_time=True):
        tick = peer.publisher("/clock", Clock)
        rover = Rover(peer, SHORT)
        tf = peer.hear("/tf", TFMessage)
        ask(peer, "map/start", "SetString", data="")
        for number in range(len(SHORT)):
            stamp = Time(sec=100, nanosec=number * 10_000_000)
            tick(Clock(clock=stamp))
            rover.scan(SHORT, number, stamp)
            rover.tell_odometry(SHORT, number, stamp)
        until(lambda: _of_map(tf), "map -> odom is told")  # its way here is another than that of the answer to the stop
        ask(peer, "map/stop")
        assert np.all([100.0 <= peer.seconds(one.header.stamp) <= 100.5 for one in _of_map(tf)])


def _of_map(told: list[TFMessage]) -> list[TransformStamped]:
    return [one for message in list(told) for one in message.transforms if one.header.frame_id == "map"]
