# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a simulated drive: the same bytes each time, the same stamps and values in each file."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from rosbags.highlevel import AnyReader

from oort.cli.simulate import main
from oort.poses import between
from oort.simulate import Drive, simulate_drive
from oort.simulate.writers import write_drive

ENDINGS = (".bag", ".clf", ".truth.tum", ".events.json", ".png")
Messages = dict[str, list[tuple[int, Any]]]


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulate_drive(5)


@pytest.fixture(scope="module")
def folder(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("simulated") / "new"
    paths = write_drive(drive, folder, "home")
    assert [path.name for path in paths] == ["home" + ending for ending in ENDINGS]
    assert sorted(folder.iterdir()) == sorted(paths)
    return folder


@pytest.fixture(scope="module")
def messages(folder: Path) -> Messages:
    found: Messages = {}
    last = 0
    with AnyReader([folder / "home.bag"]) as reader:
        for connection, stamp, raw in reader.messages():
            assert stamp >= last
            last = stamp
            found.setdefault(connection.topic, []).append((stamp, reader.deserialize(raw, connection.msgtype)))
    return found


def heading(rotation: Any) -> float:
    assert rotation.x == rotation.y == 0.0
    return float(2.0 * np.arctan2(rotation.z, rotation.w))


def stamp_of(header: Any) -> int:
    return int(header.stamp.sec) * 10**9 + int(header.stamp.nanosec)


def test_the_bag_holds_the_drive(drive: Drive, messages: Messages) -> None:
    assert {topic: len(found) for topic, found in messages.items()} == {
        "/scan": len(drive.scan_stamps),
        "/tf": len(drive.odometry_stamps),
        "/odom": len(drive.odometry_stamps),
        "/tf_static": 1,
    }
    for i, (stamp, scan) in enumerate(messages["/scan"]):
        assert stamp == stamp_of(scan.header) == drive.scan_stamps[i]
        assert scan.header.frame_id == "hokuyo_laser_link"
        np.testing.assert_array_equal(scan.ranges, drive.ranges[i])
    assert scan.angle_min == pytest.approx(-np.pi / 2)
    assert scan.angle_max == pytest.approx(np.radians(89.0))
    assert scan.angle_increment == pytest.approx(np.radians(1.0))
    assert (scan.range_min, scan.range_max) == (pytest.approx(0.1), 3.0)


def test_the_bags_transforms_are_the_odometry(drive: Drive, messages: Messages) -> None:
    mount = messages["/tf_static"][0][1].transforms[0]
    assert (mount.header.frame_id, mount.child_frame_id) == ("base_footprint", "hokuyo_laser_link")
    assert (mount.transform.translation.x, mount.transform.translation.y) == (0.109, 0.0)
    for i, ((stamp, tf), (_, odometry)) in enumerate(zip(messages["/tf"], messages["/odom"], strict=True)):
        (transform,) = tf.transforms
        assert stamp == stamp_of(transform.header) == stamp_of(odometry.header) == drive.odometry_stamps[i]
        assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_footprint")
        assert (odometry.header.frame_id, odometry.child_frame_id) == ("odom", "base_footprint")
        place = [transform.transform.translation.x, transform.transform.translation.y]
        np.testing.assert_array_equal(place, drive.T_odom_base[i, :2])
        assert [odometry.pose.pose.position.x, odometry.pose.pose.position.y] == place
        difference = between([0.0, 0.0, heading(transform.transform.rotation)], [0.0, 0.0, drive.T_odom_base[i, 2]])
        assert abs(difference[2]) < 1e-12
    speeds = np.array([odometry.twist.twist.linear.x for _, odometry in messages["/odom"]])
    assert np.sum(np.abs(speeds)) * 0.02 == pytest.approx(drive.length, rel=0.05)


def test_the_carmen_log_equals_the_bag(drive: Drive, folder: Path, messages: Messages) -> None:
    lines = (folder / "home.clf").read_text().splitlines()
    for i, (line, (stamp, scan)) in enumerate(zip(lines, messages["/scan"], strict=True)):
        fields = line.split()
        n = int(fields[8])
        assert fields[0] == "ROBOTLASER1"
        assert n == 180
        assert len(fields) == 9 + n + 1 + 6 + 5 + 3
        readings = np.array([float(field) for field in fields[9 : 9 + n]])
        assert np.all(readings[np.isinf(scan.ranges)] == 3.0)
        returned = np.isfinite(scan.ranges)
        np.testing.assert_array_equal(readings[returned].astype(np.float32), scan.ranges[returned])
        seconds, microseconds = fields[-3].split(".")
        assert int(seconds) * 10**9 + int(microseconds) * 1000 == stamp
        laser, robot = np.array([float(field) for field in fields[10 + n : 16 + n]]).reshape(2, 3)
        np.testing.assert_allclose(robot, drive.T_odom_base_at_scans[i], atol=1e-9)
        np.testing.assert_allclose(between(robot, laser), [0.109, 0.0, 0.0], atol=1e-8)
    start, span, step, reach = (float(field) for field in fields[2:6])
    assert start == pytest.approx(scan.angle_min)
    assert step == pytest.approx(scan.angle_increment)
    assert span == pytest.approx(scan.angle_max - scan.angle_min)
    assert reach == scan.range_max


def test_the_truth_has_the_scans_stamps(drive: Drive, folder: Path) -> None:
    rows = [line.split() for line in (folder / "home.truth.tum").read_text().splitlines()]
    stamps = [int(row[0].replace(".", "")) * 1000 for row in rows]
    np.testing.assert_array_equal(stamps, drive.scan_stamps)
    values = np.array(rows, dtype=np.float64)
    np.testing.assert_allclose(values[:, 1:3], drive.T_map_base[:, :2], atol=1e-9)
    headings = np.column_stack([np.zeros((len(rows), 2)), 2.0 * np.arctan2(values[:, 6], values[:, 7])])
    upright = drive.T_map_base * [0.0, 0.0, 1.0]
    np.testing.assert_allclose(between(upright, headings), 0.0, atol=1e-9)
    assert np.all(values[:, 3:6] == 0.0)


def test_the_events_file(drive: Drive, folder: Path) -> None:
    assert json.loads((folder / "home.events.json").read_text()) == [
        {"t": drive.events[0].t, "call": "graph_loc/create", "args": ["dock", "dock"]},
        {"t": drive.events[1].t, "call": "map/notify_docked", "args": []},
    ]


def test_the_picture_shows_walls_floor_and_way(folder: Path) -> None:
    with Image.open(folder / "home.png") as image:
        colours = np.asarray(image.convert("RGB")).reshape(-1, 3)
    found = {tuple(colour) for colour in np.unique(colours, axis=0).tolist()}
    assert {(255, 255, 255), (60, 60, 64), (245, 240, 232), (30, 140, 60), (172, 140, 104)} <= found


def test_two_runs_give_the_same_bytes_and_replace_old_files(tmp_path: Path, folder: Path) -> None:
    (tmp_path / "home.bag").write_text("old")
    (tmp_path / ".home.bag.partial").write_text("interrupted")
    assert main(["--seed", "5", "--out", str(tmp_path), "--name", "home"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted("home" + ending for ending in ENDINGS)
    for ending in ENDINGS:
        assert (tmp_path / ("home" + ending)).read_bytes() == (folder / ("home" + ending)).read_bytes(), ending


def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--seed", "7", "--out", str(tmp_path), "--fov", "90", "--max-range", "2.2", "--minutes", "0"]
    assert main([*arguments, "--odometry-error", "0", "--no-person", "--no-picture"]) == 0
    said = capsys.readouterr().out
    assert "rooms" in said
    assert "off by 0.00 m and" in said
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted("home_7" + ending for ending in ENDINGS[:-1])
    fields = (tmp_path / "home_7.clf").read_text().split("\n", 1)[0].split()
    assert float(fields[2]) == pytest.approx(-np.pi / 4)
    assert (fields[5], fields[8]) == ("2.2", "90")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [(["--seed", "-3"], "seed -3"), (["--beams", "0"], "0 beams"), (["--fov", "400"], "400 degrees")],
)
def test_bad_arguments_are_told(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*arguments, "--out", str(tmp_path)]) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["--minutes", "0", "--out", str(tmp_path / "file" / "folder")]) == 2
    assert "file" in capsys.readouterr().err


def test_a_sweep_and_a_gyro_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--seed", "2", "--minutes", "0", "--no-picture", "--out", str(tmp_path)]
    assert main([*words, "--name", "plain"]) == 0
    assert main([*words, "--name", "gyro", "--gyro"]) == 0
    assert "CARMEN" not in capsys.readouterr().out
    assert main([*words, "--name", "sweep", "--sweep", "0.09"]) == 0
    assert "no CARMEN log" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.glob("sweep*")) == [
        "sweep.bag",
        "sweep.events.json",
        "sweep.truth.tum",
    ]
    for ending in (".clf", ".truth.tum"):  # the gyro leaves all else as it is
        assert (tmp_path / f"gyro{ending}").read_bytes() == (tmp_path / f"plain{ending}").read_bytes()
    counts = {}
    with AnyReader([tmp_path / "gyro.bag"]) as reader:
        counts = {connection.topic: connection.msgcount for connection in reader.connections}
    assert counts["/imu"] == counts["/odom"]
    with AnyReader([tmp_path / "sweep.bag"]) as reader:
        scans = [connection for connection in reader.connections if connection.topic == "/scan"]
        _, _, raw = next(reader.messages(scans))
        message: Any = reader.deserialize(raw, scans[0].msgtype)
        assert message.time_increment == pytest.approx(0.09 / 180)
        assert "/imu" not in {connection.topic for connection in reader.connections}
    assert main([*words, "--sweep", "1"]) == 2
    assert "a sweep of 1 s" in capsys.readouterr().err
