# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What users type and what published clients of Oort do, from the first start to a map that a localiser uses."""

import math
import os
import shlex
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
from nav_msgs.msg import OccupancyGrid
from oort_msgs import srv

from node.client import Client, Heard, HeardTransforms, until
from node.robot import COURSE, SHORT, Course, Localiser, Robot, of_drive
from node.running import Core
from oort import Parameters, load_map, render_map
from oort.node.messages import yaw
from oort.poses import compose
from oort.simulate import Drive

pytest_plugins = ["node.fixtures"]
pytestmark = pytest.mark.usefixtures("cleared")


class Shell:
    """Where a user types."""

    def __init__(self, ros: Core) -> None:
        self._ros = ros

    def __call__(self, line: str) -> str:
        """Runs a command that succeeds; what it prints."""
        done = self._ros.run(*shlex.split(line))
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()


@pytest.fixture
def shell(ros: Core) -> Shell:
    return Shell(ros)


def located(client: Client, name_space: str, id: str) -> list[float]:
    at = client.call("graph_loc/locate", name_space, id).pose
    return [at.position.x, at.position.y, yaw(at.orientation)]


# ---- the sequences of the reference page ----


def test_making_a_map_and_storing_locations_while_doing_it(
    shell: Shell, client: Client, robot: Robot, tmp_path: Path
) -> None:
    robot.laser_on = True
    assert shell(f'rosservice call oort_slam/map/start "{tmp_path}/account/map.capnp"') == ""
    shell('rosservice call oort_slam/graph_loc/create "dock" "dock"')
    robot.drive(COURSE[:60])
    shell('rosservice call oort_slam/graph_loc/create "" "waypoint"')
    robot.drive(COURSE[60:])
    shell("rosservice call oort_slam/map/notify_docked")
    shell("rosservice call oort_slam/map/stop")
    robot.laser_on = False

    assert shell("rosservice call oort_slam/graph_loc/is_ready") == "data: False"
    with Localiser(COURSE.T_map_odom):
        until(lambda: client.call("graph_loc/is_ready"), "readiness")
        assert shell("rosservice call oort_slam/graph_loc/is_ready") == "data: True"
        shell('rosservice call oort_slam/graph_loc/create "" "another"')

    assert located(client, "dock", "dock") == pytest.approx([0.0, 0.0, 0.0], abs=0.01)
    truth = compose(COURSE.T_map_odom, COURSE.T_odom_laser[59])
    assert located(client, "", "waypoint") == pytest.approx(truth.tolist(), abs=0.05)
    saved = load_map(f"{tmp_path}/account/map.capnp")
    assert len(saved) == client.call("map/num_nodes")
    assert saved.switchable_edges["switch"][-1] > 0.5
    assert [place[:2] for place in saved.locations] == [("dock", "dock"), ("", "waypoint"), ("", "another")]


def test_a_new_session_with_a_map_made_already(
    shell: Shell, client: Client, robot: Robot, mapped: Course, path: str, tmp_path: Path
) -> None:
    before = Path(f"{path}.map_capnp").read_bytes()
    shell("rosservice call oort_slam/map/clear")
    shell(f'rosservice call oort_slam/map/start "{tmp_path}/account/new_map.capnp"')
    robot.drive(COURSE)
    client.call("map/stop")
    assert len(load_map(f"{tmp_path}/account/new_map.capnp")) == client.call("map/num_nodes")
    assert Path(f"{path}.map_capnp").read_bytes() == before


def test_running_with_a_map_made_before(shell: Shell, client: Client, mapped: Course, path: str) -> None:
    client.call("map/clear")
    shell(f'rosservice call oort_slam/map/load "{path}.capnp"')
    with Localiser(mapped.T_map_odom):
        until(lambda: client.call("graph_loc/is_ready"), "readiness")
        shell('rosservice call oort_slam/graph_loc/create "" "waypoint"')
    truth = compose(mapped.T_map_odom, mapped.T_odom_laser[-1])
    assert located(client, "", "waypoint") == pytest.approx(truth.tolist(), abs=1e-6)
    assert [place[:2] for place in load_map(path).locations] == [("", "waypoint")]


def test_resume_mapping(shell: Shell, client: Client, robot: Robot, mapped: Course, path: str, tmp_path: Path) -> None:
    old = load_map(path)
    client.call("map/load", path)
    truth = compose(mapped.T_map_odom, COURSE.T_odom_laser[0])
    x, y, theta = np.add(truth, (0.04, -0.03, 0.05)).tolist()  # the user knows about where it is
    new_path = tmp_path / "account/new_map.capnp"
    shell(
        f"""rosservice call oort_slam/map/resume "new_map_loc: '{new_path}'
pose:
  x: {x}
  y: {y}
  theta: {theta}" """
    )
    assert client.state == "mapping"
    robot.drive(COURSE)
    client.call("map/stop")
    new = load_map(str(new_path))
    assert len(new) > len(old)
    joint = new.node_poses[len(old)]
    assert joint == pytest.approx([0.0, 0.0, 0.0], abs=0.03), "matching corrects what the user said"
    assert len(load_map(path)) == len(old)


def test_pause_and_resume_from_paused(shell: Shell, client: Client, robot: Robot) -> None:
    client.call("map/start", "")
    robot.drive(COURSE[:30])
    shell("rosservice call oort_slam/map/pause")
    assert client.state == "paused"
    nodes = client.call("map/num_nodes")
    robot.drive(COURSE[30:60])  # it is carried
    shell("rosservice call oort_slam/map/resume_from_paused")
    assert client.state == "mapping"
    assert client.call("map/num_nodes") == nodes
    robot.drive(COURSE[60:])
    client.call("graph_loc/create", "", "end")
    client.call("map/stop")
    truth = compose(COURSE.T_map_odom, COURSE.T_odom_laser[-1])
    assert located(client, "", "end") == pytest.approx(truth.tolist(), abs=0.05)


# ---- what published clients rely on ----


def test_1_start_with_and_without_a_path(client: Client, robot: Robot, tmp_path: Path) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/stop")
    client.call("map/clear")
    folder = tmp_path / "oort_maps/0b0e7f4c-7d0a-4a52-9b1e-0a8a5a9b5f11"
    client.call("map/start", f"{folder}/map")
    robot.drive(SHORT)
    client.call("map/stop")
    assert {file.name for file in folder.glob("map*")} == {"map.map_capnp", "map.map_meta_capnp", "map.md5"}


def test_2_a_dock_one_second_after_the_start(client: Client, robot: Robot) -> None:
    robot.laser_on = True
    client.call("map/start", "")
    time.sleep(1.0)
    client.call("graph_loc/create", "dock", "dock")
    assert located(client, "dock", "dock") == pytest.approx([0.0, 0.0, 0.0], abs=0.01)


def test_3_the_state_polled_four_times_a_second(client: Client, robot: Robot) -> None:
    def assert_soon(state: str) -> None:
        deadline = time.monotonic() + 5.0
        while client.state != state:
            assert time.monotonic() < deadline
            time.sleep(0.25)

    assert_soon("not_mapping")
    client.call("map/start", "")
    assert_soon("mapping")
    robot.drive(SHORT)
    client.call("map/stop")
    assert_soon("not_mapping")


def test_4_docked_again_then_stop_from_another_thread_then_a_map_saver(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    robot.drive(COURSE[:1])
    client.call("graph_loc/create", "dock", "dock")
    robot.drive(COURSE)
    client.call("map/notify_docked")
    stopping = threading.Thread(target=client.call, args=["map/stop"])
    stopping.start()
    stopping.join(5.0)
    assert client.state == "not_mapping"
    with Heard("map", OccupancyGrid) as map_saver:
        message = map_saver.wait()
    grid, _ = render_map(load_map(path), Parameters())
    assert np.array_equal(np.array(message.data, np.int8), grid.cells.ravel())


@pytest.mark.parametrize("resolve", [os.path.realpath, os.path.abspath])
def test_5_load_then_localise_then_republish(
    client: Client, mapped: Course, path: str, tmp_path: Path, resolve: Any
) -> None:
    """Clients follow links themselves, for the original looked for the md5 in the wrong place."""
    client.call("map/clear")
    (tmp_path / "current").symlink_to(Path(path).parent)
    client.call("map/load", resolve(f"{tmp_path}/current/map.map_capnp").removesuffix(".map_capnp"))
    with Localiser(mapped.T_map_odom), Heard("map", OccupancyGrid) as amcl:
        amcl.wait()
        called = time.time()
        client.call("map/republish_maps")
        amcl.wait_for(lambda message: message.header.stamp.to_sec() >= called, "the map again", 1.0)


def test_6_where_the_dock_is(client: Client, robot: Robot, path: str, rospy: Any) -> None:
    client.call("map/start", path)
    robot.drive(SHORT)
    client.call("graph_loc/create", "dock", "3f0c")
    client.call("map/stop")
    client.call("map/load", path)
    listing = rospy.ServiceProxy("oort_slam/graph_loc/list", srv.LocNamespace)
    dock_id = listing("dock", False).ids[0]
    locate = rospy.ServiceProxy("oort_slam/graph_loc/locate", srv.LocLocate)
    stamped = locate(nspace="dock", id=dock_id).pose
    assert stamped.header.frame_id == "map"
    at = stamped.pose
    heading = math.atan2(2.0 * at.orientation.w * at.orientation.z, 1.0 - 2.0 * at.orientation.z**2)
    truth = compose(SHORT.T_map_odom, SHORT.T_odom_laser[-1])
    assert [at.position.x, at.position.y, heading] == pytest.approx(truth.tolist(), abs=0.02)


@pytest.fixture(scope="module")
def home(client: Client, robot: Robot, drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> str:
    """A saved map of the first minute of a drive through a simulated home."""
    path = str(tmp_path_factory.mktemp("home") / "map")
    course = of_drive(drive)[:600]
    assert course.T_base_laser == pytest.approx(COURSE.T_base_laser), "the same robot"
    client.call("map/clear")
    client.call("map/start", path)
    robot.drive(course, rate=400.0)
    client.call("map/stop")
    return path


def test_7_free_cells_after_a_load(client: Client, home: str) -> None:
    client.call("map/load", home)
    with Heard("map", OccupancyGrid) as heard:
        message = heard.wait(timeout=10.0)
    free = sum(cell == 0 for cell in message.data)
    assert free > 200
    assert free * message.info.resolution**2 > 20.0, "what clients call big enough [m^2]"


def lonely(grid: OccupancyGrid, value: int) -> int:
    """How many cells of a value touch no other one of it."""
    same = np.pad(np.array(grid.data).reshape(grid.info.height, grid.info.width) == value, 1)
    rows, columns = same.shape
    around = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    touching = np.any([same[i : i + rows - 2, j : j + columns - 2] for i, j in around], axis=0)
    return int(np.count_nonzero(same[1:-1, 1:-1] & ~touching))


def test_8_navigation_reads_map_cleaned(client: Client, home: str) -> None:
    client.call("map/load", home)
    with Heard("map", OccupancyGrid) as raw, Heard("map_cleaned", OccupancyGrid) as cleaned:
        raw_map, cleaned_map = raw.wait(), cleaned.wait()
    assert (raw_map.info.width, raw_map.info.height) == (cleaned_map.info.width, cleaned_map.info.height)
    assert raw_map.info.origin == cleaned_map.info.origin
    for value in (100, -1):  # obstacles, the unknown
        assert lonely(cleaned_map, value) < 0.25 * lonely(raw_map, value)


def test_9_only_one_tells_map_to_odom(client: Client, robot: Robot, mapped: Course) -> None:
    assert client.state != "mapping"
    with HeardTransforms(client.name) as heard, Localiser(mapped.T_map_odom):
        until(lambda: client.call("graph_loc/is_ready"), "readiness")
        robot.drive(SHORT)
        time.sleep(0.2)
        assert not heard.told
