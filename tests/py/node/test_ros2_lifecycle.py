# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The localiser in ROS 2: its lifecycle as nav2's manager drives it, and amcl's names."""

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy", reason="there is no ROS 2 (scripts/setup.sh --ros2)")
from bond.msg import Status
from geometry_msgs.msg import PoseWithCovarianceStamped
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import OccupancyGrid
from std_srvs.srv import Empty

from helpers.course import COURSE
from helpers.saved_room import save_room
from node.peer import running, until
from node.peer_rclpy import RclpyPeer
from node.rover import Rover

MODULE, NAME = "oort.node.localizer", "oort_localizer"


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> str:
    return save_room(tmp_path_factory.mktemp("map") / "room")


def state(peer: RclpyPeer) -> int:
    return int(peer.call_type(f"/{NAME}/get_state", GetState).current_state.id)


def change(peer: RclpyPeer, transition: int) -> bool:
    request = {"transition": Transition(id=transition)}
    return bool(peer.call_type(f"/{NAME}/change_state", ChangeState, **request).success)


def test_a_manager_starts_and_stops_it(peer: RclpyPeer, tmp_path: Path, base: str) -> None:
    wait: dict[str, Any] = {"ready": "waits to be configured", "autostart": False}
    with running(peer, tmp_path, MODULE, name=NAME, map=base, start="dock", **wait):
        assert state(peer) == State.PRIMARY_STATE_UNCONFIGURED
        assert change(peer, Transition.TRANSITION_CONFIGURE)
        assert state(peer) == State.PRIMARY_STATE_INACTIVE
        maps = peer.hear("/map", OccupancyGrid, latched=True)
        poses = peer.hear("/amcl_pose", PoseWithCovarianceStamped, latched=True)
        until(maps.__len__, "the map, when it is configured")
        rover = Rover(peer, COURSE)
        rover.drive(COURSE[:20])
        assert not poses, "an inactive node is silent"
        assert change(peer, Transition.TRANSITION_ACTIVATE)
        assert state(peer) == State.PRIMARY_STATE_ACTIVE
        rover.drive(COURSE[20:60])
        until(poses.__len__, "poses, when it is active")
        bonds = peer.hear("/bond", Status)
        until(lambda: len(bonds) > 2, "nav2's manager sees its bond")
        assert {(one.id, one.active) for one in bonds} == {(NAME, True)}
        for transition in (Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP):
            assert change(peer, transition)
        assert state(peer) == State.PRIMARY_STATE_UNCONFIGURED
        until(lambda: peer.node.count_publishers("/map") == 0, "its topics are gone")
        assert not bonds[-1].active
        for transition in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE):
            assert change(peer, transition)
        assert state(peer) == State.PRIMARY_STATE_ACTIVE


def test_what_cannot_be_configured_says_why_and_lives(peer: RclpyPeer, tmp_path: Path) -> None:
    wait: dict[str, Any] = {"ready": "waits to be configured", "autostart": False}
    with running(peer, tmp_path, MODULE, name=NAME, map="/nowhere/map", **wait) as program:
        assert not change(peer, Transition.TRANSITION_CONFIGURE)
        until(lambda: "/nowhere: cannot open the folder" in program.output, "the reason")
        assert state(peer) == State.PRIMARY_STATE_UNCONFIGURED


def test_amcls_names(peer: RclpyPeer, tmp_path: Path, base: str) -> None:
    with running(peer, tmp_path, MODULE, name=NAME, map=base, start="global"):
        assert state(peer) == State.PRIMARY_STATE_ACTIVE, "it activates itself"
        poses = peer.hear("/amcl_pose", PoseWithCovarianceStamped, latched=True)
        there = PoseWithCovarianceStamped()
        there.header.frame_id = "elsewhere"
        refused = peer.call("/set_initial_pose", "SetPose", pose=there)
        assert (refused.success, refused.message) == (False, "it is in frame elsewhere, not in map")
        rover = Rover(peer, COURSE)
        rover.drive(COURSE[:2])
        there.header.frame_id = "map"
        x, y, _ = (-COURSE.T_base_laser).tolist()  # the map begins at the first scan's sensor
        there.pose.pose.position.x, there.pose.pose.position.y = x, y
        there.pose.pose.orientation.w = 1.0
        accepted = peer.call("/set_initial_pose", "SetPose", pose=there)
        assert accepted.success, accepted.message
        rover.drive(COURSE[2:40])
        until(lambda: peer.call(f"/{NAME}/is_localized", "GetBool").response.data, "it tracks from there")
        assert poses
        peer.call_type("/reinitialize_global_localization", Empty)
        assert not peer.call(f"/{NAME}/is_localized", "GetBool").response.data
        assert peer.call(f"/{NAME}/load_map", "SetString", data=base).success
