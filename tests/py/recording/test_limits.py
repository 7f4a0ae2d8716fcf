# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of range and masked sectors: which readings count."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from oort.errors import ParameterError
from oort.recording.laser_scan import scan_from_message
from oort.recording.limits import ScanLimits
from oort.recording.motion import Placement


def usable(masks: Sequence[tuple[float, float]], beams: int = 8) -> list[int]:
    """Which of some beams all around, the first ahead, still have their reading."""
    ranges = ScanLimits(masks=masks).usable(np.ones(beams, np.float32), 0.0, 2.0 * math.pi / beams)
    return np.flatnonzero(np.isfinite(ranges)).tolist()


def test_a_mask_goes_counter_clockwise_and_takes_its_edges_along() -> None:
    assert usable([]) == [0, 1, 2, 3, 4, 5, 6, 7]
    assert usable([(math.pi / 4, math.pi / 2)]) == [0, 3, 4, 5, 6, 7]
    assert usable([(math.pi / 2, math.pi / 4)]) == []  # the long way round, edges included
    assert usable([(3.0, -3.0)]) == [0, 1, 2, 3, 5, 6, 7]
    assert usable([(-0.1, 0.1), (math.pi, math.pi)]) == [1, 2, 3, 5, 6, 7]


def test_a_clockwise_laser_and_one_upside_down_are_masked_by_their_own_bearings() -> None:
    limits = ScanLimits(masks=[(0.4, 0.6)])
    for upside_down in (False, True):
        scan = scan_from_message(
            whole_seconds=1,
            nanoseconds=0,
            angle_min=0.5,
            angle_increment=-0.5,
            range_min=0.1,
            range_max=5.0,
            ranges=[1.0, 2.0, 3.0],
            placement=Placement((0.0, 0.0, 0.0)),
            upside_down=upside_down,
            limits=limits,
        )
        assert np.flatnonzero(np.isnan(scan.ranges)).tolist() == ([2] if upside_down else [0])


def test_limits_narrow_what_the_laser_says() -> None:
    limits = ScanLimits(0.5, 4.0)
    assert (limits.range_min(0.1), limits.range_max(5.0)) == (0.5, 4.0)
    assert (limits.range_min(0.6), limits.range_max(3.0)) == (0.6, 3.0)
    assert (ScanLimits().range_min(0.1), ScanLimits().range_max(5.0)) == (0.1, 5.0)


def test_zero_is_no_distance() -> None:
    assert np.isnan(ScanLimits().usable(np.array([0.0, 1.0], np.float32), 0.0, 0.1)).tolist() == [True, False]


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"min_range": 0.0}, "min_range must be a positive number"),
        ({"max_range": math.nan}, "max_range must be a positive number"),
        ({"min_range": 2.0, "max_range": 1.0}, "must be below max_range"),
        ({"masks": [(0.0, 90.0)]}, "in radians; 0.0 to 90.0 is none"),
    ],
)
def test_limits_that_cannot_be(limits: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        ScanLimits(**limits)  # type: ignore[arg-type]
