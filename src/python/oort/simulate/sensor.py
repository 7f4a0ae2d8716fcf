# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A planar range sensor: where its beams end, and what it says of that."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from oort.poses import Array

LONGEST_SWEEP = 0.1  # s, from scan to scan
DRIVERS = ("true", "turned-round", "mirrored")
BODY_RANGE = 0.16  # m, of the robot's own body where the sensor sees it
BODY_NOISE = 0.003  # m
STEEPEST = np.radians(30.0)


@dataclass(frozen=True)
class Sensor:
    """A depth sensor that looks forward; the defaults are a home robot's.

    Beam i points to -field_of_view / 2 + i * field_of_view / beams, and is measured ``i * sweep_seconds / beams`` after
    the scan's stamp: all at once, or one after the other as by a laser that spins.
    Errors, for a beam that ends at range r:

    - noise: normal, of standard deviation ``noise + noise_per_metre * r``; ranges are told in whole millimetres;
    - dropouts: no return with probability ``dropout * (1 + (r / range_max)^2)``, and more the more the beam grazes:
      up to a half where it runs along the surface, none of it beyond 8.6 degrees;
    - mixed pixels: where neighbouring beams end more than 10 cm apart, with probability ``mixed_pixels`` anywhere
      between the two ends.
    """

    field_of_view: float = np.pi
    """[rad]"""
    beams: int = 180
    range_min: float = 0.1
    """[m]; what is closer gives no return"""
    range_max: float = 3.0
    """[m]; what is farther gives no return"""
    noise: float = 0.005
    """[m]"""
    noise_per_metre: float = 0.005
    dropout: float = 0.01
    mixed_pixels: float = 0.25
    mount: tuple[float, float, float] = (0.109, 0.0, 0.0)
    """T_base_sensor: x [m], y [m], heading [rad]"""
    sweep_seconds: float = 0.0
    """[s], at most the time from scan to scan"""
    driver: str = "true"
    """One of DRIVERS, which tells the scans: truly; of a clockwise sensor, whose beams it turns round while it keeps
    their times; or mirrored, each beam at the bearing of the one across."""
    body: float = 0.0
    """[rad] at either edge of the view where the sensor sees nothing but the robot itself"""
    height: float = 0.2
    """[m] above the floor"""
    tilt: float = 0.0
    """[rad] that the sensor looks down; below 0 up. Beams that look down end on the floor at the latest; walls and
    furniture are as high as any beam."""

    def __post_init__(self) -> None:
        """Refuse what no sensor has."""
        if not 0.0 < self.field_of_view <= 2.0 * np.pi:
            raise ValueError(f"field of view {np.degrees(self.field_of_view):g} degrees: choose one of 0 to 360")
        if self.beams < 2:
            raise ValueError(f"{self.beams} beams: choose at least 2")
        if not 0.0 <= self.sweep_seconds <= LONGEST_SWEEP:
            raise ValueError(f"a sweep of {self.sweep_seconds:g} s: choose one of 0 to {LONGEST_SWEEP:g}")
        if self.driver not in DRIVERS:
            raise ValueError(f"driver {self.driver!r}: choose one of {', '.join(DRIVERS)}")
        if not 0.0 <= self.body < 0.5 * self.field_of_view:
            raise ValueError(f"{np.degrees(self.body):g} degrees of body: choose less than half of the view")
        if not 0.0 < self.height < 10.0:
            raise ValueError(f"a height of {self.height:g} m: choose one of 0 to 10")
        if not abs(self.tilt) <= STEEPEST:
            raise ValueError(f"a tilt of {np.degrees(self.tilt):g} degrees: choose one of -30 to 30")
        if not 0.0 < self.range_min < self.range_max < np.inf:
            raise ValueError(
                f"ranges from {self.range_min:g} m to {self.range_max:g} m: choose a maximum above the minimum"
            )

    @property
    def angle_min(self) -> float:
        """Bearing of the first beam, rad."""
        return -0.5 * self.field_of_view

    @property
    def angle_increment(self) -> float:
        """Angle between neighbouring beams, rad."""
        return self.field_of_view / self.beams

    @property
    def time_increment(self) -> float:
        """From beam to beam, s."""
        return self.sweep_seconds / self.beams

    @property
    def angles(self) -> Array:
        """Bearings (beams,) in the sensor's frame, rad."""
        return self.angle_min + self.angle_increment * np.arange(self.beams, dtype=np.float64)

    @property
    def rays(self) -> tuple[Array, Array, Array]:
        """Of each beam (beams,) its bearing on the floor plan [rad], its way there for each metre of its range, and the
        sine of the angle by which it looks down.
        """
        if self.tilt == 0.0:
            return self.angles, np.ones(self.beams), np.zeros(self.beams)
        ahead, aside = np.cos(self.angles) * np.cos(self.tilt), np.sin(self.angles)
        return np.arctan2(aside, ahead), np.hypot(aside, ahead), np.cos(self.angles) * np.sin(self.tilt)


GRAZING = 0.15  # cosine of incidence below which dropouts rise
EDGE = 0.1  # m between neighbouring beams' ends that makes a mixed pixel possible


def cast(segments: Array, discs: Array, origin: Array, bearings: Array, reach: float) -> tuple[Array, Array]:
    """Ends of beams from ``origin`` (2,) at absolute ``bearings`` (b,) [rad], among segments (m, 4) and discs (k, 3).

    The beams may have origins of their own (b, 2), which lie near to each other. Returns ranges (b,) [m], infinite
    where nothing is within ``reach``, and the cosine of incidence (b,), 1 head-on.
    """
    direction = np.column_stack([np.cos(bearings), np.sin(bearings)])
    middle, far = origin, reach
    if origin.ndim == 2:
        middle = origin[len(origin) // 2]
        far = reach + float(np.hypot(*(origin - middle).T).max())
    ranges, incidence = _cast_at_segments(_within(segments, middle, far), origin, direction)
    near = discs[np.hypot(discs[:, 0] - middle[0], discs[:, 1] - middle[1]) - discs[:, 2] <= far]
    if len(near):
        if origin.ndim == 2:
            to_disc = near[:, :2] - origin[:, None]  # (b, k, 2)
            along = np.sum(direction[:, None] * to_disc, axis=-1)
        else:
            to_disc = near[:, :2] - origin
            along = direction @ to_disc.T
        aside = direction[:, :1] * to_disc[..., 1] - direction[:, 1:] * to_disc[..., 0]
        half_chord = np.sqrt(np.maximum(near[:, 2] ** 2 - aside**2, 0.0))
        hit = np.where((np.abs(aside) <= near[:, 2]) & (along - half_chord > 0.0), along - half_chord, np.inf)
        nearest = np.argmin(hit, axis=1)
        rows = np.arange(len(bearings))
        closer = hit[rows, nearest] < ranges
        ranges = np.where(closer, hit[rows, nearest], ranges)
        incidence = np.where(closer, half_chord[rows, nearest] / near[nearest, 2], incidence)
    return np.where(ranges <= reach, ranges, np.inf), incidence


def _within(segments: Array, origin: Array, reach: float) -> Array:
    """The segments that come within reach of the origin."""
    start, side = segments[:, :2] - origin, segments[:, 2:] - segments[:, :2]
    along = np.clip(-np.sum(start * side, axis=1) / np.sum(side * side, axis=1), 0.0, 1.0)
    return np.asarray(segments[np.hypot(*(start + along[:, None] * side).T) <= reach])


def _cast_at_segments(segments: Array, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Ranges and cosines of incidence (b,) at segments alone."""
    if not len(segments):
        return np.full(len(direction), np.inf), np.ones(len(direction))
    side = segments[:, 2:] - segments[:, :2]
    start = segments[:, :2] - (origin if origin.ndim == 1 else origin[:, None])  # (m, 2) or (b, m, 2)
    across = direction[:, :1] * side[:, 1] - direction[:, 1:] * side[:, 0]  # (b, m), sine of the angle times length
    with np.errstate(divide="ignore", invalid="ignore"):
        ranges = (start[..., 0] * side[:, 1] - start[..., 1] * side[:, 0]) / across
        place = (start[..., 0] * direction[:, 1:] - start[..., 1] * direction[:, :1]) / across
        hit = np.where((np.abs(place - 0.5) <= 0.5 + 1e-9) & (ranges > 0.0), ranges, np.inf)
    nearest = np.argmin(hit, axis=1)
    rows = np.arange(len(direction))
    return hit[rows, nearest], np.abs(across[rows, nearest]) / np.hypot(*side[nearest].T)


def cast_drive(
    sensor: Sensor, poses: Array, segments: Array, discs: Array, legs: Array, radius: float
) -> tuple[Array, Array]:
    """True ranges and cosines of incidence (n, beams) from sensor poses, with a person's legs (n, 2, 2).

    The poses are (n, 3), or (n, beams, 3) for a sensor that sweeps.
    """
    ranges = np.empty((len(poses), sensor.beams))
    incidence = np.empty_like(ranges)
    bearings, stretch, down = sensor.rays
    for i, pose in enumerate(poses):
        seen = discs if np.isnan(legs[i, 0, 0]) else np.vstack([discs, np.column_stack([legs[i], [radius, radius]])])
        ranges[i], incidence[i] = cast(segments, seen, pose[..., :2], pose[..., 2] + bearings, sensor.range_max)
    if sensor.tilt != 0.0:
        ranges /= stretch
        floor = np.divide(sensor.height, down, out=np.full(sensor.beams, np.inf), where=down > 0.0)
        incidence = np.where(floor < ranges, down, incidence)
        ranges = np.minimum(ranges, floor)
    return ranges, incidence


def measure(sensor: Sensor, true: Array, incidence: Array, rng: np.random.Generator) -> npt.NDArray[np.float32]:
    """What the sensor says, (n, beams) float32 with infinity for no return, of true ranges and incidences."""
    mixed = _mix_pixels(sensor, true, rng)
    returned = np.isfinite(mixed)
    r = np.where(returned, mixed, 0.0)
    lost = sensor.dropout * (1.0 + (r / sensor.range_max) ** 2) + 0.5 * np.maximum(0.0, 1.0 - incidence / GRAZING)
    returned &= rng.random(true.shape) >= lost
    noisy = r + (sensor.noise + sensor.noise_per_metre * r) * rng.standard_normal(true.shape)
    told = np.round(noisy, 3)
    returned &= (told >= sensor.range_min) & (told < sensor.range_max)
    ranges = np.where(returned, told, np.inf)
    own = round(sensor.body / sensor.angle_increment)
    if own:
        body = BODY_RANGE + BODY_NOISE * rng.standard_normal((len(ranges), 2 * own))
        ranges[:, :own], ranges[:, -own:] = body[:, :own], body[:, own:]
    if sensor.driver == "mirrored":
        ranges = ranges[:, ::-1]
    return np.ascontiguousarray(ranges, dtype=np.float32)


def _mix_pixels(sensor: Sensor, true: Array, rng: np.random.Generator) -> Array:
    """True ranges with some of those at depth edges moved to somewhere between the two depths."""
    following = np.concatenate([true[:, 1:], true[:, -1:]], axis=1)
    edge = np.isfinite(true) & np.isfinite(following)
    gap = np.where(edge, following, 0.0) - np.where(edge, true, 0.0)
    edge &= (np.abs(gap) > EDGE) & (rng.random(true.shape) < sensor.mixed_pixels)
    share = rng.random(true.shape)
    return np.where(edge, true + share * gap, true)
