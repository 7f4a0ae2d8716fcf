# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages: the fast ones are the generated ones byte for byte, and scans are those that a bag gives."""

import io
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rospy")
import genpy
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import OccupancyGrid
from oort_msgs.srv import GetMap, GetMapResponse
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import LaserScan

from helpers.recording_files import Bag, roll_yaw_quaternion
from node.client import this_process
from oort import LaserScan as Scan2d
from oort import Mapper, Parameters, render_map
from oort.errors import InputError
from oort.node import messages
from oort.node.middleware.rospy_messages import FastGrid, FastMapResponse
from oort.recording import Scan, open_recording
from oort.recording.motion import Placement

STAMP = genpy.Time(1_700_000_000, 123_456_789)
number = st.floats(-1e3, 1e3)
poses = st.tuples(number, number, st.floats(-math.pi, math.pi))


def written(message: genpy.Message) -> bytes:
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def fill(message: OccupancyGrid, frame: str, width: int, height: int) -> None:
    message.header.seq, message.header.frame_id, message.header.stamp = 7, frame, STAMP
    message.info.map_load_time = genpy.Time(1, 2)
    message.info.resolution, message.info.width, message.info.height = 0.05, width, height
    message.info.origin.position.x, message.info.origin.orientation.w = -3.25, 1.0


def both_grids(frame: str, width: int, height: int) -> tuple[FastGrid, OccupancyGrid]:
    """The same grid in Oort's class and in the generated one."""
    cells = np.random.default_rng(width).choice(np.array([-1, 0, 100], dtype=np.int8), size=width * height)
    fast, generated = FastGrid(), OccupancyGrid()
    fill(fast, frame, width, height)
    fill(generated, frame, width, height)
    fast.data, generated.data = cells, cells.tolist()
    return fast, generated


@given(frame=st.text(st.characters(codec="utf-8")), width=st.integers(0, 40), height=st.integers(0, 40))
def test_a_grid_is_written_as_the_generated_class_writes_it(frame: str, width: int, height: int) -> None:
    fast, generated = both_grids(frame, width, height)
    assert written(fast) == written(generated)
    assert written(FastMapResponse(map=fast)) == written(GetMapResponse(map=generated))


def test_a_grid_that_was_read_can_be_written_again() -> None:
    _, generated = both_grids("map", 8, 5)
    again = FastGrid().deserialize(written(generated))
    assert again.data == tuple(generated.data)
    assert written(again) == written(generated)


def test_cells_of_another_kind_are_refused_as_ever() -> None:
    fast, _ = both_grids("map", 2, 2)
    fast.data = [0, 0, 300, 0]
    with pytest.raises(genpy.SerializationError):
        written(fast)


def test_the_type_is_that_of_the_generated_class() -> None:
    for fast, generated in ((FastGrid, OccupancyGrid), (FastMapResponse, GetMapResponse)):
        assert (fast._type, fast._md5sum, fast._full_text) == (
            generated._type,
            generated._md5sum,
            generated._full_text,
        )
        assert fast.__slots__ == generated.__slots__


def test_large_grids_do_not_stall_the_node() -> None:
    fast, generated = both_grids("map", 1000, 1000)

    def best(write: Callable[[], object]) -> float:
        times = []
        for _ in range(5):
            begin = time.perf_counter()
            write()
            times.append(time.perf_counter() - begin)
        return min(times)

    plain = best(lambda: written(generated))
    assert best(lambda: written(fast)) < plain / 5
    assert best(lambda: written(FastMapResponse(map=fast))) < plain / 5


def test_a_rendered_map_becomes_a_message() -> None:
    mapper = Mapper(Parameters())
    mapper.add_scan(Scan2d(np.linspace(1.0, 2.0, 150), -1.5, 0.02, 0.1, 5.0), (0.0, 0.0, 0.0))
    grid, _ = render_map(mapper.map(), Parameters())
    assert grid.width != grid.height  # else a mix-up would go unseen
    message = messages.place_grid(this_process().grid(grid), grid, "map", STAMP)
    assert message.header.frame_id == "map"
    assert message.header.stamp == message.info.map_load_time == STAMP
    assert (message.info.width, message.info.height) == (grid.width, grid.height)
    assert message.info.resolution == grid.resolution
    origin = message.info.origin
    assert (origin.position.x, origin.position.y, origin.position.z) == (*grid.origin, 0.0)
    assert origin.orientation == Quaternion(0.0, 0.0, 0.0, 1.0)
    received = OccupancyGrid().deserialize(written(message))
    np.testing.assert_array_equal(np.array(received.data).reshape(grid.height, grid.width), grid.cells)


def test_a_grid_arrives_whole_over_a_latched_topic_and_a_service(rospy: Any) -> None:
    fast, generated = both_grids("kärtchen", 1000, 700)
    publisher = rospy.Publisher("~fast_grid", OccupancyGrid, queue_size=1, latch=True)
    publisher.publish(fast)
    received = rospy.wait_for_message("~fast_grid", OccupancyGrid, timeout=20)
    publisher.unregister()
    service = rospy.Service("~fast_map", GetMap, lambda _: FastMapResponse(map=fast))
    answer = rospy.ServiceProxy("~fast_map", GetMap)().map
    service.shutdown()
    for message in (received, answer):
        message.header.seq = generated.header.seq  # rospy counts messages there
        assert written(message) == written(generated)


@given(pose=poses)
def test_poses_and_transforms_say_where_and_which_way(pose: tuple[float, float, float]) -> None:
    stamped = messages.pose_stamped(pose, "map", STAMP)
    assert (stamped.header.frame_id, stamped.header.stamp) == ("map", STAMP)
    assert (stamped.pose.position.x, stamped.pose.position.y, stamped.pose.position.z) == (*pose[:2], 0.0)
    link = messages.transform("map", "odom", STAMP, pose)
    assert (link.header.frame_id, link.child_frame_id, link.header.stamp) == ("map", "odom", STAMP)
    assert (link.transform.translation.x, link.transform.translation.y) == pose[:2]
    for turn in (stamped.pose.orientation, link.transform.rotation):
        assert abs(math.remainder(messages.yaw(turn) - pose[2], math.tau)) < 1e-12


@given(roll=st.sampled_from([0.0, math.pi]), angle=st.floats(-3.1, 3.1), length=st.floats(0.01, 100.0))
def test_yaw_of_any_length_and_upside_down(roll: float, angle: float, length: float) -> None:
    quaternion = Quaternion(*(length * value for value in roll_yaw_quaternion(roll, angle)))
    assert messages.yaw(quaternion) == pytest.approx(angle, abs=1e-9)


@pytest.mark.parametrize("bad", [(0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0), (math.inf, 0.0, 0.0, 1.0)])
def test_no_rotation_is_an_error(bad: tuple[float, float, float, float]) -> None:
    with pytest.raises(InputError, match="is not a rotation"):
        messages.yaw(Quaternion(*bad))


@pytest.mark.parametrize("upside_down", [False, True])
def test_a_live_scan_is_the_scan_of_the_bag(tmp_path: Path, upside_down: bool) -> None:
    path = _bag_of_scans(tmp_path / "a.bag", upside_down)
    from_bag = list(open_recording(path).scans())
    with AnyReader([path]) as reader:
        raw = [data for connection, _, data in reader.messages() if connection.topic == "/scan"]
    assert len(raw) == len(from_bag) == 3
    for data, expected in zip(raw, from_bag, strict=True):
        live = messages.to_scan(LaserScan().deserialize(data), Placement(expected.odometry), upside_down)
        assert _bits(live) == _bits(expected)
        assert (live.angle_min, live.angle_increment) == (-0.5, 0.25) or upside_down


def _bag_of_scans(path: Path, upside_down: bool) -> Path:
    rng = np.random.default_rng(11)
    bag = Bag().tf(9.0, "base", "laser", (0.1, 0, 0.2), roll_yaw_quaternion(math.pi if upside_down else 0.0, 0.2))
    bag.tf(1e9, "odom", "base").tf(1e9 + 2, "odom", "base", (1, 0, 0))
    for when in (1e9 + 0.1, 1e9 + 1.000000119, 1e9 + 1.9):
        bag.scan(when, ranges=[math.nan, *rng.uniform(0, 5, 5), math.inf, 0.0])
    return bag.ros1(path)


def _bits(scan: Scan) -> list[Any]:
    """Everything of a scan, nan included, in a form that compares exactly."""
    limits = np.array([scan.time, scan.angle_min, scan.angle_increment, scan.range_min, scan.range_max, *scan.odometry])
    return [scan.stamp, limits.tobytes(), str(scan.ranges.dtype), scan.ranges.tobytes()]
