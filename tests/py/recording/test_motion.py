# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Bags whose scans took time, whose odometry ends too early, or whose turns a gyro tells."""

import math
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin

from helpers.recording_files import Bag, flaser, roll_yaw_quaternion, yaw_quaternion
from oort import Parameters, Session
from oort.errors import InputError, ParameterError
from oort.offline.trajectory import TrajectoryRecorder
from oort.poses import between
from oort.recording import Recording, open_recording
from oort.recording.motion import beam_span
from oort.simulate import Drive, Sensor, SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag

SPEED, TURN = 0.3, 1.0


def parameters(**values: bool | float) -> Parameters:
    made = Parameters()
    for name, value in values.items():
        made.set(name, value)
    return made


def turning(until: float = 1.0, roll: float = 0.0) -> Bag:
    """A robot that drives an arc from 0 s on, with odometry at 50 Hz and its laser on the base."""
    bag = Bag().tf(0.0, "base", "laser", (0.1, 0.0, 0.0), roll_yaw_quaternion(roll, 0.0), topic="/tf_static")
    for k in range(round(until * 50) + 1):
        bag.tf(0.02 * k, "odom", "base", (SPEED * 0.02 * k, 0.0, 0.0), yaw_quaternion(TURN * 0.02 * k))
    return bag


def opened(bag: Bag, folder: Path, **values: bool | float) -> Recording:
    return open_recording(bag.ros1(folder / "a.bag"), parameters=parameters(**values))


# ---- the motion within a scan ----


@pytest.mark.parametrize("kind", ["ros1", "ros2"])
def test_a_scan_has_the_motion_while_it_was_taken(tmp_path: Path, kind: str) -> None:
    bag = turning().scan(0.5, time_increment=0.05).scan(0.7)
    path = bag.ros1(tmp_path / "a.bag") if kind == "ros1" else bag.ros2(tmp_path / "a", StoragePlugin.MCAP)
    sweeping, snapshot = open_recording(path).scans()
    assert sweeping.sweep is not None
    assert sweeping.sweep[0] == (0.0, 0.0, 0.0)
    heading = sweeping.odometry[2]
    moved = SPEED * 0.1 * math.cos(heading), -SPEED * 0.1 * math.sin(heading), TURN * 0.1
    assert sweeping.sweep[1] == pytest.approx(moved, abs=1e-8)
    assert snapshot.sweep is None
    assert [scan.sweep for scan in open_recording(path, parameters=parameters(motion_compensation=False)).scans()] == [
        None,
        None,
    ]


def test_beams_that_are_turned_round_keep_their_times(tmp_path: Path) -> None:
    paths = [
        turning(roll=roll).scan(0.5, time_increment=0.05).ros1(tmp_path / f"{roll}.bag") for roll in (0.0, math.pi)
    ]
    upright, hanging = (next(open_recording(path).scans()) for path in paths)
    assert upright.sweep is not None
    assert hanging.sweep == upright.sweep[::-1]
    assert hanging.ranges.tolist() == upright.ranges.tolist()[::-1]


def test_a_negative_increment_goes_back_from_the_stamp(tmp_path: Path) -> None:
    (scan,) = opened(turning().scan(0.5, time_increment=-0.05), tmp_path).scans()
    assert scan.sweep is not None
    assert scan.sweep[1][2] == pytest.approx(-TURN * 0.1)


@pytest.mark.parametrize("increment", [math.nan, math.inf, 0.6, -0.6])
def test_an_increment_that_cannot_be(tmp_path: Path, increment: float) -> None:
    recording = opened(turning().scan(0.5, time_increment=increment), tmp_path)
    (scan,) = recording.scans()
    assert scan.sweep is None
    assert any("1 scans have a time_increment" in note for note in recording.notes)


def test_the_time_that_beams_take() -> None:
    assert beam_span(181, 0.0005) == pytest.approx((0.0, 0.09))
    assert beam_span(1, 0.5) == (0.0, 0.0)
    assert beam_span(3, 0.51) is None


# ---- where odometry ends ----


@pytest.mark.parametrize(("ahead", "scans"), [(0.0, 1), (0.05, 2), (0.1, 3)])
def test_scans_beyond_the_last_odometry(tmp_path: Path, ahead: float, scans: int) -> None:
    """One that ends with it, one whose last beam comes 0.04 s later, and one that is later altogether."""
    bag = turning(1.0).scan(0.88, time_increment=0.05).scan(0.94, time_increment=0.05).scan(1.06)
    recording = opened(bag, tmp_path, max_extrapolation=ahead)
    found = list(recording.scans())
    assert recording.num_scans == len(found) == scans
    assert any("after the last odometry" in note for note in recording.notes) == (scans < 3)
    if scans > 1:
        assert found[1].sweep is not None
        assert found[1].sweep[1][2] == pytest.approx(TURN * 0.1)
    if scans == 3:
        assert found[2].odometry[2] == pytest.approx(1.06 * TURN)


# ---- a drive ----


def heading_error(drive: Drive, folder: Path, name: str, **values: bool | float) -> float:
    """Root mean square of the errors of the turns over a second [rad]."""
    write_bag(drive, folder / f"{name}.bag")
    chosen = parameters(**values)
    recording = open_recording(folder / f"{name}.bag", parameters=chosen)
    session = Session(chosen, recording.sensor_on_base)
    session.start()
    recorder = TrajectoryRecorder(recording.sensor_on_base)
    for scan in recording.scans():
        recorder.add(scan.stamp, scan.odometry, session.add_scan(scan))
    session.stop()
    told, true = recorder.base_poses(session.map), drive.T_map_base
    assert len(told) == len(true)
    error = between(between(true[:-10], true[10:]), between(told[:-10], told[10:]))
    return float(np.sqrt(np.mean(error[:, 2] ** 2)))


def test_a_home_seen_by_a_spinning_laser(tmp_path: Path) -> None:
    """The robot turns at up to 1.2 rad/s while the laser goes round in 0.1 s."""
    sensor = Sensor(field_of_view=2.0 * math.pi, beams=180, sweep_seconds=0.1)
    drive = simulate_drive(2, SimulationConfig(sensor, odometry_error=2.0, minutes=0.0))
    snapshot = simulate_drive(2, SimulationConfig(Sensor(2.0 * math.pi, 180), odometry_error=2.0, minutes=0.0))
    assert np.array_equal(drive.T_map_base, snapshot.T_map_base)
    compensated = heading_error(drive, tmp_path, "compensated")
    assert compensated < 0.35 * heading_error(drive, tmp_path, "bent", motion_compensation=False)
    assert compensated < 4.0 * heading_error(snapshot, tmp_path, "snapshot")


# ---- a gyro ----


def with_gyro(bias: float = 0.02, topic: str = "/imu", frame: str = "base", axis: float = 1.0) -> Bag:
    """A robot that stands for 2 s and then turns at 1 rad/s for 2 s, of which odometry tells a half."""
    bag = Bag().tf(0.0, "base", "laser", (0.1, 0.0, 0.0), topic="/tf_static")
    bag.tf(0.0, "base", "imu", (0.0, 0.0, 0.0), roll_yaw_quaternion(math.pi, 0.0), topic="/tf_static")
    for k in range(201):
        time = 0.02 * k
        turned = max(0.0, time - 2.0)
        bag.imu(time, (0.3, 0.4, axis * (bias + (1.0 if time > 2.0 else 0.0))), frame, topic)
        bag.tf(time, "odom", "base", (0.0, 0.0, 0.0), yaw_quaternion(0.5 * turned))
    return bag.scan(1.0).scan(4.0)


@pytest.mark.parametrize(("frame", "axis"), [("base", 1.0), ("imu", -1.0), ("nowhere", 1.0)])
def test_turns_by_a_gyro(tmp_path: Path, frame: str, axis: float) -> None:
    recording = opened(with_gyro(frame=frame, axis=axis), tmp_path, use_imu=True)
    standing, turned = recording.scans()
    assert standing.odometry == (0.0, 0.0, 0.0)
    assert turned.odometry[2] == pytest.approx(2.0, abs=0.02)
    assert any(note.startswith("the gyro's bias is 1.14") for note in recording.notes)
    assert any("taken to sit level" in note for note in recording.notes) == (frame == "nowhere")


def test_a_gyro_counts_only_if_asked_for(tmp_path: Path) -> None:
    path = with_gyro(topic="/robot/imu").ros1(tmp_path / "a.bag")
    assert list(open_recording(path).scans())[1].odometry[2] == pytest.approx(1.0)
    assert list(open_recording(path, imu_topic="robot/imu").scans())[1].odometry[2] == pytest.approx(2.0, abs=0.02)


def test_an_imu_that_is_missing_or_ambiguous(tmp_path: Path) -> None:
    path = turning().scan(0.5).ros1(tmp_path / "none.bag")
    expected = r"no topic of type sensor_msgs/msg/Imu; the bag has: /scan.*; use_imu asks for one: set use_imu to false"
    with pytest.raises(InputError, match=expected):
        open_recording(path, parameters=parameters(use_imu=True))
    path = with_gyro().imu(4.0, (0, 0, 0), topic="/imu2").ros1(tmp_path / "two.bag")
    with pytest.raises(InputError, match=r"several topics with IMU messages; .*--imu-topic.*: /imu, /imu2"):
        open_recording(path, parameters=parameters(use_imu=True))
    with pytest.raises(InputError, match=r"no IMU messages on /imu3; there are messages on: /imu, /imu2"):
        open_recording(path, imu_topic="/imu3")
    log = tmp_path / "a.clf"
    log.write_text(flaser("1.0", [1.0] * 180) + "\n")
    with pytest.raises(ParameterError, match="no IMU"):
        open_recording(log, imu_topic="/imu")
    assert any(
        "use_imu has no effect" in note for note in open_recording(log, parameters=parameters(use_imu=True)).notes
    )
    for without in (None, parameters()):
        assert not any("use_imu" in note for note in open_recording(log, parameters=without).notes)


def test_an_imu_that_moves_on_the_base_is_refused(tmp_path: Path) -> None:
    bag = with_gyro(frame="imu").tf(1.0, "base", "imu", (0.5, 0.0, 0.0), roll_yaw_quaternion(math.pi, 0.0))
    with pytest.raises(InputError, match=r"base -> imu .* its IMU \(frame imu\) varies by 0\.50 m .* the IMU .* fixed"):
        opened(bag, tmp_path, use_imu=True)


def test_an_imu_without_numbers(tmp_path: Path) -> None:
    bag = turning().scan(0.5).imu(0.1, (0, 0, math.nan)).imu(0.2, (0, 0, 0), told=False)
    with pytest.raises(InputError, match=r"no yaw rate on /imu \(2 messages without numbers\)"):
        opened(bag, tmp_path, use_imu=True)


def test_a_base_that_never_stands_keeps_its_own_turns(tmp_path: Path) -> None:
    bag = turning()
    for k in range(60):
        bag.imu(0.02 * k, (0.0, 0.0, 3.0))
    recording = opened(bag.scan(0.9), tmp_path, use_imu=True)
    (scan,) = recording.scans()
    assert scan.odometry[2] == pytest.approx(0.9 * TURN)
    assert any("never stood still" in note for note in recording.notes)


def test_poses_out_of_order_are_left_out_and_counted(tmp_path: Path) -> None:
    bag = with_gyro().tf(3.0, "odom", "base", (9.0, 9.0, 0.0))
    recording = opened(bag, tmp_path, use_imu=True)
    assert list(recording.scans())[1].odometry[:2] == pytest.approx((0.0, 0.0))
    assert any(note.startswith("1 poses of odometry are not newer") for note in recording.notes)


def test_a_simulated_gyro_mends_bad_turns(tmp_path: Path) -> None:
    drive = simulate_drive(2, SimulationConfig(minutes=0.0, odometry_error=10.0, gyro=True))
    write_bag(drive, tmp_path / "a.bag")

    def error(**values: bool | float) -> float:
        """Largest error of the heading [rad]."""
        scans = open_recording(tmp_path / "a.bag", parameters=parameters(**values)).scans()
        told = np.array([scan.odometry for scan in scans])
        off = between(between(drive.T_map_base[0], drive.T_map_base), between(told[0], told))
        return float(np.abs(off[:, 2]).max())

    assert error(use_imu=True) < 0.1
    assert error() > 0.3
