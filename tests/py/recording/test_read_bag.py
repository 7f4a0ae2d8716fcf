# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""ROS bags: frames, odometry and mount are found, and what is missing, ambiguous or damaged is said."""

import math
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin

from helpers.recording_files import Bag, roll_yaw_quaternion, yaw_quaternion
from oort.errors import InputError
from oort.recording import Recording, open_recording

STORAGES = {"sqlite3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}


def drive(bag: Bag, base: str = "base") -> Bag:
    """Odometry by tf from 10 to 12 s: straight on by 1 m/s, then a turn across -pi."""
    bag.tf(10.0, "odom", base, (0, 0, 0), yaw_quaternion(math.pi - 0.1))
    bag.tf(11.0, "odom", base, (1, 0, 0), yaw_quaternion(math.pi - 0.1))
    return bag.tf(12.0, "odom", base, (1, 0, 0), yaw_quaternion(-math.pi + 0.1))


def home_robot() -> Bag:
    """A robot with its laser 0.1 m ahead of its footprint, the way tf usually tells it, and a foreign map."""
    bag = Bag()
    bag.tf(0.0, "footprint", "body", (0, 0, 0.05), topic="/tf_static")
    bag.tf(0.0, "body", "laser", (0.1, 0.02, 0.1), yaw_quaternion(0.5), topic="/tf_static")
    drive(bag, "footprint").tf(10.0, "map", "odom", (7, 7, 0))
    for time in (9.5, 10.0, 10.25, 11.5, 12.5, 13.0):
        bag.scan(time)
    return bag


def check_home_robot(recording: Recording) -> None:
    np.testing.assert_allclose(recording.sensor_on_base, (0.1, 0.02, 0.5), atol=1e-12)
    scans = list(recording.scans())
    assert recording.num_scans == len(scans) == 3
    assert [scan.stamp for scan in scans] == ["10.000000000", "10.250000000", "11.500000000"]
    np.testing.assert_allclose(scans[1].odometry, (0.25, 0.0, math.pi - 0.1), atol=1e-12)
    assert scans[2].odometry[0] == 1.0
    assert abs(scans[2].odometry[2]) == pytest.approx(math.pi)  # half way across the seam, not through 0
    assert (scans[0].angle_min, scans[0].angle_increment, scans[0].range_max) == (-0.5, 0.25, 5.5)
    assert scans[0].range_min == pytest.approx(0.1)
    assert scans[0].ranges.tolist() == [1.0, 2.0, 3.0]
    assert recording.notes == (
        "scans on /scan in frame laser; odometry odom -> footprint from tf",
        "ignored map -> odom of another program (1 transforms)",
        "scans skipped, before the first odometry: 1",
        "scans skipped, after the last odometry: 2",
    )


def test_ros1(tmp_path: Path) -> None:
    recording = open_recording(home_robot().ros1(tmp_path / "home.bag"))
    assert (recording.name, recording.kind) == ("home", "ROS 1 bag")
    check_home_robot(recording)


def test_of_several_echoes_the_first_counts(tmp_path: Path) -> None:
    bag = drive(Bag().tf(0.0, "base", "laser", topic="/tf_static"))
    for time in (10.1, 10.2):
        bag.echoes(time, beams=[[1.0, 2.0], [], [3.0]])
    scans = list(open_recording(bag.ros1(tmp_path / "echoes.bag")).scans())
    assert [scan.time for scan in scans] == [10.1, 10.2]
    assert scans[1].ranges.tolist() == [1.0, math.inf, 3.0]


@pytest.mark.parametrize("storage", STORAGES)
def test_ros2_directory_and_bare_file(tmp_path: Path, storage: str) -> None:
    path = home_robot().ros2(tmp_path / "home", STORAGES[storage])
    recording = open_recording(path)
    assert (recording.name, recording.kind) == ("home", "ROS 2 bag")
    check_home_robot(recording)
    (file,) = (file for file in path.iterdir() if file.suffix != ".yaml")
    check_home_robot(open_recording(file))


def test_order_of_the_recording_is_kept(tmp_path: Path) -> None:
    bag = drive(Bag())
    for time in (10.5, 10.1, 11.0):
        bag.scan(time, frame="base")
    recording = open_recording(bag.ros1(tmp_path / "a.bag"))
    assert [scan.time for scan in recording.scans()] == [10.5, 10.1, 11.0]


def test_scans_in_the_base_frame_sit_at_the_base(tmp_path: Path) -> None:
    recording = open_recording(drive(Bag()).scan(11.0, frame="/base").ros1(tmp_path / "a.bag"))
    assert recording.sensor_on_base == (0.0, 0.0, 0.0)
    assert any("taken to sit at base" in note for note in recording.notes)


def test_late_and_repeated_transforms_find_their_place(tmp_path: Path) -> None:
    bag = Bag().tf(12.0, "odom", "base", (2, 0, 0)).tf(10.0, "odom", "base", (5, 5, 0)).tf(10.0, "odom", "base")
    recording = open_recording(bag.scan(11.0, frame="base").ros1(tmp_path / "a.bag"))
    assert next(recording.scans()).odometry == (1.0, 0.0, 0.0)
    assert any("silent for up to 2.0 s" in note for note in recording.notes)


def test_odometry_topic_serves_where_tf_has_none(tmp_path: Path) -> None:
    bag = Bag().odometry(10.0, (0, 0, 0)).odometry(12.0, (2, 0, 1.0))
    bag.tf(10.0, "body", "base", (0, 0, 0.1)).tf(10.0, "body", "laser", (0.2, 0, 0.3))  # base beside, not above
    recording = open_recording(bag.scan(11.0).ros1(tmp_path / "a.bag"))
    np.testing.assert_allclose(next(recording.scans()).odometry, (1.0, 0.0, 0.5))
    np.testing.assert_allclose(recording.sensor_on_base, (0.2, 0.0, 0.0), atol=1e-12)
    assert "odometry odom -> base from /odom" in recording.notes[0]


def test_tf_comes_before_the_odometry_topic(tmp_path: Path) -> None:
    bag = drive(Bag()).odometry(10.0, (9, 9, 0)).odometry(12.0, (9, 9, 0)).scan(10.5, frame="base")
    assert next(open_recording(bag.ros1(tmp_path / "a.bag")).scans()).odometry[0] == 0.5


def test_odom_frame_of_another_name(tmp_path: Path) -> None:
    bag = Bag().tf(10.0, "world", "wheels").tf(10.0, "wheels", "base").tf(11.0, "wheels", "base", (1, 0, 0))
    path = bag.scan(10.5, frame="base").ros1(tmp_path / "a.bag")
    with pytest.raises(InputError, match=r"no frame odom above.*Frames above it: wheels, world.*odom_frame"):
        open_recording(path)
    recording = open_recording(path, odom_frame="wheels")
    assert next(recording.scans()).odometry == (0.5, 0.0, 0.0)
    assert "ignored world -> wheels of another program (1 transforms)" in recording.notes


def test_several_odometries_must_be_chosen(tmp_path: Path) -> None:
    bag = Bag().scan(10.5, frame="base")
    for time in (10.0, 11.0):
        bag.odometry(time, (time, 0, 0)).odometry(time, (-time, 0, 0), frame="fused", topic="/fused")
    path = bag.ros1(tmp_path / "a.bag")
    with pytest.raises(InputError, match=r"several odometries.*/odom \(odom -> base\), /fused \(fused -> base\)"):
        open_recording(path)
    assert next(open_recording(path, odom_frame="fused").scans()).odometry[0] == -10.5


def test_two_odom_frames_above_the_laser_must_be_chosen(tmp_path: Path) -> None:
    bag = drive(Bag()).tf(10.0, "left/odom", "base").scan(10.5, frame="base")
    with pytest.raises(InputError, match=r"several odometry frames above base.*odom, left/odom"):
        open_recording(bag.ros1(tmp_path / "a.bag"))


def test_several_scan_topics_must_be_chosen(tmp_path: Path) -> None:
    bag = drive(Bag()).scan(10.5, frame="base").scan(11.0, topic="/rear", frame="base")
    path = bag.ros1(tmp_path / "a.bag")
    with pytest.raises(InputError, match=r"choose one with scan_topic .*: /rear, /scan"):
        open_recording(path)
    assert next(open_recording(path, scan_topic="rear").scans()).time == 11.0
    with pytest.raises(InputError, match="no laser scans on /front; there are scans on: /rear, /scan"):
        open_recording(path, scan_topic="/front")


def test_max_range(tmp_path: Path) -> None:
    path = home_robot().ros1(tmp_path / "a.bag")
    assert next(open_recording(path, max_range=3.0).scans()).range_max == 3.0
    assert next(open_recording(path, max_range=30.0).scans()).range_max == 5.5


def test_a_laser_upside_down_is_turned_round(tmp_path: Path) -> None:
    quaternion = roll_yaw_quaternion(math.pi, 0.5)
    bag = drive(Bag()).tf(0.0, "base", "laser", (0.1, 0, 0), quaternion).scan(10.5, ranges=(1.0, 2.0))
    recording = open_recording(bag.ros1(tmp_path / "a.bag"))
    scan = next(recording.scans())
    np.testing.assert_allclose(recording.sensor_on_base, (0.1, 0.0, 0.5), atol=1e-12)
    # The first beam, at -0.5, points to +0.5 on the mirrored sensor: it comes last.
    assert scan.ranges.tolist() == [2.0, 1.0]
    assert scan.angle_min + scan.angle_increment == pytest.approx(0.5)
    assert "the laser hangs upside down: its beams were turned round" in recording.notes


def test_a_tilted_laser_is_refused(tmp_path: Path) -> None:
    bag = drive(Bag()).tf(0.0, "base", "laser", (0, 0, 0), roll_yaw_quaternion(0.35, 0.5)).scan(10.5)
    with pytest.raises(InputError, match="laser is tilted by 20 degrees"):
        open_recording(bag.ros1(tmp_path / "a.bag"))


def test_a_laser_that_moves_on_the_base_is_refused(tmp_path: Path) -> None:
    bag = drive(Bag()).tf(10.0, "base", "laser").tf(11.0, "base", "laser", (0.5, 0, 0)).scan(10.5)
    with pytest.raises(InputError, match=r"base -> laser .* its laser \(frame laser\) varies by 0\.50 m"):
        open_recording(bag.ros1(tmp_path / "a.bag"))


def test_a_missing_mount_names_the_frames(tmp_path: Path) -> None:
    bag = Bag().odometry(10.0, (0, 0, 0)).odometry(12.0, (1, 0, 0)).tf(10.0, "cart", "arm").scan(11.0)
    with pytest.raises(InputError, match=r"no transform leads from .*'base' to .*'laser'; the bag has cart -> arm"):
        open_recording(bag.ros1(tmp_path / "a.bag"))


def test_unusable_transforms_are_counted(tmp_path: Path) -> None:
    bag = drive(Bag()).tf(10.5, "odom", "base", (0, 0, 0), (0, 0, 0, 0)).tf(10.5, "odom", "base", (math.nan, 0, 0))
    recording = open_recording(bag.scan(10.5, frame="base").ros1(tmp_path / "a.bag"))
    assert next(recording.scans()).odometry[0] == 0.5
    assert "2 transforms that are not finite or have no rotation were ignored" in recording.notes


def test_scans_without_readings_are_skipped_and_counted(tmp_path: Path) -> None:
    bag = drive(Bag()).scan(10.5, frame="base", ranges=()).scan(11.0, frame="base")
    recording = open_recording(bag.ros1(tmp_path / "a.bag"))
    assert (recording.num_scans, len(list(recording.scans()))) == (1, 1)
    assert "scans skipped, without readings: 1" in recording.notes


@pytest.mark.parametrize(
    ("bag", "message"),
    [
        (drive(Bag()), "no topic of type sensor_msgs/msg/LaserScan; the bag has: /tf"),
        (drive(Bag()).scan(50.0, frame="base"), "no scan on /scan lies within the odometry's time span"),
        (drive(Bag()).scan(11.0, frame="base", ranges=()), "no scan with readings on /scan"),
        (drive(Bag()).scan(11.0, frame="base").scan(11.5, frame="b"), "no transform leads from .* to the laser's 'b'"),
    ],
)
def test_what_is_missing_is_said(tmp_path: Path, bag: Bag, message: str) -> None:
    with pytest.raises(InputError, match=message):
        open_recording(bag.ros1(tmp_path / "a.bag"))


def test_a_bag_that_vanishes_after_opening_is_an_error(tmp_path: Path) -> None:
    path = home_robot().ros1(tmp_path / "a.bag")
    recording = open_recording(path)
    path.unlink()
    with pytest.raises(InputError, match="cannot be read"):
        list(recording.scans())


@pytest.mark.parametrize(("when", "scans"), [("before", 857), ("after", 729)])
def test_real_bags_open_without_options(datasets: Path, when: str, scans: int) -> None:
    recording = open_recording(datasets / f"bags/2018_dec13_target_{when}.bag")
    assert recording.num_scans == sum(1 for _ in recording.scans()) == scans
    assert recording.sensor_on_base == (0.0, 0.0, 0.0)
    assert any(note.startswith("ignored map -> odom of another program") for note in recording.notes)
    first = next(recording.scans())
    assert len(first.ranges) == 726
    assert first.range_max == pytest.approx(5.6)
