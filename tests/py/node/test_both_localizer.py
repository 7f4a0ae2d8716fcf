# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The localiser's node, in ROS 1 or in ROS 2: the same tests run under the Python of either (scripts/test.sh)."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sensor_msgs", reason="there is no ROS (scripts/setup.sh --ros or --ros2)")
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from helpers.course import COURSE
from helpers.saved_room import save_room
from node.peer import Peer, running, until
from node.rover import Rover
from oort.node.messages import yaw
from oort.poses import between

MODULE, NAME = "oort.node.localizer", "oort_localizer"


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> str:
    return save_room(tmp_path_factory.mktemp("map") / "room")


def test_it_finds_the_robot_and_follows_it(peer: Peer, tmp_path: Path, base: str) -> None:
    with running(peer, tmp_path, MODULE, name=NAME, map=base, start="global") as program:
        poses = peer.hear(f"/{NAME}/pose", PoseWithCovarianceStamped)
        states = peer.hear(f"/{NAME}/state", String, latched=True)
        tf = peer.hear("/tf", TFMessage)
        maps = peer.hear("/map", OccupancyGrid, latched=True)
        told = peer.hear("/diagnostics", DiagnosticArray)
        rover = Rover(peer, COURSE)
        rover.drive(COURSE, rate=50.0)
        until(lambda: states and states[-1].data == "tracking", "it tracks")
        until(lambda: poses and maps, "pose and map are told")
        ours = [one for message in list(tf) for one in message.transforms if one.header.frame_id == "map"]
        last = ours[-1].transform
        error = between(COURSE.T_map_odom, (last.translation.x, last.translation.y, yaw(last.rotation)))
        assert np.hypot(error[0], error[1]) < 0.06
        assert abs(error[2]) < 0.03
        assert poses[-1].header.frame_id == "map"
        assert poses[-1].pose.covariance[0] > 0.0
        assert peer.call(f"/{NAME}/is_localized", "GetBool").response.data
        until(lambda: told and told[-1].status[0].message == "Tracking", "diagnostics are content")

        refused = peer.call(f"/{NAME}/map/load", "SetString", data="/nowhere/map")
        assert not refused.success
        assert "nowhere" in refused.message
        assert peer.call(f"/{NAME}/is_localized", "GetBool").response.data, "what was there stays"
        assert peer.call(f"/{NAME}/relocalize", "Empty").success
        assert not peer.call(f"/{NAME}/is_localized", "GetBool").response.data

        wrong = PoseWithCovarianceStamped()
        wrong.header.frame_id = "elsewhere"
        peer.publisher("/initialpose", PoseWithCovarianceStamped)(wrong)
        until(lambda: "it is in frame elsewhere, not in map" in program.output, "a warning")


def test_a_map_that_is_not_there(peer: Peer, tmp_path: Path) -> None:
    with running(peer, tmp_path, MODULE, name=NAME, ready="", map="/nowhere/map") as program:
        assert program.process.wait(30.0) == 2
        (line,) = program.output.splitlines()
        assert line.startswith("[FATAL]")
        assert "/nowhere" in line
