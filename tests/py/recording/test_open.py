# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finding out what a path is."""

from pathlib import Path

import pytest

from helpers.recording_files import Bag, flaser
from oort.errors import InputError, ParameterError
from oort.recording import open_recording
from oort.recording.open import recording_name

LOG = flaser("1.0", [1.0, 2.0]) + "\n"


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("intel.clf.bz2", "intel"),
        ("a.b.log.gz", "a.b"),
        ("run.1.bag", "run.1"),
        ("home.mcap", "home"),
        ("plain", "plain"),
        ("2026.05.01", "2026.05.01"),
        (".bag", ".bag"),
    ],
)
def test_names(file: str, name: str) -> None:
    assert recording_name(Path("/somewhere") / file) == name


def test_a_carmen_log_may_have_any_name(tmp_path: Path) -> None:
    path = tmp_path / "drive"
    path.write_text(LOG)
    assert open_recording(str(path)).kind == "CARMEN log"


@pytest.mark.parametrize(
    ("content", "file", "message"),
    [
        (b"", "a.clf", "is empty"),
        (
            b"\x7fELF\0\0\0",
            "a.out",
            r"unknown kind; accepted is a CARMEN log \(plain, .gz, .bz2 or .zst\), a ROS 1 bag",
        ),
        (b"hello world\n", "a.txt", "no laser scans.*found 1 hello. Is it a CARMEN log"),
        (b"no bag", "a.bag", "does not begin as a .bag file does"),
        (b"no bag", "a.mcap", "does not begin as a .mcap file does"),
        (b"#ROSBAG V2.0\nxx", "a.bag.active", "is a ROS 1 bag, but not named so; rename it to end in .bag"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, content: bytes, file: str, message: str) -> None:
    path = tmp_path / file
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        open_recording(path)


def test_missing_file_and_directory_that_is_no_bag(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.bag cannot be read: No such file or directory; check the path"):
        open_recording(tmp_path / "none.bag")
    with pytest.raises(InputError, match=r"directory without metadata\.yaml"):
        open_recording(tmp_path)


@pytest.mark.parametrize("max_range", [0.0, -1.0, float("nan"), float("inf")])
def test_max_range_must_be_a_length(tmp_path: Path, max_range: float) -> None:
    path = Bag().scan(1.0).ros1(tmp_path / "a.bag")
    with pytest.raises(ParameterError, match="max_range must be a positive number"):
        open_recording(path, max_range=max_range)


def test_a_carmen_log_has_no_frames(tmp_path: Path) -> None:
    path = tmp_path / "a.clf"
    path.write_text(LOG)
    with pytest.raises(ParameterError, match="leave out odom_frame"):
        open_recording(path, odom_frame="odom")
