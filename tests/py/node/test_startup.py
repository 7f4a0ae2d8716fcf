# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How the node is asked to run: its name, remappings, frames and parameters, and what it says if it cannot."""

import json
import socket
import urllib.request
from collections.abc import Callable, Iterator
from typing import Any

import pytest

pytest.importorskip("rospy")
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Pose2D
from nav_msgs.msg import OccupancyGrid

from helpers.scenes import room_scan
from node.client import Client, Heard, HeardTransforms, this_process, until
from node.conftest import NodeFactory
from node.robot import SHORT, Localiser, Robot
from node.running import Core
from oort import ParameterError, Parameters
from oort.node.settings import Settings, ViewSettings, read_settings
from oort.session import Session

pytestmark = pytest.mark.usefixtures("rospy")


@pytest.fixture(scope="module")
def saved_map(tmp_path_factory: pytest.TempPathFactory) -> str:
    base = str(tmp_path_factory.mktemp("map") / "room")
    session = Session(Parameters())
    session.start(base)
    for step in range(5):
        session.add_scan(room_scan(-1.0 + 0.25 * step, 0.0, 0.0, 100.0 + step))
    session.stop()
    return base


# ---- names ----


def test_as_kuris_programs_know_it(node: NodeFactory, ros: Core) -> None:
    client = Client(node("scan:=scan_reduced_mapping", name="oort_ros_mapping"))
    with (
        Robot(SHORT, scan_topic="scan_reduced_mapping") as robot,
        Heard("/diagnostics", DiagnosticArray, client.name) as told,
    ):
        robot.wait_for_node(client.name)
        client.call("map/start", "")
        robot.drive(SHORT)
        client.call("map/stop")
        assert client.call("map/num_nodes") > 2
        assert told.wait().status[0].name == "oort_ros_mapping: mapping"
    assert ros.run("rosservice", "call", "oort_ros_mapping/map/state").stdout == 'data: "not_mapping"\n'
    published = {topic for topic, providers in ros.master("getSystemState")[0] if client.name in providers}
    private = {f"/oort_ros_mapping/{topic}" for topic in ("queue_size", "file_changed", "graph")}
    assert published == private | {"/map", "/map_cleaned", "/tf", "/diagnostics", "/rosout"}


# ---- frames ----


def test_scans_in_another_frame_than_the_parameters_say(node: NodeFactory) -> None:
    client = Client(node())
    with Robot(SHORT, laser="depth_camera_link") as robot, Localiser(SHORT.T_map_odom):
        robot.wait_for_node()
        client.call("map/start", "")
        robot.drive(SHORT)
        client.call("map/stop")
        assert client.call("map/num_nodes") > 2
        until(lambda: client.call("graph_loc/is_ready"), "a pose of the laser that is there")
    assert (
        "the scans are in frame depth_camera_link, not in the sensor_frame hokuyo_laser_link of the parameters; "
        "using depth_camera_link"
    ) in client.node.output


def test_frames_with_a_slash_and_frames_by_parameter(node: NodeFactory) -> None:
    """Old programs begin frames with a slash."""
    client = Client(node("_sensor_frame:=/eye", "_map_frame:=/world", "_output_map/probability_grid/resolution:=0.1"))
    with Robot(SHORT, laser="/eye") as robot, HeardTransforms() as tf, Heard("map", OccupancyGrid) as maps:
        robot.wait_for_node()
        client.call("map/start", "")
        robot.drive(SHORT)
        client.call("graph_loc/create", "a", "1")
        client.call("map/stop")
        assert {(one.header.frame_id, one.child_frame_id) for one in tf.told} == {("world", "odom")}
        shown = maps.messages[-1]
        assert shown.header.frame_id == "world"
        assert shown.info.resolution == pytest.approx(0.1)
    assert client.call("graph_loc/locate", "a", "1").header.frame_id == "world"
    assert "the scans are in frame" not in client.node.output


def test_no_transforms_at_all(node: NodeFactory) -> None:
    client = Client(node())
    with Heard("/diagnostics", DiagnosticArray) as told, Robot(SHORT) as robot:
        robot.base_on = False
        robot.wait_for_node()
        client.call("map/start", "")
        stamps = robot.drive(SHORT, odometry=False)
        message = told.wait_for(lambda message: "scans wait" in message.status[0].message, "a warning")
        said = "no odom -> base_footprint (tf has base_footprint -> hokuyo_laser_link)"
        assert f"{len(SHORT)} scans wait: {said}; check who publishes this transform" in message.status[0].message
        assert f"{said}; {len(SHORT)} scans waiting" in client.node.output
        robot.tell_odometry(stamps, SHORT)
        client.call("map/stop")
        assert client.call("map/num_nodes") > 2


# ---- a map to begin with ----


def test_load_and_resume(node: NodeFactory, saved_map: str) -> None:
    client = Client(node(f"_load:={saved_map}"))
    until(lambda: client.call("map/has_map"), "the map")
    assert (client.call("map/name"), client.call("map/num_nodes"), client.state) == (saved_map, 5, "not_mapping")
    with Heard("map", OccupancyGrid) as heard:
        assert sum(cell == 0 for cell in heard.wait().data) > 200
    with Robot(SHORT) as robot:
        robot.wait_for_node()
        client.call("map/resume", f"{saved_map}2", Pose2D(-1.0, 0.0, 0.0))
        robot.drive(SHORT)
        client.call("map/stop")
    assert client.call("map/num_nodes") > 7
    assert "left out" not in client.node.output


def test_the_node_shows_its_view(node: NodeFactory, saved_map: str) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    client = Client(node(f"_load:={saved_map}", f"_view_port:={port}"))
    until(lambda: client.call("map/has_map"), "the map")
    assert f"/oort_slam is shown at http://127.0.0.1:{port}/" in client.node.output
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/map", timeout=10.0) as response:
        assert json.load(response)["grid"]["resolution"] == pytest.approx(0.05)


# ---- what cannot be ----


@pytest.mark.parametrize(
    ("argument", "told"),
    [
        (
            "_base_fram:=base_link",
            'ROS parameter /oort_slam/base_fram: unknown parameter "base_fram"; the nearest known is "base_frame"',
        ),
        ("_load:=/nowhere/map", "/nowhere"),
    ],
)
def test_it_does_not_begin(node: NodeFactory, argument: str, told: str) -> None:
    running = node(argument, ready=None)
    assert running.process.wait(20.0) == 2
    (line,) = running.output.splitlines()
    assert line.startswith("[FATAL] ")
    assert told in line


@pytest.fixture
def parameter(ros: Core) -> Iterator[Callable[[str, Any], None]]:
    """Sets a private ROS parameter of the test's own process, which read_settings() then reads."""
    yield lambda name, value: ros.set_parameter(f"/oort_tests/{name}", value)
    ros.forget_parameters()


def settings_of_this_process() -> Settings:
    return read_settings(this_process(), ["load", "events_log"])


def test_settings(parameter: Callable[[str, Any], None]) -> None:
    assert settings_of_this_process().parameters.to_dict() == Parameters().to_dict()
    parameter("linear_update", 0.5)
    parameter("output_map/robot_radius", 1)  # rosparam makes an integer of "1"
    parameter("load", "/maps/7")
    settings = settings_of_this_process()
    assert (settings.own["load"], settings.own["events_log"]) == ("/maps/7", "")
    assert settings.parameters.get("linear_update") == 0.5
    assert settings.parameters.get("output_map.robot_radius") == 1.0
    assert settings.view is None


def test_the_view_is_asked_for(parameter: Callable[[str, Any], None]) -> None:
    parameter("view_port", 8765)
    assert settings_of_this_process().view == ViewSettings(8765, "127.0.0.1", False)
    parameter("view_control", True)
    parameter("view_address", "0.0.0.0")
    assert settings_of_this_process().view == ViewSettings(8765, "0.0.0.0", True)


def test_a_viewer_of_the_original_is_missed(parameter: Callable[[str, Any], None]) -> None:
    parameter("incremental_graph_builder/frsm_matcher/debug", True)
    with pytest.warns(UserWarning, match=r"frsm_matcher\.debug: the original's viewer is not there"):
        settings_of_this_process()


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("output_map/robot_radus", 0.2, r'unknown parameter "output_map\.robot_radus".*"output_map\.robot_radius"'),
        ("linear_update", "fast", "fast"),
        ("linear_update", -1.0, "-1"),
        ("output_map", 3, "output_map"),
        ("params", "/nowhere/params.json", "/nowhere/params.json"),
        ("load", 7, "~load must be a text, such as a path, not 7"),
        ("view_port", 70000, "~view_port must be a port, 1 to 65535, or 0 for no view, not 70000"),
        ("view_port", "0.0.0.0:8765", "~view_port must be a port"),
        ("view_control", "yes", "~view_control true or false"),
        ("events_log", {"a": 1}, "~events_log must be a text, such as a path"),
    ],
)
def test_settings_that_cannot_be(parameter: Callable[[str, Any], None], name: str, value: Any, told: str) -> None:
    parameter(name, value)
    with pytest.raises(ParameterError, match=told) as caught:
        settings_of_this_process()
    assert name.rpartition("/")[2] in str(caught.value)
