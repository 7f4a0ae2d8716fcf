# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""CARMEN logs: what is read, and that no damage goes unnoticed."""

import bz2
import gzip
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from backports import zstd

from helpers.recording_files import flaser
from oort.errors import InputError
from oort.recording import open_recording
from oort.recording.carmen import flaser_angles

LINES = [
    "# CARMEN Logfile",
    "PARAM robot_length 0.47 1.0 host 0.0",
    flaser("100.123456", [1.0, 2.0, 81.91], laser=(1, 2, 0.5), robot=(1, 2, 0.5)),
    "ODOM 0 0 0 0 0 0 100.2 host 0.6",
    flaser("99.000001", [1.5, 2.5, 3.5], laser=(2, 2, 0.5), robot=(2, 2, 0.5)),
]
TEXT = "\n".join(LINES) + "\n"
ROBOTLASER = "ROBOTLASER1 0 -0.5 1.0 0.5 30.0 0.1 0 3 1 2 3 2 7 8 1 0.1 0 1 0 0 0.1 0.2 0.3 0.4 0.5 12.25 host 0.5\n"


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_flaser_fields(tmp_path: Path) -> None:
    recording = open_recording(write(tmp_path / "home.clf", TEXT))
    first, second = recording.scans()
    assert (recording.name, recording.kind, recording.num_scans) == ("home", "CARMEN log", 2)
    assert (first.stamp, first.time, second.stamp) == ("100.123456", 100.123456, "99.000001")  # order of the lines
    assert first.odometry == (1.0, 2.0, 0.5)
    assert (first.range_min, first.range_max) == (0.0, 80.0)
    assert first.ranges.dtype == np.float32
    np.testing.assert_allclose(first.ranges, [1.0, 2.0, 81.91], rtol=1e-6)
    assert recording.notes == (
        "ignored lines: 1 PARAM, 1 ODOM",
        "the stamps go backwards 1 times; the order of the lines is kept",
    )
    assert [scan.stamp for scan in recording.scans()] == ["100.123456", "99.000001"]  # playable again


def test_sensor_on_base_is_the_laser_seen_from_the_robot(tmp_path: Path) -> None:
    robot = (3.0, -1.0, math.pi / 2)
    laser = (3.0 - 0.2, -1.0 + 0.1, math.pi / 2 + 0.3)  # 0.1 ahead, 0.2 to the left
    recording = open_recording(write(tmp_path / "a.clf", flaser("1.0", [1.0], laser, robot) + "\n"))
    np.testing.assert_allclose(recording.sensor_on_base, (0.1, 0.2, 0.3), atol=2e-6)


def test_a_laser_that_moves_on_the_robot_is_refused(tmp_path: Path) -> None:
    lines = [flaser("1.0", [1.0], (0, 0, 0), (0, 0, 0)), flaser("2.0", [1.0], (0.5, 0, 0), (0, 0, 0))]
    with pytest.raises(InputError, match=r"does not stay in its place.*0\.50 m.*raw log.*--mount"):
        open_recording(write(tmp_path / "a.clf", "\n".join(lines) + "\n"))


def test_poses_taken_at_different_times_jitter_around_the_mount(tmp_path: Path) -> None:
    lag = np.random.default_rng(1).uniform(-0.1, 0.1, size=60)
    lines = [
        flaser(f"{k}.0", [1.0], (0.3 * k + 0.2 + lag[k], 0.0, lag[k] / 2), (0.3 * k, 0.0, 0.0)) for k in range(len(lag))
    ]
    recording = open_recording(write(tmp_path / "a.clf", "\n".join(lines) + "\n"))
    np.testing.assert_allclose(recording.sensor_on_base, (0.2, 0.0, 0.0), atol=0.03)
    assert any("taken at different times" in note for note in recording.notes)


@pytest.mark.parametrize(("n", "step"), [(180, 1.0), (181, 1.0), (360, 0.5), (361, 0.5), (90, 2.0), (541, 180 / 541)])
def test_flaser_angles(n: int, step: float) -> None:
    assert flaser_angles(n) == (-math.pi / 2, math.radians(step))


def test_robotlaser_has_its_own_angles_and_range(tmp_path: Path) -> None:
    recording = open_recording(write(tmp_path / "a.log", ROBOTLASER))
    (scan,) = recording.scans()
    assert (scan.angle_min, scan.angle_increment, scan.range_max) == (-0.5, 0.5, 30.0)
    assert (scan.stamp, scan.odometry) == ("12.25", (1.0, 0.0, 0.0))
    assert scan.ranges.tolist() == [1.0, 2.0, 3.0]
    np.testing.assert_allclose(recording.sensor_on_base, (0.0, 0.1, 0.0), atol=1e-12)


def test_the_first_kind_of_laser_message_wins_unless_chosen(tmp_path: Path) -> None:
    path = write(tmp_path / "a.clf", TEXT + ROBOTLASER)
    assert open_recording(path).num_scans == 2
    assert "1 ROBOTLASER1" in open_recording(path).notes[0]
    assert open_recording(path, scan_topic="ROBOTLASER1").num_scans == 1
    with pytest.raises(InputError, match="choose FLASER or ROBOTLASER1"):
        open_recording(path, scan_topic="/scan")


def test_max_range_only_lowers_the_limit(tmp_path: Path) -> None:
    path = write(tmp_path / "a.clf", TEXT)
    assert next(open_recording(path, max_range=3.0).scans()).range_max == 3.0
    assert next(open_recording(path, max_range=100.0).scans()).range_max == 80.0


@pytest.mark.parametrize(("suffix", "pack"), [(".gz", gzip.compress), (".bz2", bz2.compress), (".zst", zstd.compress)])
def test_compressed_logs(tmp_path: Path, suffix: str, pack: Callable[[bytes], bytes]) -> None:
    path = tmp_path / f"home.clf{suffix}"
    path.write_bytes(pack(TEXT.encode()))
    recording = open_recording(path)
    assert (recording.name, recording.num_scans) == ("home", 2)


@pytest.mark.parametrize(("suffix", "pack"), [(".gz", gzip.compress), (".bz2", bz2.compress), (".zst", zstd.compress)])
def test_truncated_compressed_logs_are_refused(tmp_path: Path, suffix: str, pack: Callable[[bytes], bytes]) -> None:
    packed = pack(TEXT.encode())
    path = tmp_path / f"home.clf{suffix}"
    for size in range(4, len(packed), 7):
        path.write_bytes(packed[:size])
        with pytest.raises(InputError, match=r"cut short: its compressed data end after line .*copy it again"):
            open_recording(path)


def test_damaged_gzip_is_refused(tmp_path: Path) -> None:
    packed = bytearray(gzip.compress(TEXT.encode()))
    packed[-6] ^= 0xFF  # the checksum
    path = tmp_path / "home.clf.gz"
    path.write_bytes(packed)
    with pytest.raises(InputError, match="cannot be read beyond line"):
        open_recording(path)


def test_a_last_scan_cut_anywhere_is_refused(tmp_path: Path) -> None:
    start = TEXT.rindex("FLASER")
    complete = TEXT.rindex(" ") + 2  # the last field, the logger's time, is not used
    for size in range(start + 1, complete):
        with pytest.raises(InputError, match=r"line 5: FL?A?S?E?R?.*cut short here: copy it again"):
            open_recording(write(tmp_path / "a.clf", TEXT[:size]))
    assert open_recording(write(tmp_path / "a.clf", TEXT.rstrip("\n"))).num_scans == 2


def test_another_last_line_without_end_is_noted(tmp_path: Path) -> None:
    recording = open_recording(write(tmp_path / "a.clf", TEXT + "ODOM 0 0"))
    assert "the last line (ODOM) has no end: the log may have been cut short there" in recording.notes


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (LINES[2].replace("FLASER 3", "FLASER 4"), "of 4 readings must have 15 fields, but has 14"),
        (LINES[2].replace("FLASER 3", "FLASER 2"), "of 2 readings must have 13 fields, but has 14"),
        (LINES[2].replace("FLASER 3", "FLASER -3"), "has '-3' where a number of readings belongs"),
        (LINES[2].replace(" 2.00 ", " 2.0.0 "), "reading that is no number"),
        (LINES[2].replace("100.123456", "nan"), "not finite: 'nan'"),
        (LINES[2].replace("0.500000", "north"), "field that is no number"),
        ("FLASER", "has only 1 fields"),
        (ROBOTLASER.replace(" 3 1 2 3 ", " 4 1 2 3 "), "must have|number of readings belongs"),
        (ROBOTLASER.replace(" 30.0 ", " 0.0 "), "maximum range is 0.0"),
    ],
)
def test_malformed_lines_are_named(tmp_path: Path, line: str, message: str) -> None:
    path = write(tmp_path / "a.clf", f"PARAM a b 1.0 host 1.0\n{line.rstrip()}\n{LINES[4]}\n")
    with pytest.raises(InputError, match=f"line 2: .*({message}).*Correct or remove the line"):
        open_recording(path)


def test_scans_without_readings_are_skipped_and_counted(tmp_path: Path) -> None:
    recording = open_recording(write(tmp_path / "a.clf", "FLASER 0 0 0 0 0 0 0 5.0 host 0.1\n" + TEXT))
    assert (recording.num_scans, len(list(recording.scans()))) == (2, 2)
    assert "scans skipped, without readings: 1" in recording.notes


def test_a_log_without_scans_says_what_it_found(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no laser scans.*begin with FLASER or ROBOTLASER1; found 2 ODOM, 1 PARAM"):
        open_recording(write(tmp_path / "a.clf", "ODOM 0\nPARAM a\nODOM 1\n"))


def test_intel(datasets: Path) -> None:
    recording = open_recording(datasets / "radish/intel.clf.bz2", max_range=3.0)
    scans = list(recording.scans())
    assert (recording.name, recording.num_scans, len(scans)) == ("intel", 13631, 13631)
    assert recording.sensor_on_base == (0.0, 0.0, 0.0)
    assert (scans[0].stamp, len(scans[0].ranges), scans[0].range_max) == ("976052857.337530", 180, 3.0)
    assert scans[-1].odometry == (-50.883999, -35.825001, 2.538102)
    assert any("backwards 631 times" in note for note in recording.notes)


def test_fr079(datasets: Path) -> None:
    recording = open_recording(datasets / "radish/fr079.clf.bz2")
    first = next(recording.scans())
    np.testing.assert_allclose(recording.sensor_on_base, (-0.04, 0.0, 0.0), atol=1e-5)
    assert (recording.num_scans, len(first.ranges), first.angle_increment) == (4934, 360, math.radians(0.5))
    assert first.odometry == (-3.034287, 8.291214, -3.120965)
