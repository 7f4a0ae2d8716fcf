# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Scans whose fields hold something else than they should."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from helpers.recording_files import flaser
from oort.errors import InputError
from oort.recording import open_recording
from oort.recording.limits import ScanLimits
from oort.recording.scan_fields import ScanFields, angle_increment, find_no_return

RANDOM = np.random.default_rng(1)


def message(ranges: object = (1.0, 2.0, 3.0), **fields: float) -> Any:
    known = {"angle_min": -1.0, "angle_max": 1.0, "angle_increment": 1.0, "range_min": 0.1, "range_max": 8.0}
    return SimpleNamespace(ranges=np.array(ranges, np.float32), **(known | fields))


def settle(scans: list[Any], limits: ScanLimits | None = None) -> tuple[float, list[str]]:
    """The range from which on nothing counts, and the notes."""
    fields = ScanFields("/scan")
    for scan in scans:
        fields.add(scan)
    correction, notes = fields.settle(limits or ScanLimits())
    return correction.range_max(scans[0].range_max), notes


def test_good_fields_need_no_note() -> None:
    assert settle([message()]) == (8.0, [])


def test_an_increment_of_0_is_taken_from_the_ends() -> None:
    scan = message(angle_increment=0.0)
    assert angle_increment(scan) == 1.0
    assert "1 scans on /scan have an angle_increment of 0" in settle([scan])[1][0]
    with pytest.raises(InputError, match="angle_increment of 0 and angle_min equal to angle_max"):
        settle([message(angle_increment=0.0, angle_max=-1.0)])


def test_degrees_are_named() -> None:
    with pytest.raises(InputError, match="spans 10313 degrees: its angles must be radians"):
        settle([message(np.ones(181), angle_increment=1.0, angle_min=-90.0, angle_max=90.0)])


def test_a_range_max_of_0_is_no_limit() -> None:
    assert settle([message(range_max=0.0)])[0] == math.inf
    assert "range_max is 0 on /scan" in settle([message(range_max=0.0)])[1][0]


def test_millimetres_are_named() -> None:
    readings = RANDOM.uniform(300.0, 3000.0, 500)
    for range_max in (3.0, 3000.0):
        with pytest.raises(InputError, match="ranges must be metres, but look like millimetres"):
            settle([message(readings, range_max=range_max, angle_increment=0.001)])


def test_a_range_max_below_all_readings_is_named() -> None:
    with pytest.raises(InputError, match="nearly all readings on /scan are beyond their range_max of 1 m"):
        settle([message(RANDOM.uniform(2.0, 5.0, 500), range_max=1.0, angle_increment=0.001)])


def room(code: float, share: float, scans: int = 100, jitter: float = 0.0) -> list[NDArray[np.float32]]:
    """Scans of 180 beams in rooms of up to 9 m, where a share of the beams says ``code``, at times a little off."""
    result = []
    for _ in range(scans):
        ranges = RANDOM.uniform(0.5, 9.0, 180)
        coded = RANDOM.random(180) < share
        ranges[coded] = code + np.where(RANDOM.random(int(coded.sum())) < 0.2, jitter, 0.0)
        result.append(ranges.astype(np.float32))
    return result


@pytest.mark.parametrize(
    ("code", "share", "jitter"), [(81.91, 0.2, 0.0), (51.15, 0.01, 0.05), (32.76, 0.05, 0.004), (50.0, 0.5, 0.0)]
)
def test_a_value_for_no_return_is_found(code: float, share: float, jitter: float) -> None:
    scans = room(code, share, jitter=jitter)
    limit, notes = find_no_return(scans, 180 * len(scans))
    assert 9.0 < limit < code
    assert f"about {code:g} m, the largest: taken for no return" in notes[0]


def test_several_values_for_no_return_are_found() -> None:
    scans = [np.where(RANDOM.random(180) < 0.02, np.float32(50.0), scan) for scan in room(51.15, 0.1)]
    limit, notes = find_no_return(scans, 180 * len(scans))
    assert 9.0 < limit < 50.0
    assert "about 51.15, 50 m" in notes[0]


def test_walls_are_no_value_for_no_return() -> None:
    far = np.round(RANDOM.normal(12.0, 0.02, (100, 20)), 2)  # an end wall with a laser's noise, for the whole drive
    noisy = [np.concatenate([scan, wall]).astype(np.float32) for scan, wall in zip(room(1.0, 0.0), far, strict=True)]
    assert find_no_return(noisy, 200 * len(noisy)) == (math.inf, [])
    parked = room(12.0, 0.2, 20) + room(1.0, 0.0, 180)  # seen exactly, but only where the drive began
    assert find_no_return(parked, 180 * len(parked)) == (math.inf, [])
    one_wall = [np.full(180, 2.0, np.float32)] * 50
    assert find_no_return(one_wall, 180 * 50) == (math.inf, [])


def test_a_carmen_log_with_a_value_for_no_return(tmp_path: Path) -> None:
    lines = [flaser(f"{time}.0", scan.tolist()) for time, scan in enumerate(room(51.15, 0.2))]
    path = tmp_path / "a.clf"
    path.write_text("\n".join(lines) + "\n")
    recording = open_recording(path)
    assert any("51.15 m, the largest: taken for no return" in note for note in recording.notes)
    (limit,) = {scan.range_max for scan in recording.scans()}
    assert limit == pytest.approx(51.15 * 0.995, abs=0.001)
    wide = open_recording(path, max_range=20.0, min_range=0.3, masks=[(-2.0, 0.0)])
    scan = next(wide.scans())
    assert (scan.range_min, scan.range_max) == (0.3, 20.0)
    assert np.isnan(scan.ranges[:91]).all()
    assert not np.isnan(scan.ranges[91:]).any()
