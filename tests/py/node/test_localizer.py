# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""oort_localizer: where the robot is on a saved map, told over ROS."""

import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from oort_msgs.srv import GetBool, SetString
from std_msgs.msg import String
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from helpers.saved_room import save_room
from node.client import Client, Heard, figures, until
from node.robot import COURSE, LASER, Localiser, Robot
from node.running import Core, Node
from oort.node.messages import rotation, yaw
from oort.poses import between, compose

pytestmark = pytest.mark.usefixtures("rospy")

NAME = "oort_localizer"


class Ears:
    """What the node tells."""

    def __init__(self) -> None:
        self.poses: list[PoseWithCovarianceStamped] = []
        self.states: list[str] = []
        self.maps: list[OccupancyGrid] = []
        self.map_to_odom: list[tuple[float, tuple[float, float, float]]] = []
        self._subscribers = [
            rospy.Subscriber(f"/{NAME}/pose", PoseWithCovarianceStamped, self.poses.append),
            rospy.Subscriber(f"/{NAME}/state", String, lambda message: self.states.append(message.data)),
            rospy.Subscriber("/map", OccupancyGrid, self.maps.append),
            rospy.Subscriber("/tf", TFMessage, self._on_tf),
        ]

    def _on_tf(self, message: Any) -> None:
        if message._connection_header["callerid"] != f"/{NAME}":
            return
        for transform in message.transforms:
            assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
            t = transform.transform
            pose = t.translation.x, t.translation.y, yaw(t.rotation)
            self.map_to_odom.append((transform.header.stamp.to_sec(), pose))

    def close(self) -> None:
        for subscriber in self._subscribers:
            subscriber.unregister()


@pytest.fixture
def ears() -> Iterator[Ears]:
    ears = Ears()
    yield ears
    ears.close()


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> str:
    return save_room(tmp_path_factory.mktemp("map") / "room")


@contextmanager
def localizer(ros: Core, tmp_path: Path, *args: str, ready: bool = True) -> Iterator[Node]:
    command = [sys.executable, "-m", "oort.node.localizer", f"__name:={NAME}", *args]
    node = Node(ros, NAME, command, tmp_path / "localizer.log", tmp_path)
    try:
        if ready:
            node.wait_until(lambda: "is ready" in node.output, "it did not say 'is ready'")
        yield node
    finally:
        node.stop()
        print(node.output)
        ros.forget_parameters()


def answer(service: str, kind: Any, *args: Any) -> Any:
    return rospy.ServiceProxy(f"/{NAME}/{service}", kind)(*args)


def check(ears: Ears) -> None:
    """The last transform is the true one, and so is the last pose."""
    assert ears.map_to_odom
    error = between(COURSE.T_map_odom, ears.map_to_odom[-1][1])
    assert np.hypot(error[0], error[1]) < 0.06
    assert abs(error[2]) < 0.03


def test_it_finds_the_robot_and_follows_it(ros: Core, tmp_path: Path, base: str, ears: Ears) -> None:
    with localizer(ros, tmp_path, f"_map:={base}", "_start:=global"), Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        robot.drive(COURSE, rate=50.0)
        until(lambda: ears.states[-1:] == ["tracking"], "it is tracking")
        check(ears)
        assert answer("is_localized", GetBool).data
        last = ears.poses[-1]
        truth = compose(COURSE.T_map_odom, COURSE.T_odom_base[-1])
        pose = last.pose.pose.position.x, last.pose.pose.position.y, yaw(last.pose.pose.orientation)
        assert np.hypot(*between(truth, pose)[:2]) < 0.06
        covariance = np.reshape(last.pose.covariance, (6, 6))
        assert np.linalg.eigvalsh(covariance[np.ix_([0, 1, 5], [0, 1, 5])])[0] > 0.0
        until(lambda: bool(ears.maps), "the map was shown")
        assert sum(cell == 0 for cell in ears.maps[-1].data) > 200
        count = len(ears.map_to_odom)
        until(lambda: len(ears.map_to_odom) > count + 10, "map -> odom goes on while the robot stands")
    saved = json.loads(Path(f"{base}.last_pose.json").read_text())
    assert np.hypot(*between(compose(truth, COURSE.T_base_laser), saved["T_map_sensor"])[:2]) < 0.06
    Path(f"{base}.last_pose.json").unlink()


def test_it_tells_how_it_goes(ros: Core, tmp_path: Path, base: str) -> None:
    with localizer(ros, tmp_path, f"_map:={base}", "_start:=dock") as node, Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        with Heard("/diagnostics", DiagnosticArray, f"/{NAME}") as told:
            told.wait_for(lambda message: message.status[0].level == DiagnosticStatus.WARN, "it misses the scans")
            assert told.messages[0].status[0].message.startswith("No scan has come on /scan; start the laser")
            robot.laser_on = True
            well = told.wait_for(lambda message: message.status[0].message == "Tracking", "all is well")
            assert (well.status[0].level, well.status[0].name) == (DiagnosticStatus.OK, f"{NAME}: localisation")
            values = figures(well)
            assert (values["state"], values["map"], values["jumps"]) == ("tracking", base, "0")
            assert float(values["support"]) > 0.8
            assert 0.0 < float(values["position deviation [m]"]) < 0.1
            assert int(values["scans matched"]) > 0
            with Localiser(COURSE.T_map_odom):
                told.wait_for(lambda message: figures(message)["map -> odom told by another"] == "yes", "it is silent")
        assert "Traceback" not in node.output


def test_it_says_which_transform_is_missing(ros: Core, tmp_path: Path, base: str) -> None:
    """That of the frame which the scans name, not of the parameters' sensor_frame."""
    args = f"_map:={base}", "_start:=dock", "_sensor_frame:=nowhere", "_base_frame:=no_base"
    with localizer(ros, tmp_path, *args), Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        robot.laser_on = True
        with Heard("/diagnostics", DiagnosticArray, f"/{NAME}") as told:
            told.wait_for(lambda message: f"no no_base -> {LASER} " in figures(message)["waiting for"], "it tells")


def test_it_begins_at_the_dock(ros: Core, tmp_path: Path, base: str, ears: Ears) -> None:
    with localizer(ros, tmp_path, f"_map:={base}", "_start:=dock"), Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        robot.laser_on = True
        until(lambda: ears.states[-1:] == ["tracking"], "it is tracking")
        until(lambda: bool(ears.map_to_odom), "map -> odom is told")
        check(ears)
        Path(f"{base}.last_pose.json").unlink(missing_ok=True)


def test_it_is_silent_while_another_program_tells_map_to_odom(ros: Core, tmp_path: Path, base: str, ears: Ears) -> None:
    with localizer(ros, tmp_path, f"_map:={base}", "_start:=dock"), Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        robot.laser_on = True
        until(lambda: bool(ears.map_to_odom), "map -> odom is told")
        with Localiser(COURSE.T_map_odom):
            time.sleep(0.5)
            count = len(ears.map_to_odom)
            time.sleep(0.5)
            assert len(ears.map_to_odom) == count
        until(lambda: len(ears.map_to_odom) > count, "it is told again")


def test_initial_pose_and_search(ros: Core, tmp_path: Path, base: str, ears: Ears) -> None:
    initial = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
    with localizer(ros, tmp_path, f"_map:={base}", "_start:=dock"), Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        robot.laser_on = True
        until(lambda: ears.states[-1:] == ["tracking"], "it is tracking")
        wrong = PoseWithCovarianceStamped()
        wrong.header.frame_id = "map"
        wrong.pose.pose.position.x, wrong.pose.pose.position.y = 1.5, 1.0
        wrong.pose.pose.orientation = rotation(2.0)
        wrong.pose.covariance = np.diag([0.01, 0.01, 0.0, 0.0, 0.0, 0.01]).ravel().tolist()
        until(lambda: initial.get_num_connections() > 0, "it listens to initialpose")
        initial.publish(wrong)
        until(lambda: "tracking" not in ears.states[-1:], "it doubts a wrong pose")
        answer("relocalize", Empty)
        robot.laser_on = False
        robot.drive(COURSE, rate=50.0)
        until(lambda: ears.states[-1:] == ["tracking"], "it is tracking again")
        check(ears)
    initial.unregister()


@pytest.mark.parametrize("call", ["relocalize", "map/load"])
def test_a_pose_of_before_is_told_no_more(ros: Core, tmp_path: Path, base: str, ears: Ears, call: str) -> None:
    """Not even while no scan comes: neither by tf nor as localised."""
    with localizer(ros, tmp_path, f"_map:={base}", "_start:=dock"), Robot(COURSE) as robot:
        robot.wait_for_node(f"/{NAME}")
        robot.laser_on = True
        until(lambda: ears.states[-1:] == ["tracking"], "it is tracking")
        until(lambda: bool(ears.map_to_odom), "map -> odom is told")
        robot.laser_on = False
        time.sleep(0.5)  # the last scan is worked off
        Path(f"{base}.last_pose.json").unlink(missing_ok=True)
        assert answer("is_localized", GetBool).data
        answer(call, *((Empty,) if call == "relocalize" else (SetString, base)))
        assert not answer("is_localized", GetBool).data
        until(lambda: ears.states[-1:] == ["searching"], "its state is told")
        time.sleep(0.2)
        count = len(ears.map_to_odom)
        time.sleep(0.5)
        assert len(ears.map_to_odom) == count
    assert not Path(f"{base}.last_pose.json").exists(), "nor kept"


def test_mapping_goes_on_where_the_localizer_sees_the_robot(ros: Core, tmp_path: Path, base: str, ears: Ears) -> None:
    mapping = Node(ros, "oort_slam", [sys.executable, "-m", "oort.node"], tmp_path / "oort_slam.log", tmp_path)
    try:
        mapping.wait_until(lambda: "is ready" in mapping.output, "it did not say 'is ready'")
        client = Client(mapping)
        client.call("map/load", base)
        assert "start a localiser" in client.refusal("map/resume_here", "")
        nodes = client.call("map/num_nodes")
        with localizer(ros, tmp_path, f"_map:={base}", "_start:=dock"), Robot(COURSE) as robot:
            robot.wait_for_node(f"/{NAME}")
            robot.wait_for_node("/oort_slam")
            robot.laser_on = True
            until(lambda: client.call("graph_loc/is_ready"), "the localiser is heard")
            client.call("map/resume_here", str(tmp_path / "longer"))
            robot.laser_on = False
            robot.drive(COURSE[:40], rate=50.0)
            count = len(ears.map_to_odom)
            robot.drive(COURSE[40:60], rate=50.0)
            assert len(ears.map_to_odom) <= count + 1  # mapping tells it now
            client.call("map/stop")
            assert client.call("map/num_nodes") > nodes
    finally:
        mapping.stop()
        print(mapping.output)


def test_another_map_is_loaded(ros: Core, tmp_path: Path, base: str) -> None:
    with localizer(ros, tmp_path, f"_map:={base}"):
        answer("map/load", SetString, base)
        with pytest.raises(rospy.ServiceException, match="nowhere"):
            answer("map/load", SetString, str(tmp_path / "nowhere"))


@pytest.mark.parametrize(
    ("args", "told"), [((), "~map must be the path"), (("_map:=x", "_start:=moon"), "~start one of auto")]
)
def test_wrong_settings(ros: Core, tmp_path: Path, args: tuple[str, ...], told: str) -> None:
    with localizer(ros, tmp_path, *args, ready=False) as node:
        assert node.process.wait(20.0) == 2
        assert told in node.output
