# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings whose odometry is missing, never changes, or is not to be used."""

from pathlib import Path

import numpy as np
import pytest

from helpers.recording_files import Bag
from oort._core import Parameters
from oort.errors import InputError
from oort.localization import find_start
from oort.offline.replay import ReplayOptions, replay
from oort.poses import between
from oort.recording import Recording, open_recording
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen


def without() -> Parameters:
    parameters = Parameters()
    parameters.set("use_odometry", False)
    return parameters


def log(path: Path, *, moves: bool, seconds: int = 20) -> Path:
    lines = []
    for time in range(seconds):
        pose = f"{0.1 * time if moves else 2.5:.2f} 1.00 0.50"
        lines.append(f"FLASER 4 1.0 2.0 3.0 4.0 {pose} {pose} {time}.5 host {time}.5")
    path.write_text("\n".join(lines) + "\n")
    return path


def bag_without_odometry() -> Bag:
    bag = Bag().tf(0.0, "base_link", "laser", (0.2, 0.0, 0.3), topic="/tf_static")
    for time in (1.0, 2.0, 3.0):
        bag.scan(time)
    return bag


def scans_of(recording: Recording) -> int:
    assert all(scan.odometry == (0.0, 0.0, 0.0) and scan.sweep is None for scan in recording.scans())
    return recording.num_scans


def test_a_pose_that_never_changes_is_no_odometry(tmp_path: Path) -> None:
    recording = open_recording(log(tmp_path / "parked.clf", moves=False))
    assert recording.without_odometry == "the log has the same robot pose in every scan"
    assert any(note.startswith("no odometry: the log has the same robot pose") for note in recording.notes)
    assert scans_of(recording) == 20
    # Over some seconds a robot that has odometry stands still as well.
    assert not open_recording(log(tmp_path / "short.clf", moves=False, seconds=8)).without_odometry
    assert not open_recording(log(tmp_path / "drive.clf", moves=True)).without_odometry


def test_odometry_is_left_out_by_request(tmp_path: Path) -> None:
    recording = open_recording(log(tmp_path / "drive.clf", moves=True), parameters=without())
    assert "--no-odometry" in recording.without_odometry
    assert scans_of(recording) == 20
    bag = bag_without_odometry().tf(0.0, "odom", "base_link").tf(9.0, "odom", "base_link", (1, 0, 0))
    assert scans_of(open_recording(bag.ros1(tmp_path / "a.bag"), parameters=without())) == 3


def test_a_bag_without_odometry_is_found_out(tmp_path: Path) -> None:
    recording = open_recording(bag_without_odometry().ros1(tmp_path / "a.bag"))
    assert recording.without_odometry == "there is no frame odom above laser, and no odometry topic"
    np.testing.assert_allclose(recording.sensor_on_base, (0.2, 0.0, 0.0))
    assert scans_of(recording) == 3
    alone = open_recording(Bag().scan(1.0).ros1(tmp_path / "alone.bag"))
    assert alone.without_odometry and alone.sensor_on_base == (0.0, 0.0, 0.0)


def test_odometry_of_a_bag_that_never_changes_is_none(tmp_path: Path) -> None:
    bag = bag_without_odometry()
    for time in range(15):
        bag.tf(float(time), "odom", "base_link", (0.5, 0, 0))
    assert "never changes" in open_recording(bag.ros1(tmp_path / "a.bag")).without_odometry


def test_a_frame_that_was_named_must_be_there(tmp_path: Path) -> None:
    path = bag_without_odometry().ros1(tmp_path / "a.bag")
    with pytest.raises(InputError, match=r"no odometry: no frame wheels above .* laser.*odometry topics: none"):
        open_recording(path, odom_frame="wheels")


def test_a_drive_is_mapped_without_odometry(tmp_path: Path) -> None:
    path = tmp_path / "home.clf"
    drive = simulate_drive(3, SimulationConfig(minutes=1.0))
    write_carmen(drive, path)
    recording = open_recording(path, parameters=without())
    mapped = replay(recording, options=ReplayOptions(until=40.0, quiet=True))
    assert mapped.parameters.get("use_odometry") is False
    poses = mapped.recorder.base_poses(mapped.map)
    assert mapped.session.mapper.statistics["tracking"]["tracking"] == len(poses)
    true = drive.T_map_base[: len(poses)]
    off = between(between(true[0], true), between(poses[0], poses))
    assert np.hypot(off[:, 0], off[:, 1]).max() < 0.1
    with pytest.raises(InputError, match="home: a search for where it begins needs odometry, which is missing"):
        find_start(mapped.map, Parameters(), recording)
