# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry that fails once: it freezes, it slips at a bump, or somebody carries the robot."""

import numpy as np
import pytest

from oort.poses import between
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.faults import freeze

SEED = 3


def simulate(fault: str) -> Drive:
    return simulate_drive(SEED, SimulationConfig(minutes=0.0, fault=fault))


@pytest.fixture(scope="module")
def sound() -> Drive:
    return simulate("none")


def fault_poses(drive: Drive) -> tuple[int, int]:
    """The odometry poses at which the fault begins and ends, which is in the middle half of the drive."""
    assert drive.fault_times is not None
    begin, end = np.searchsorted(drive.odometry_times, np.array(drive.fault_times) - 1e-4).tolist()
    assert 0.24 < begin / len(drive.odometry_stamps) < 0.76
    return begin, end


def test_there_is_none_by_default(sound: Drive) -> None:
    assert sound.fault_times is None


@pytest.mark.parametrize("fault", ["freeze", "bump"])
def test_a_fault_of_the_odometry_leaves_the_rest_of_the_drive_as_it_is(fault: str, sound: Drive) -> None:
    drive = simulate(fault)
    assert drive.ranges.tobytes() == sound.ranges.tobytes()
    assert drive.T_map_base.tobytes() == sound.T_map_base.tobytes()
    begin, _ = fault_poses(drive)
    np.testing.assert_array_equal(drive.T_odom_base[: begin + 1], sound.T_odom_base[: begin + 1])


def test_frozen_odometry_jumps_to_where_it_would_be(sound: Drive) -> None:
    drive = simulate("freeze")
    begin, end = fault_poses(drive)
    assert end - begin == 100
    np.testing.assert_array_equal(drive.T_odom_base[begin:end], np.tile(drive.T_odom_base[begin], (100, 1)))
    np.testing.assert_array_equal(drive.T_odom_base[end:], sound.T_odom_base[end:])
    assert np.hypot(*between(drive.T_odom_base[begin], drive.T_odom_base[end])[:2]) > 0.3


def test_a_bump_is_a_slip_and_nothing_else(sound: Drive) -> None:
    drive = simulate("bump")
    begin, end = fault_poses(drive)
    assert end == begin + 1
    moved, seen = (between(d.T_odom_base[:-1], d.T_odom_base[1:]) for d in (sound, drive))
    np.testing.assert_allclose(np.delete(seen, begin, axis=0), np.delete(moved, begin, axis=0), atol=1e-9)
    x, y, turn = between(drive.T_odom_base[begin], drive.T_odom_base[end]) - moved[begin]
    assert np.hypot(x, y) == pytest.approx(0.2, abs=0.01)
    assert abs(turn) == pytest.approx(np.radians(20.0))


def test_a_carried_robots_wheels_stand_still() -> None:
    drive = simulate("carried")
    begin, end = fault_poses(drive)
    assert end - begin == 100
    np.testing.assert_array_equal(drive.T_odom_base[begin : end + 1], np.tile(drive.T_odom_base[begin], (101, 1)))
    x, y, turn = between(drive.T_map_base_at_odometry[begin], drive.T_map_base_at_odometry[end])
    assert np.hypot(x, y) == pytest.approx(1.0)
    assert 0.0 < abs(turn) <= 0.3
    base = drive.T_map_base_at_odometry[begin - 50 :: 2, :2]
    for x0, y0, x1, y1 in drive.home.segments:
        start, side = np.array([x0, y0]), np.array([x1 - x0, y1 - y0])
        along = np.clip((base - start) @ side / (side @ side), 0.0, 1.0)
        assert np.hypot(*(base - start - along[:, None] * side).T).min() > 0.16
    assert np.hypot(*(drive.T_map_base[-1] - drive.T_map_base[0])[:2]) < 0.02


def test_a_drive_without_a_fit_moment_is_told() -> None:
    with pytest.raises(ValueError, match="another seed"):
        freeze(np.zeros((401, 3)), np.zeros((400, 2)), 0.02, np.random.Generator(np.random.PCG64(1)))
