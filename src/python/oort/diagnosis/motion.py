# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Whether odometry and scans tell of the same motion: turn sign, mount, clocks."""

import math

import numpy as np
from numpy.typing import NDArray

from oort.diagnosis.observer import Observer, Sample, columns
from oort.diagnosis.trouble import Trouble
from oort.poses import wrap_angle

Array = NDArray[np.float64]

_TURNING = 0.02  # [rad] between two scans; more is no noise of laying one on the other
_MOVING = 0.015  # [m] likewise
_ENOUGH = 15  # samples, and enough that chance does not put four fifths of them on one side
_AGAINST = 0.2  # share of turns that agree in sign, below which odometry turns the other way
_STATIC = 0.05  # [m], [rad] that odometry tells of in all
_REALLY = 0.3  # [m], [rad] that the sampled scans tell of in all, meanwhile
_YAW = math.radians(15.0)  # of a mount: less may be a base that does not drive straight
_TOGETHER = 0.8  # mean resultant length of the directions
_LAGS = np.arange(-60, 61) * 0.05  # [s]
_LEAST_LAG = 0.3  # [s]; odometry that comes with some delay is not of another clock
_CLEARER = 0.4  # of the squared error that the best lag leaves, to that without a lag
_EXPLAINED = 0.3  # to that of the turns themselves


def motion_troubles(observer: Observer) -> list[Trouble]:
    """What is wrong between odometry and scans; at most one cause, the likeliest."""
    odometry, scans, degenerate = columns(observer.samples)
    if len(scans) < _ENOUGH:
        return []
    trouble = (
        _static(observer, scans)
        or _clock_offset(observer)
        or _turn_sign(odometry, scans)
        or _mount_yaw(odometry, scans, degenerate)
    )
    return [] if trouble is None else [trouble]


def scales_of(observer: Observer) -> tuple[float, float]:
    """How far the sensor moves and turns by the scans where odometry says 1; 1 where there are few samples."""
    odometry, scans, degenerate = columns(observer.samples)
    turning = (np.abs(odometry[:, 2]) > _TURNING) & (np.abs(scans[:, 2]) > 0.5 * _TURNING)
    straight = (np.abs(odometry[:, 2]) < _TURNING) & (np.hypot(odometry[:, 0], odometry[:, 1]) > _MOVING) & ~degenerate
    ratios = (
        np.sum(odometry[straight, :2] * scans[straight, :2], axis=1) / np.sum(odometry[straight, :2] ** 2, axis=1),
        scans[turning, 2] / odometry[turning, 2],
    )
    translation, rotation = (float(np.median(ratio)) if len(ratio) >= 2 * _ENOUGH else 1.0 for ratio in ratios)
    return translation, rotation


def _static(observer: Observer, scans: Array) -> Trouble | None:
    told = np.array(observer.odometry)
    steps = np.diff(told, axis=0)
    travel, turn = float(np.hypot(steps[:, 0], steps[:, 1]).sum()), float(np.abs(wrap_angle(steps[:, 2])).sum())
    seen = float(np.abs(scans[:, 2])[np.abs(scans[:, 2]) > _TURNING].sum())
    if travel > _STATIC or turn > _STATIC or seen < _REALLY:
        return None
    return Trouble(
        "odometry_static",
        f"odometry never moves, while the scans turn (by {math.degrees(seen):.0f} degrees in the samples looked at)",
        "check that the base's driver publishes odometry, and that no static transform stands in for it",
        {"travel_m": travel, "turn_rad": turn, "scans_turn_rad": seen},
    )


def _turn_sign(odometry: Array, scans: Array) -> Trouble | None:
    turning = (np.abs(scans[:, 2]) > _TURNING) & (np.abs(odometry[:, 2]) > 0.5 * _TURNING)
    count = int(turning.sum())
    if count < _ENOUGH:
        return None
    agree = float((np.sign(scans[turning, 2]) == np.sign(odometry[turning, 2])).mean())
    if agree > _AGAINST:
        return None
    return Trouble(
        "turn_sign",
        f"the scans turn against odometry in {1.0 - agree:.0%} of {count} samples",
        "the laser hangs upside down or its driver mirrors the beams (correct the transform's roll, or the driver), or "
        "odometry's turns have the wrong sign (correct the base's driver)",
        {"samples": count, "share_that_agrees": agree},
    )


def _mount_yaw(odometry: Array, scans: Array, degenerate: NDArray[np.bool_]) -> Trouble | None:
    length = np.hypot(odometry[:, 0], odometry[:, 1])
    seen = np.hypot(scans[:, 0], scans[:, 1])
    straight = (np.abs(odometry[:, 2]) < _TURNING) & (length > _MOVING) & (seen > _MOVING) & ~degenerate
    count = int(straight.sum())
    if count < _ENOUGH:
        return None
    o, s = odometry[straight], scans[straight]
    angle = np.arctan2(o[:, 0] * s[:, 1] - o[:, 1] * s[:, 0], o[:, 0] * s[:, 0] + o[:, 1] * s[:, 1])
    mean = np.exp(1j * angle).mean()
    yaw, together = float(np.angle(mean)), float(np.abs(mean))
    if together < _TOGETHER or abs(yaw) < _YAW:
        return None
    backwards = abs(yaw) > math.radians(150.0)
    what = "backwards" if backwards else f"{math.degrees(yaw):+.0f} degrees aside"
    return Trouble(
        "mount_yaw",
        f"the scans move {what} where odometry moves forwards ({count} samples)",
        "the laser is mounted turned against what its transform says: correct the yaw by "
        f"{math.degrees(-yaw):.0f} degrees, in the transform or with --mount",
        {"samples": count, "yaw_error_rad": -yaw, "resultant": together},
    )


def _clock_offset(observer: Observer) -> Trouble | None:
    """The lag at which odometry's turns explain those of the scans."""
    stamps = np.array(observer.stamps)
    order = np.argsort(stamps, kind="stable")
    stamps, headings = stamps[order], np.unwrap(np.array(observer.odometry)[order, 2])
    samples = [s for s in observer.samples if _is_inside(s, stamps)]
    begins, ends = (np.array([getattr(s, name) for s in samples]) for name in ("begin", "end"))
    turns = np.array([s.scans[2] for s in samples])
    if int((np.abs(turns) > _TURNING).sum()) < _ENOUGH:
        return None
    errors = np.array(
        [
            ((np.interp(ends + lag, stamps, headings) - np.interp(begins + lag, stamps, headings) - turns) ** 2).sum()
            for lag in _LAGS
        ]
    )
    best = int(np.argmin(errors))
    at_zero = float(errors[len(_LAGS) // 2])
    lag = float(_LAGS[best])
    clear = errors[best] < min(_CLEARER * at_zero, _EXPLAINED * float((turns**2).sum()))
    if abs(lag) < _LEAST_LAG or not clear:
        return None
    late = "late" if lag < 0.0 else "early"
    return Trouble(
        "clock_offset",
        f"the scans fit odometry of {abs(lag):.2f} s {'before' if lag < 0.0 else 'after'}: they are stamped {late}",
        "set both machines' clocks by NTP or PTP, and let the laser's driver stamp scans when they are taken",
        {"offset_s": -lag, "error_left": float(errors[best] / max(at_zero, 1e-12)), "samples": len(samples)},
    )


def _is_inside(sample: Sample, stamps: Array) -> bool:
    most = float(_LAGS[-1])
    return sample.fits and stamps[0] + most <= sample.begin and sample.end <= stamps[-1] - most
