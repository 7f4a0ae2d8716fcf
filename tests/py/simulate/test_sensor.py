# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated sensor: ray casting against a slow, separate one, and the sizes of its errors."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from oort.poses import between, compose
from oort.simulate import Sensor, SimulationConfig, simulate_drive
from oort.simulate.sensor import cast, measure

Array = NDArray[np.float64]


def march(segments: Array, discs: Array, origin: Array, bearing: float, reach: float) -> float:
    """The end of one beam by solving each intersection on its own, with complex numbers in the beam's frame."""
    turn = complex(math.cos(-bearing), math.sin(-bearing))
    best = math.inf
    for x0, y0, x1, y1 in segments:
        a, b = (complex(x0 - origin[0], y0 - origin[1]) * turn, complex(x1 - origin[0], y1 - origin[1]) * turn)
        if (a.imag > 0) != (b.imag > 0):
            r = a.real - a.imag * (b.real - a.real) / (b.imag - a.imag)
            best = r if 0.0 < r < best else best
    for x, y, radius in discs:
        centre = complex(x - origin[0], y - origin[1]) * turn
        if abs(centre.imag) < radius:
            r = centre.real - math.sqrt(radius**2 - centre.imag**2)
            best = r if 0.0 < r < best else best
    return best if best <= reach else math.inf


def test_casting_agrees_with_brute_force() -> None:
    rng = np.random.Generator(np.random.PCG64(5))
    middles = rng.uniform(-4.0, 4.0, (60, 2))
    segments = np.hstack([middles + rng.uniform(-0.7, 0.7, (60, 2)), middles + rng.uniform(-0.7, 0.7, (60, 2))])
    discs = np.column_stack([rng.uniform(-3.0, 3.0, (25, 2)), rng.uniform(0.02, 0.15, 25)])
    discs = discs[np.hypot(discs[:, 0], discs[:, 1]) > 0.5]
    bearings = rng.uniform(-7.0, 7.0, 400)
    ranges, _ = cast(segments, discs, np.array([0.05, -0.1]), bearings, 3.0)
    expected = [march(segments, discs, np.array([0.05, -0.1]), float(b), 3.0) for b in bearings]
    np.testing.assert_allclose(ranges, expected, atol=1e-9)
    assert 0 < np.count_nonzero(np.isinf(ranges)) < len(ranges)
    origins = rng.uniform(-0.1, 0.1, (400, 2))
    ranges, _ = cast(segments, discs, origins, bearings, 3.0)
    expected = [march(segments, discs, o, float(b), 3.0) for o, b in zip(origins, bearings, strict=True)]
    np.testing.assert_allclose(ranges, expected, atol=1e-9)


def test_incidence() -> None:
    wall = np.array([[1.0, -10.0, 1.0, 10.0]])
    bearings = np.radians([0.0, 60.0, -45.0])
    ranges, incidence = cast(wall, np.empty((0, 3)), np.zeros(2), bearings, 3.0)
    np.testing.assert_allclose(ranges, 1.0 / np.cos(bearings))
    np.testing.assert_allclose(incidence, np.cos(bearings))
    disc = np.array([[2.0, 0.0, 0.5]])
    ranges, incidence = cast(np.empty((0, 4)), disc, np.zeros(2), np.array([0.0, math.asin(0.3 / 2.0), 1.0]), 3.0)
    np.testing.assert_allclose(ranges, [1.5, math.sqrt(4.0 - 0.09) - 0.4, np.inf])
    np.testing.assert_allclose(incidence[:2], [1.0, 0.8])


def test_a_drives_scans_are_of_its_home() -> None:
    """Nearly every return of a whole drive lies where a beam from the true pose ends, but for the stated errors."""
    config = SimulationConfig(Sensor(noise=0.0, noise_per_metre=0.0, mixed_pixels=0.0, dropout=0.0), minutes=0.0)
    drive = simulate_drive(4, config)
    rng = np.random.Generator(np.random.PCG64(0))
    for i in rng.choice(len(drive.ranges), 25, replace=False).tolist():
        x, y, heading = drive.T_map_base[i].tolist()
        origin = np.array([x + 0.109 * math.cos(heading), y + 0.109 * math.sin(heading)])
        legs = drive.legs[i] if not np.isnan(drive.legs[i, 0, 0]) else np.empty((0, 2))
        discs = np.vstack([drive.home.discs, np.column_stack([legs, np.full(len(legs), 0.06)])])
        for beam in range(0, 180, 7):
            bearing = heading + math.radians(beam - 90.0)
            truth = march(drive.home.segments, discs, origin, bearing, 3.0)
            if np.isfinite(drive.ranges[i, beam]):
                assert drive.ranges[i, beam] == pytest.approx(truth, abs=6e-4)


@pytest.mark.parametrize("r", [0.5, 1.5, 2.8])
def test_noise_and_dropouts_have_the_stated_size(r: float) -> None:
    sensor = Sensor(mixed_pixels=0.0)
    shape = (2000, 180)
    told = measure(sensor, np.full(shape, r), np.ones(shape), np.random.Generator(np.random.PCG64(1)))
    errors = told[np.isfinite(told)] - r
    assert np.std(errors) == pytest.approx(0.005 + 0.005 * r, rel=0.02)
    assert abs(np.mean(errors)) < 1e-4
    assert np.mean(np.isinf(told)) == pytest.approx(0.01 * (1.0 + (r / 3.0) ** 2), rel=0.1)


def test_grazing_beams_are_lost_more_often() -> None:
    shape = (2000, 180)
    rng = np.random.Generator(np.random.PCG64(2))
    sensor = Sensor(mixed_pixels=0.0, dropout=0.0)
    for cosine, lost in ((0.2, 0.0), (0.075, 0.25), (0.0, 0.5)):
        told = measure(sensor, np.full(shape, 1.0), np.full(shape, cosine), rng)
        assert np.mean(np.isinf(told)) == pytest.approx(lost, abs=0.01)


def test_mixed_pixels_lie_between_the_depths_of_an_edge() -> None:
    true = np.full((4000, 10), 1.0)
    true[:, 5:] = 2.0
    sensor = Sensor(noise=0.0, noise_per_metre=0.0, dropout=0.0)
    told = measure(sensor, true, np.ones_like(true), np.random.Generator(np.random.PCG64(3)))
    assert np.all(told[:, [0, 1, 2, 3]] == 1.0)
    assert np.all(told[:, 5:] == 2.0)
    mixed = told[:, 4][told[:, 4] != 1.0]
    assert len(mixed) / 4000 == pytest.approx(0.25, abs=0.02)
    assert 1.0 < mixed.min() < 1.05 < 1.95 < mixed.max() < 2.0


def test_ranges_end_at_the_limits_and_are_whole_millimetres() -> None:
    shape = (500, 180)
    told = measure(Sensor(), np.full(shape, 2.995), np.ones(shape), np.random.Generator(np.random.PCG64(4)))
    assert 0.1 < np.mean(np.isinf(told)) < 0.9
    kept = told[np.isfinite(told)]
    assert kept.max() < 3.0
    np.testing.assert_array_equal(kept, (np.round(kept.astype(np.float64), 3)).astype(np.float32))
    near = measure(Sensor(), np.full(shape, 0.05), np.ones(shape), np.random.Generator(np.random.PCG64(4)))
    assert np.all(np.isinf(near))


def test_beams_are_as_documented() -> None:
    np.testing.assert_allclose(Sensor().angles, -math.pi / 2 + np.arange(180) * math.pi / 180, atol=1e-12)
    narrow = Sensor(field_of_view=math.radians(60.0), beams=120)
    assert narrow.angles[0] == pytest.approx(math.radians(-30.0))
    assert narrow.angle_increment == pytest.approx(math.radians(0.5))


def test_a_sweep_sees_from_where_the_sensor_is_at_each_beam() -> None:
    """While the robot stands it sees the same; while it moves, each beam is a beam of a sensor at that place."""
    exact = Sensor(noise=0.0, noise_per_metre=0.0, mixed_pixels=0.0, dropout=0.0)
    still, sweeping = (
        simulate_drive(2, SimulationConfig(replace(exact, sweep_seconds=sweep), person=False, minutes=0.0))
        for sweep in (0.0, 0.1)
    )
    assert np.array_equal(still.T_map_base, sweeping.T_map_base)
    stands = np.all(still.T_map_base[1:] == still.T_map_base[:-1], axis=1)
    stands &= np.all(still.T_map_base_at_odometry[2:-3:5] == still.T_map_base[:-1], axis=1)
    assert stands.sum() > 20
    assert np.array_equal(still.ranges[:-1][stands], sweeping.ranges[:-1][stands])
    assert np.mean(still.ranges[:-1][~stands] != sweeping.ranges[:-1][~stands]) > 0.5
    # Beam 90 of a scan comes 0.05 s after it, half way between two poses of odometry.
    for number in np.flatnonzero(~stands)[::50].tolist():
        before, after = (sweeping.T_map_base_at_odometry[5 * number + k] for k in (2, 3))
        base = before + 0.5 * between(np.zeros(3), after - before)
        x, y, theta = compose(base, sweeping.T_base_sensor)
        told, _ = cast(
            sweeping.home.segments, sweeping.home.discs, np.array([x, y]), theta + sweeping.config.sensor.angles, 3.0
        )
        if 0.1 < told[90] < 3.0:
            assert sweeping.ranges[number, 90] == pytest.approx(told[90], abs=2e-3)


@pytest.mark.parametrize(
    ("kwargs", "said"),
    [
        ({"field_of_view": 0.0}, "field of view 0 "),
        ({"beams": 1}, "1 beams"),
        ({"range_max": 0.05}, "0.05 m"),
        ({"sweep_seconds": 0.2}, "0.2 s"),
    ],
)
def test_impossible_sensors_are_refused(kwargs: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Sensor(**kwargs)  # type: ignore[arg-type]
