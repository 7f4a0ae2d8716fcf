# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A recording as it might as well have been: played backwards, mirrored, noisier, thinned, or begun later."""

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from oort.poses import Array, between
from oort.recording import Pose, Recording, Scan

Change = Callable[[Sequence[Scan]], list[Scan]]


def _as_it_is(poses: Array) -> Array:
    return poses


def _same_mount(mount: Pose) -> Pose:
    return mount


def _same(scans: Sequence[Scan]) -> list[Scan]:
    return list(scans)


@dataclass(frozen=True)
class Variant:
    """What is done to a recording, and to the parameters."""

    name: str
    change: Change = _same
    undo: Callable[[Array], Array] = _as_it_is
    """brings poses (n, 3) back to the world of the recording"""
    mount: Callable[[Pose], Pose] = _same_mount
    factors: dict[str, float] = field(default_factory=dict)
    """on parameters"""
    is_thinned: bool = False
    """so few scans that odometry is what most of the way is known by"""

    def applied(self, recording: Recording) -> Recording:
        """The recording that it makes of another one."""
        scans = self.change(list(recording.scans()))
        return dataclasses.replace(
            recording,
            num_scans=len(scans),
            sensor_on_base=self.mount(recording.sensor_on_base),
            source=lambda: iter(scans),
        )


def _with(scan: Scan, **changes: Any) -> Scan:
    values = {f.name: getattr(scan, f.name) for f in dataclasses.fields(scan)}
    return Scan(**(values | changes))


def _of_each(change: Callable[[Scan], Scan]) -> Change:
    return lambda scans: [change(scan) for scan in scans]


def _drop(first: int, step: int) -> Change:
    return lambda scans: [scan for i, scan in enumerate(scans) if i % step != first]


def _late(seconds: float) -> Change:
    return lambda scans: [scan for scan in scans if scan.time - scans[0].time >= seconds]


def _noise(sigma: float, seed: int = 1) -> Change:
    def change(scans: Sequence[Scan]) -> list[Scan]:
        random = np.random.default_rng(seed)
        return [
            _with(scan, ranges=scan.ranges + random.normal(0.0, sigma, len(scan.ranges)).astype(np.float32))
            for scan in scans
        ]

    return change


def _every_beam(step: int) -> Change:
    return _of_each(lambda scan: _with(scan, ranges=scan.ranges[::step], angle_increment=step * scan.angle_increment))


def _within(metres: float) -> Change:
    return _of_each(lambda scan: _with(scan, range_max=min(scan.range_max, metres)))


def _mirror_pose(pose: Pose) -> Pose:
    return pose[0], -pose[1], -pose[2]


def _mirror(scan: Scan) -> Scan:
    last = scan.angle_min + (len(scan.ranges) - 1) * scan.angle_increment
    return _with(scan, ranges=scan.ranges[::-1], angle_min=-last, odometry=_mirror_pose(scan.odometry))


def _backwards(scans: Sequence[Scan]) -> list[Scan]:
    end = scans[0].time + scans[-1].time
    return [_with(scan, time=end - scan.time) for scan in scans[::-1]]


def _turn_odometry(factor: float) -> Change:
    """Odometry whose turns are too large by a factor, put together anew."""

    def change(scans: Sequence[Scan]) -> list[Scan]:
        poses = np.array([scan.odometry for scan in scans])
        steps = between(poses[:-1], poses[1:])
        headings = poses[0, 2] + np.concatenate([[0.0], np.cumsum(factor * steps[:, 2])])
        c, s = np.cos(headings[:-1]), np.sin(headings[:-1])
        x = poses[0, 0] + np.concatenate([[0.0], np.cumsum(c * steps[:, 0] - s * steps[:, 1])])
        y = poses[0, 1] + np.concatenate([[0.0], np.cumsum(s * steps[:, 0] + c * steps[:, 1])])
        return [_with(scan, odometry=(float(x[i]), float(y[i]), float(headings[i]))) for i, scan in enumerate(scans)]

    return change


def _scan_per(metres: float) -> Change:
    """A scan where odometry has moved so far, or turned as much in radians, as sparse logs are written."""

    def change(scans: Sequence[Scan]) -> list[Scan]:
        def kept() -> Iterator[Scan]:
            last: Scan | None = None
            for scan in scans:
                moved = np.zeros(3) if last is None else between(last.odometry, scan.odometry)
                if last is None or math.hypot(moved[0], moved[1]) >= metres or abs(moved[2]) >= metres:
                    last = scan
                    yield scan

        return list(kept())

    return change


def _stamped_by_second(thin: Change) -> Change:
    """The same with stamps that count, as those of logs whose times were lost."""

    def change(scans: Sequence[Scan]) -> list[Scan]:
        return [_with(scan, time=float(i)) for i, scan in enumerate(thin(scans))]

    return change


_FRSM = "incremental_graph_builder.frsm_matcher."
_LOCAL_WINDOW = (_FRSM + "max_search_range_xy", _FRSM + "max_search_range_theta")
_LOOP = "loop_closure_graph_builder.frsm_matcher."


def _mirrored_back(poses: Array) -> Array:
    back: Array = poses * np.array([1.0, -1.0, -1.0])
    return back


VARIANTS = (
    Variant("as it is"),
    Variant("every 7th scan dropped", _drop(3, 7)),
    Variant("every 2nd scan dropped", _drop(1, 2)),
    Variant("30 s later", _late(30.0)),
    Variant("77 s later", _late(77.0)),
    Variant("5 mm of noise", _noise(0.005)),
    Variant("20 mm of noise", _noise(0.02)),
    Variant("every 2nd beam", _every_beam(2)),
    Variant("mirrored", _of_each(_mirror), _mirrored_back, _mirror_pose),
    Variant("backwards", _backwards),
    Variant("to 20 m", _within(20.0)),
    Variant("to 8 m", _within(8.0)),
    Variant("odometry turns 3 % more", _turn_odometry(1.03)),
    Variant("odometry turns 5 % less", _turn_odometry(0.95)),
    Variant("local window x 0.8", factors=dict.fromkeys(_LOCAL_WINDOW, 0.8)),
    Variant("local window x 1.2", factors=dict.fromkeys(_LOCAL_WINDOW, 1.2)),
    Variant("local window x 2", factors=dict.fromkeys(_LOCAL_WINDOW, 2.0)),
    Variant("loop window x 0.8", factors={_LOOP + "search_window_sigmas": 0.8}),
    Variant("loop window x 1.2", factors={_LOOP + "search_window_sigmas": 1.2}),
    Variant("a scan each 0.5 m", _scan_per(0.5), is_thinned=True),
    Variant("a scan each 1 m", _scan_per(1.0), is_thinned=True),
    Variant("each 0.5 m, a second apart", _stamped_by_second(_scan_per(0.5)), is_thinned=True),
    Variant("each 1 m, a second apart", _stamped_by_second(_scan_per(1.0)), is_thinned=True),
)


def chance_runs(count: int) -> tuple[Variant, ...]:
    """The recording with 5 mm of noise, each time another, begun up to 19 scans later: what single figures hide."""

    def run(seed: int) -> Variant:
        first = int(np.random.default_rng(seed).integers(20))
        return Variant(f"run {seed}, from scan {first}", lambda scans: _noise(0.005, seed)(scans[first:]))

    return tuple(run(seed) for seed in range(count))
