# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated drives: through all rooms, clear of all things, back on the dock, with odometry that errs as it should."""

import numpy as np
import pytest

from oort.poses import between, compose
from oort.simulate import Drive, Sensor, SimulationConfig, simulate_drive
from oort.simulate.odometry import simulate_odometry

SEEDS = (0, 1, 2, 11)


@pytest.fixture(scope="module", params=SEEDS)
def drive(request: pytest.FixtureRequest) -> Drive:
    return simulate_drive(request.param)


def test_it_has_the_promised_shape(drive: Drive) -> None:
    n, m = len(drive.scan_stamps), len(drive.odometry_stamps)
    assert m == 5 * (n - 1) + 1
    assert drive.ranges.shape == (n, 180)
    assert drive.ranges.dtype == np.float32
    assert drive.T_odom_base_at_scans.shape == drive.T_map_base.shape == (n, 3)
    np.testing.assert_array_equal(np.diff(drive.scan_stamps), 100_000_000)
    np.testing.assert_array_equal(np.diff(drive.odometry_stamps), 20_000_000)
    np.testing.assert_array_equal(drive.T_odom_base[::5], drive.T_odom_base_at_scans)
    assert 2.0 < drive.duration / 60.0 < 8.0
    assert np.all(np.abs(drive.T_odom_base[:, 2]) <= np.pi)


def test_the_map_origin_is_the_first_sensor_pose(drive: Drive) -> None:
    np.testing.assert_allclose(compose(drive.T_map_base[0], drive.T_base_sensor), 0.0, atol=1e-12)
    np.testing.assert_allclose(drive.home.dock, drive.T_map_base[0], atol=1e-12)


def test_it_keeps_clear_of_everything(drive: Drive) -> None:
    base = drive.T_map_base_at_odometry[::2, :2]
    for x0, y0, x1, y1 in drive.home.segments:
        start, side = np.array([x0, y0]), np.array([x1 - x0, y1 - y0])
        along = np.clip((base - start) @ side / (side @ side), 0.0, 1.0)
        assert np.hypot(*(base - start - along[:, None] * side).T).min() > 0.16
    for x, y, radius in drive.home.discs:
        assert np.hypot(base[:, 0] - x, base[:, 1] - y).min() - radius > 0.16


def test_it_visits_every_room(drive: Drive) -> None:
    for room in drive.home.rooms:
        origin, x, y = room.corners[0], room.corners[1] - room.corners[0], room.corners[3] - room.corners[0]
        offset = drive.T_map_base[:, :2] - origin
        u, v = offset @ x / (x @ x), offset @ y / (y @ y)
        assert np.any((u > 0.1) & (u < 0.9) & (v > 0.1) & (v < 0.9)), room.kind


def test_it_returns_to_the_dock(drive: Drive) -> None:
    x, y, heading = between(drive.T_map_base[0], drive.T_map_base[-1])
    assert np.hypot(x, y) < 0.02
    assert abs(heading) < 0.02
    docked = [np.all(drive.T_map_base[part] == drive.T_map_base[part][0]) for part in (slice(20), slice(-20, None))]
    assert all(docked)


def test_speeds_and_accelerations_are_a_small_robots(drive: Drive) -> None:
    moved = between(drive.T_map_base_at_odometry[:-1], drive.T_map_base_at_odometry[1:]) / 0.02
    assert moved[:, 0].max() <= 0.5
    assert moved[:, 0].min() >= -0.15
    assert np.abs(moved[:, 2]).max() <= 1.5
    assert np.abs(np.diff(moved[:, 0])).max() <= 1.001 * 0.02 + 1e-6
    assert np.abs(moved[:, 1]).max() < 0.01  # a differential drive does not slide sideways


def test_the_events_are_of_the_dock(drive: Drive) -> None:
    created, docked = drive.events
    assert (created.call, created.args) == ("graph_loc/create", ("dock", "dock"))
    assert (docked.call, docked.args) == ("map/notify_docked", ())
    times = drive.scan_times
    at_creation = drive.T_map_base[np.searchsorted(times, created.t)]
    at_docking = drive.T_map_base[np.searchsorted(times, docked.t)]
    np.testing.assert_array_equal(at_creation, drive.T_map_base[0])
    np.testing.assert_array_equal(at_docking, drive.T_map_base[-1])
    assert times[0] < created.t < docked.t < times[-1]
    assert not np.isin([created.t, docked.t], times).any()


def test_most_beams_return(drive: Drive) -> None:
    assert 0.6 < np.mean(np.isfinite(drive.ranges)) < 0.95


def test_a_person_walks_by_and_keeps_off() -> None:
    drive = simulate_drive(1)
    there = ~np.isnan(drive.legs[:, 0, 0])
    assert 0.02 < np.mean(there) < 0.5
    body = drive.legs.mean(axis=1)
    distance = np.hypot(*(body - drive.T_map_base[:, :2])[there].T)
    assert 0.4 < distance.min() < 2.3
    alone = simulate_drive(1, SimulationConfig(person=False))
    assert np.all(np.isnan(alone.legs))
    np.testing.assert_array_equal(alone.T_map_base, drive.T_map_base)
    np.testing.assert_array_equal(alone.ranges[~there], drive.ranges[~there])
    assert np.any(alone.ranges[there] != drive.ranges[there])


def test_knobs_leave_home_and_way_alone() -> None:
    drive = simulate_drive(2)
    other = SimulationConfig(Sensor(field_of_view=np.pi / 2, beams=90, range_max=5.0), odometry_error=3.0)
    changed = simulate_drive(2, other)
    np.testing.assert_array_equal(changed.home.segments, drive.home.segments)
    np.testing.assert_array_equal(changed.T_map_base, drive.T_map_base)
    assert changed.ranges.shape == (len(drive.ranges), 90)
    assert 3.5 < np.max(changed.ranges[np.isfinite(changed.ranges)]) < 5.0
    odometry = simulate_drive(2, SimulationConfig(odometry_error=3.0))
    np.testing.assert_array_equal(odometry.ranges, drive.ranges)


def test_minutes_lengthen_the_drive() -> None:
    short, long = (simulate_drive(2, SimulationConfig(minutes=m, person=False)) for m in (0.0, 8.0))
    assert 6.0 < long.duration / 60.0 < 12.0
    assert short.duration < 0.7 * long.duration
    assert np.hypot(*between(long.T_map_base[0], long.T_map_base[-1])[:2]) < 0.02


def test_odometry_without_error_is_the_truth() -> None:
    drive = simulate_drive(0, SimulationConfig(odometry_error=0.0))
    seen = between(drive.T_odom_base[0], drive.T_odom_base)
    true = between(drive.T_map_base_at_odometry[0], drive.T_map_base_at_odometry)
    np.testing.assert_allclose(between(true, seen), 0.0, atol=1e-9)
    assert drive.odometry_error_at_end[0] < 1e-9


@pytest.mark.parametrize("factor", [1.0, 3.0])
def test_odometry_errs_by_one_to_two_percent_times_the_factor(factor: float) -> None:
    """Straight for 20 m, and ten turns on the spot, many times over."""
    rng = np.random.Generator(np.random.PCG64(7))
    straight = np.column_stack([np.full(2500, 0.008), np.zeros(2500)])
    turns = np.column_stack([np.zeros(3000), np.full(3000, 20.0 * np.pi / 3000)])
    way = [simulate_odometry(straight, 0.02, np.zeros(3), factor, rng) for _ in range(300)]
    turn = [simulate_odometry(turns, 0.02, np.zeros(3), factor, rng) for _ in range(300)]
    travelled = np.array([np.hypot(*np.diff(poses[:, :2], axis=0).T).sum() for poses in way])
    assert 0.01 < np.std(travelled / 20.0 - 1.0) / factor < 0.02
    assert 0.01 < np.std([poses[-1, 2] / (20.0 * np.pi) - 1.0 for poses in turn]) / factor < 0.02
    assert 0.02 < np.std([poses[-1, 2] for poses in way]) / factor < 0.06


def test_a_resting_robot_is_seen_at_rest(drive: Drive) -> None:
    resting = np.all(np.diff(drive.T_map_base_at_odometry, axis=0) == 0.0, axis=1)
    assert np.count_nonzero(resting) >= 190
    assert np.all(np.diff(drive.T_odom_base, axis=0)[resting] == 0.0)


def test_impossible_requests_are_refused() -> None:
    with pytest.raises(ValueError, match="seed -1"):
        simulate_drive(-1)
    with pytest.raises(ValueError, match="factor -1"):
        SimulationConfig(odometry_error=-1.0)
    with pytest.raises(ValueError, match="90 minutes"):
        SimulationConfig(minutes=90.0)
