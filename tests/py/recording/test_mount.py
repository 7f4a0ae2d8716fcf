# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the laser sits, where no transform tells or several contradict; lasers that share a topic; static odometry."""

from pathlib import Path

import numpy as np
import pytest

from helpers.recording_files import Bag, flaser
from oort.errors import InputError, ParameterError
from oort.recording import open_recording

MOUNT = (0.1, 0.02, 0.5)


def odometry(bag: Bag, child: str = "base", tf: bool = False) -> Bag:
    for time in (10.0, 11.0, 12.0):
        if tf:
            bag.tf(time, "odom", child, (time, 0, 0))
        else:
            bag.odometry(time, (time, 0, 0), child=child)
    return bag.scan(11.0).scan(11.5)


def two_mounts() -> Bag:
    bag = Bag().tf(0.0, "base", "laser", (0.0, 0, 0.1), topic="/tf_static").tf(10.0, "base", "laser", (0.109, 0, 0.1))
    return odometry(bag, tf=True)


@pytest.mark.parametrize(
    ("bag", "message"),
    [
        (odometry(Bag()), r"no transform leads from the base's frame 'base'.*--mount X Y THETA"),
        (odometry(Bag(), tf=True), r"There is odom -> base, from which no transform leads to the laser.*--mount"),
        (odometry(Bag(), child=""), r"/odom has no child_frame_id.*--mount X Y THETA"),
        (
            two_mounts(),
            r"/tf_static says \(0\.000, .* and /tf says \(0\.109, .*several programs tell it; mount \(--mount",
        ),
    ],
)
def test_a_mount_helps_where_transforms_do_not(tmp_path: Path, bag: Bag, message: str) -> None:
    path = bag.ros1(tmp_path / "a.bag")
    with pytest.raises(InputError, match=message):
        open_recording(path)
    recording = open_recording(path, mount=MOUNT)
    assert recording.sensor_on_base == MOUNT
    assert [scan.odometry for scan in recording.scans()] == [(11.0, 0.0, 0.0), (11.5, 0.0, 0.0)]
    assert any("where --mount says" in note for note in recording.notes)


def test_a_mount_of_a_carmen_log(tmp_path: Path) -> None:
    path = tmp_path / "a.clf"
    path.write_text(
        flaser("1.0", [1.0], (1, 0, 0), (0, 0, 0)) + "\n" + flaser("2.0", [1.0], (5, 0, 0), (0, 0, 0)) + "\n"
    )
    with pytest.raises(InputError, match="does not stay in its place"):
        open_recording(path)
    assert open_recording(path, mount=MOUNT).sensor_on_base == MOUNT


def test_a_mount_must_be_finite(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="mount must be x, y"):
        open_recording(odometry(Bag()).ros1(tmp_path / "a.bag"), mount=(0.0, float("nan"), 0.0))


def test_lasers_that_share_a_topic_are_chosen_by_frame(tmp_path: Path) -> None:
    bag = Bag().tf(10.0, "base", "laser").tf(10.0, "base", "rear", (-0.3, 0, 0))
    path = odometry(bag).scan(11.2, frame="rear").ros1(tmp_path / "a.bag")
    both = open_recording(path)
    assert [(scan.time, scan.mount) for scan in both.scans()][-1] == (11.2, (-0.3, 0.0, 0.0))
    assert [scan.mount for scan in both.scans()][:-1] == [None, None]
    assert any("scans in 2 frames: laser, rear; all lasers are used" in note for note in both.notes)
    with pytest.raises(InputError, match=r"in several frames: laser, rear; mount \(--mount\).*--scan-frame"):
        open_recording(path, mount=(0.1, 0.0, 0.0))
    recording = open_recording(path, scan_frame="/rear")
    np.testing.assert_allclose(recording.sensor_on_base, (-0.3, 0, 0))
    assert [scan.time for scan in recording.scans()] == [11.2]
    assert "scans skipped, not in frame rear: 2" in recording.notes
    with pytest.raises(InputError, match="no scan on /scan is in frame front; frames there: laser, rear"):
        open_recording(path, scan_frame="front")


def test_static_odometry_is_none(tmp_path: Path) -> None:
    bag = Bag().tf(0.0, "odom", "base", topic="/tf_static").tf(0.0, "base", "laser", topic="/tf_static")
    recording = open_recording(bag.scan(1.0).ros1(tmp_path / "a.bag"))
    assert "odom -> base is a static transform" in recording.without_odometry
    assert open_recording(odometry(bag).ros1(tmp_path / "b.bag")).num_scans == 2  # a topic tells it


def test_names_with_nul_are_refused() -> None:
    with pytest.raises(InputError, match="NUL"):
        open_recording("a\0b.bag")
