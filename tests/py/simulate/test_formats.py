# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of ROS 2 and lone MCAP files of a simulated drive, read with libraries that are not ours; presets of sensors."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability
from rosbags.rosbag2 import Reader

from oort import Parameters
from oort.evaluation.trajectories import evaluate_ate
from oort.export import Trajectory, read_tum
from oort.offline.replay import replay
from oort.recording import open_recording
from oort.simulate import PRESETS, Drive, SimulationConfig, simulate_drive
from oort.simulate.presets import MEANINGS
from oort.simulate.sensor import Sensor, cast_drive
from oort.simulate.writers import write_drive

KINDS = ("ros1", "ros2", "mcap")
Read = list[tuple[str, int, Any]]


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulate_drive(5, SimulationConfig(minutes=0.0, gyro=True, rear=True))


@pytest.fixture(scope="module")
def folder(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("formats")
    write_drive(drive, folder, "home", picture=False, formats=KINDS)
    return folder


def read(path: Path) -> Read:
    with AnyReader([path]) as reader:
        return [(c.topic, stamp, reader.deserialize(raw, c.msgtype)) for c, stamp, raw in reader.messages()]


def test_the_bags_hold_the_same_messages(folder: Path) -> None:
    first, *others = [read(folder / name) for name in ("home.bag", "home", "home.mcap")]
    topics = {"/tf_static", "/tf", "/odom", "/scan", "/scan_rear", "/imu"}
    assert {topic for topic, _, _ in first} == topics
    order = sorted(range(len(first)), key=lambda i: (first[i][1], first[i][0]))
    for other in others:
        assert len(other) == len(first)
        for i, (topic, stamp, message) in zip(order, sorted(other, key=lambda each: each[1::-1]), strict=True):
            assert (topic, stamp) == first[i][:2]
            if topic.startswith("/scan"):
                np.testing.assert_array_equal(message.ranges, first[i][2].ranges)
                assert message.angle_increment == pytest.approx(first[i][2].angle_increment)


def test_the_folder_is_a_bag_of_rosbag2(folder: Path, drive: Drive) -> None:
    with Reader(folder / "home") as reader:
        counts = {connection.topic: connection.msgcount for connection in reader.connections}
        profiles = {c.topic: c.ext.offered_qos_profiles[0] for c in reader.connections}  # type: ignore[union-attr]
        durable = {topic for topic, qos in profiles.items() if qos.durability is QosDurability.TRANSIENT_LOCAL}
        assert reader.duration >= round(1e9 * drive.duration)
    assert counts["/scan"] == len(drive.scan_stamps)
    assert durable == {"/tf_static"}  # who subscribes late still gets it


def test_the_lone_file_is_an_mcap(folder: Path, drive: Drive) -> None:
    with (folder / "home.mcap").open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None and summary.statistics is not None
    assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
    assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
    assert summary.statistics.message_count == len(read(folder / "home.bag"))


def test_the_same_bytes_each_time_and_over_old_files(folder: Path, drive: Drive, tmp_path: Path) -> None:
    for _ in range(2):
        write_drive(drive, tmp_path, "home", picture=False, formats=KINDS)
    names = ["home", "home.bag", "home.events.json", "home.mcap", "home.truth.tum"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        assert path.read_bytes() == (tmp_path / path.relative_to(folder)).read_bytes(), path
    with pytest.raises(ValueError, match="choose of ros1, ros2, mcap, carmen"):
        write_drive(drive, tmp_path, "home", formats=("ros3",))


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_maps_well(name: str, tmp_path: Path) -> None:
    assert name in MEANINGS
    write_drive(simulate_drive(2, SimulationConfig(PRESETS[name], minutes=0.0)), tmp_path, "home", picture=False)
    mapped = replay(open_recording(tmp_path / "home.bag"), Parameters())
    trajectory = Trajectory(tuple(mapped.recorder.stamps), mapped.recorder.base_poses(mapped.map))
    assert evaluate_ate(trajectory, read_tum(tmp_path / "home.truth.tum")).position_rmse < 0.04


def test_a_sensor_that_looks_down_sees_walls_farther_and_the_floor() -> None:
    walls = np.array([[2.0, -9.0, 2.0, 9.0]])
    nobody = np.full((1, 2, 2), np.nan)
    level = Sensor(np.pi / 2.0, 90, range_max=5.0, height=0.3)
    discs = np.empty((0, 3))
    flat, _ = cast_drive(level, np.zeros((1, 3)), walls, discs, nobody, 0.06)
    tilt = np.radians(5.0)
    down, sine = cast_drive(replace(level, tilt=tilt), np.zeros((1, 3)), walls, discs, nobody, 0.06)
    ahead = 45
    assert flat[0, ahead] == pytest.approx(2.0)
    assert down[0, ahead] == pytest.approx(2.0 / np.cos(tilt))
    steep, sine = cast_drive(replace(level, tilt=np.radians(15.0)), np.zeros((1, 3)), walls, discs, nobody, 0.06)
    assert steep[0, ahead] == pytest.approx(0.3 / np.sin(np.radians(15.0)))  # the floor is nearer than the wall
    assert sine[0, ahead] == pytest.approx(np.sin(np.radians(15.0)))
    up, _ = cast_drive(replace(level, tilt=-np.radians(15.0)), np.zeros((1, 3)), walls, discs, nobody, 0.06)
    assert up[0, ahead] == pytest.approx(2.0 / np.cos(np.radians(15.0)))


def test_a_tilt_is_told_by_the_transform_and_refused_beyond_five_degrees(tmp_path: Path) -> None:
    for degrees in (4.0, 8.0):
        sensor = replace(PRESETS["kuri"], tilt=np.radians(degrees))
        drive = simulate_drive(2, SimulationConfig(sensor, minutes=0.0))
        write_drive(drive, tmp_path, f"tilt{degrees:g}", picture=False, formats=("mcap",))
    open_recording(tmp_path / "tilt4.mcap")
    with pytest.raises(Exception, match="tilted by 8 degrees"):
        open_recording(tmp_path / "tilt8.mcap")
    (message,) = [each for topic, _, each in read(tmp_path / "tilt4.mcap") if topic == "/tf_static"]
    mount = message.transforms[0].transform
    assert mount.translation.z == 0.2
    assert 2.0 * np.degrees(np.arcsin(mount.rotation.y)) == pytest.approx(4.0)
