# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Bags as they are found: cut, packed, split, without their metadata; and files that only stand for a bag."""

import bz2
import gzip
import shutil
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from backports import zstd
from rosbags.rosbag2 import StoragePlugin

from helpers.recording_files import Bag
from oort.errors import InputError
from oort.recording import Recording, open_recording
from oort.recording.salvage import TemporaryCopy

STORAGES = {"sqlite3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}
SCANS = 40


def drive(begin: float = 0.0, scans: int = SCANS) -> Bag:
    """A robot that goes straight on, a scan each second with odometry on both sides of it."""
    bag = Bag().tf(begin, "base", "laser", (0.1, 0, 0), topic="/tf_static").tf(begin, "odom", "base", (begin, 0, 0))
    for time in np.arange(begin + 1, begin + scans + 1).tolist():
        bag.tf(time, "odom", "base", (time, 0, 0)).scan(time, ranges=[1.0] * 24)
    return bag


def stamps(recording: Recording) -> list[float]:
    return [scan.time for scan in recording.scans()]


def file_of(folder: Path) -> Path:
    (file,) = (file for file in folder.iterdir() if file.suffix in (".mcap", ".db3"))
    return file


def check_what_is_left(path: Path, whole: list[float]) -> int:
    """A cut recording gives the first scans and says so, or is refused; how many scans it gave."""
    try:
        recording = open_recording(path)
    except InputError as error:
        assert str(path) in str(error)
        assert any(word in str(error) for word in ("cut short", "no topic", "no scan", "no odometry", "empty"))
        return 0
    told = "cut short or was not ended properly: read up to there", "missing or damaged: it was read without it"
    assert any(phrase in note for phrase in told for note in recording.notes)
    found = stamps(recording)
    assert found == whole[: len(found)]
    return len(found)


def test_a_ros1_bag_is_read_up_to_where_it_is_cut(tmp_path: Path) -> None:
    data = drive().ros1(tmp_path / "whole.bag").read_bytes()
    path = tmp_path / "cut.bag"
    whole = stamps(open_recording(tmp_path / "whole.bag"))
    found = []
    for size in np.linspace(14, len(data) - 1, 60).astype(int).tolist():
        path.write_bytes(data[:size])
        found.append(check_what_is_left(path, whole))
    assert found == sorted(found)
    assert found[-1] == SCANS
    assert len(set(found)) > 10


@pytest.mark.parametrize("storage", STORAGES)
def test_a_ros2_bag_is_read_up_to_where_it_is_cut(tmp_path: Path, storage: str) -> None:
    folder = drive().ros2(tmp_path / "whole", STORAGES[storage])
    whole = stamps(open_recording(folder))
    path = shutil.copytree(folder, tmp_path / "cut")
    file = file_of(path)
    data = file.read_bytes()
    found = []
    for size in np.linspace(20, len(data) - 1, 40).astype(int).tolist():
        file.write_bytes(data[:size])
        found.append(check_what_is_left(file, whole))
        assert check_what_is_left(path, whole) == found[-1]
    assert found == sorted(found)
    assert found[-1] >= SCANS // 2  # a page of a database holds many of these small messages
    file.unlink()
    with pytest.raises(InputError, match=r"the files that it lists are gone"):
        open_recording(path)


def test_zeros_at_the_end_of_an_mcap_are_no_records(tmp_path: Path) -> None:
    file = file_of(drive().ros2(tmp_path / "a", StoragePlugin.MCAP))
    file.write_bytes(file.read_bytes()[:-2000] + bytes(2000))
    assert 0 < len(stamps(open_recording(file))) <= SCANS


def test_a_ros1_bag_with_a_wrong_index(tmp_path: Path) -> None:
    """An old rosbag wrote the length of the index as 20 bytes an entry, and readers that believe it get lost."""
    path = drive().ros1(tmp_path / "a.bag")
    data = bytearray(path.read_bytes())
    at = data.index(b"op=\x04")
    count_at = data.index(b"count=", at - 60) + 6
    (count,) = struct.unpack_from("<I", data, count_at)
    length_at = data.index(struct.pack("<I", 12 * count), at)
    data[length_at : length_at + 4] = struct.pack("<I", 20 * count)
    path.write_bytes(data)
    recording = open_recording(path)
    assert len(stamps(recording)) == SCANS
    assert "the index of a.bag is missing or damaged: it was read without it" in recording.notes[0]


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("metadata", [None, "storage_identifier: ''", "not a map"])
def test_a_folder_whose_metadata_are_of_no_use(tmp_path: Path, storage: str, metadata: str | None) -> None:
    folder = drive().ros2(tmp_path / "home", STORAGES[storage])
    description = folder / "metadata.yaml"
    if metadata is None:
        description.unlink()
    else:
        description.write_text(f"rosbag2_bagfile_information:\n  version: 5\n  {metadata}\n")
    recording = open_recording(folder)
    assert recording.name == "home"
    assert len(stamps(recording)) == SCANS
    assert f"what is there is read: {file_of(folder).name}" in recording.notes[0]


def test_the_metadata_file_stands_for_its_folder(tmp_path: Path) -> None:
    folder = drive().ros2(tmp_path / "home", StoragePlugin.MCAP)
    recording = open_recording(folder / "metadata.yaml")
    assert (recording.name, recording.num_scans) == ("home", SCANS)


@pytest.mark.parametrize(("suffix", "pack"), [(".gz", gzip.compress), (".bz2", bz2.compress), (".zst", zstd.compress)])
def test_packed_bags(tmp_path: Path, suffix: str, pack: Callable[[bytes], bytes]) -> None:
    files = [drive().ros1(tmp_path / "drive.bag")]
    files += [file_of(drive().ros2(tmp_path / name, plugin)) for name, plugin in STORAGES.items()]
    for file in files:
        packed = tmp_path / (file.name + suffix)
        packed.write_bytes(pack(file.read_bytes()))
        recording = open_recording(packed)
        assert recording.notes[0] == f"{packed.name} was unpacked to be read"
        assert recording.name == file.stem
        assert len(stamps(recording)) == len(stamps(recording)) == SCANS


def test_a_temporary_copy_goes_with_its_object() -> None:
    copy = TemporaryCopy(".bag")
    path = copy.path
    assert path.exists()
    del copy
    assert not path.exists()


def test_the_parts_of_a_split_bag(tmp_path: Path) -> None:
    parts = [drive(0.0, 10).ros1(tmp_path / "a_0.bag"), drive(10.0, 10).ros1(tmp_path / "a_1.bag")]
    recording = open_recording(parts)
    assert sorted(stamps(recording)) == [float(second) for second in range(1, 21)]
    assert recording.notes[0] == "read as one recording: a_0.bag, a_1.bag"
    with pytest.raises(InputError, match=r"folder of ROS 1 bags: give the bag, or all the parts.*a_0\.bag.*a_1\.bag"):
        open_recording(tmp_path)


def test_parts_must_be_bags_of_one_kind(tmp_path: Path) -> None:
    bag = drive().ros1(tmp_path / "a.bag")
    log = tmp_path / "a.clf"
    log.write_text("FLASER 1 1.0 0 0 0 0 0 0 1.0 host 1.0\n")
    with pytest.raises(InputError, match=r"a\.clf is no bag: only the parts of a bag that was split"):
        open_recording([bag, log])
    with pytest.raises(InputError, match="bags of ROS 1 and of ROS 2"):
        open_recording([bag, drive().ros2(tmp_path / "b", StoragePlugin.MCAP)])


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        (
            "a.db3",
            b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 347807744\n",
            r"Git LFS pointer, which stands for a file of 347807744 bytes: run 'git lfs pull'",
        ),
        ("a.clf", b"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer"),
        ("a.bag", b"/annex/objects/SHA256E-s4--00.bag\n", r"git-annex pointer.*'git annex get'"),
        ("a.bag", b"#ROSRECORD V1.2\n" + bytes(90), r"format 1\.2; only format 2\.0 is read.*'rosbag fix a\.bag new"),
        ("a.bag", b"<!DOCTYPE html>\n<html>", "a web page.*download it again"),
        ("a.zip", b"PK\x03\x04" + bytes(30), "a zip archive: unpack it"),
    ],
)
def test_what_only_stands_for_a_recording_is_named(tmp_path: Path, name: str, content: bytes, message: str) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        open_recording(path)
