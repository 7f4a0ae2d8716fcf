# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The transforms of the last seconds, for one look-up: where a frame is now in another, as tf2 would say."""

import math
from bisect import bisect_left, bisect_right, insort
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from oort.recording.frames import homogeneous

_KEEP = 10_000_000_000  # [ns], as tf2 keeps by default
_BACKWARDS = 1_000_000_000  # [ns]; what is older than the newest by more says that the clock was set back

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Sample = tuple[int, Vector, Quaternion]
"""[ns], translation [m] and unit quaternion of T_parent_child."""


@dataclass(slots=True)
class _Link:
    """From a child to the parent that was last said to be its."""

    parent: str
    fixed: bool
    samples: list[Sample] = field(default_factory=list)
    """by time"""

    def add(self, sample: Sample) -> None:
        if self.samples and sample[0] < self.samples[-1][0] - _BACKWARDS:
            self.samples.clear()
        insort(self.samples, sample)
        oldest = bisect_left(self.samples, (self.samples[-1][0] - _KEEP,))
        if oldest > 64:  # deleting each by itself would move all the others each time
            del self.samples[:oldest]

    def at(self, time: int) -> NDArray[np.float64] | None:
        """T_parent_child (4, 4); None before the first sample and after the last."""
        if self.fixed:
            return _matrix(self.samples[-1])
        index = bisect_right(self.samples, time, key=lambda sample: sample[0])
        if index == 0:
            return None
        begin = self.samples[index - 1]
        if begin[0] == time:
            return _matrix(begin)
        return None if index == len(self.samples) else _between(begin, self.samples[index], time)


class RecentTransforms:
    """Not thread-safe."""

    def __init__(self) -> None:
        """None so far."""
        self._links: dict[str, _Link] = {}

    def add(self, parent: str, child: str, sample: Sample, fixed: bool) -> None:
        """Takes T_parent_child; a fixed one holds for ever."""
        link = self._links.get(child)
        if link is None or link.parent != parent or link.fixed != fixed:
            link = self._links[child] = _Link(parent, fixed)
        if fixed:
            link.samples = [sample]
        else:
            link.add(sample)

    def latest(self, target: str, source: str) -> tuple[int, NDArray[np.float64]] | None:
        """T_target_source (4, 4) at the latest time [ns] at which all of the way is known; 0 if all of it is fixed."""
        up, down = self._way(source), self._way(target)
        common = next((frame for frame in up if frame in down), None)
        if common is None:
            return None
        ways = [way[: way.index(common)] for way in (up, down)]
        newest = [link.samples[-1][0] for link in self._moving(*ways)]
        time = min(newest, default=0)
        total_up, total_down = (self._product(way, time) for way in ways)
        if total_up is None or total_down is None:
            return None
        return time, np.asarray(np.linalg.inv(total_down) @ total_up)

    def _way(self, frame: str) -> list[str]:
        """The frame and those above it."""
        way = [frame]
        while (link := self._links.get(way[-1])) is not None and link.parent not in way:
            way.append(link.parent)
        return way

    def _moving(self, *ways: Iterable[str]) -> list[_Link]:
        return [link for way in ways for child in way if not (link := self._links[child]).fixed]

    def _product(self, way: list[str], time: int) -> NDArray[np.float64] | None:
        """Of the links from the first child to the last parent of a way."""
        total: NDArray[np.float64] = np.eye(4)
        for child in way:
            step = self._links[child].at(time)
            if step is None:
                return None
            total = step @ total
        return total


def _matrix(sample: Sample) -> NDArray[np.float64]:
    return homogeneous(sample[1], *sample[2])


def _between(begin: Sample, end: Sample, time: int) -> NDArray[np.float64]:
    part = (time - begin[0]) / (end[0] - begin[0])
    x, y, z = (a + part * (b - a) for a, b in zip(begin[1], end[1], strict=True))
    return homogeneous((x, y, z), *slerp(begin[2], end[2], part))


def slerp(begin: Quaternion, end: Quaternion, part: float) -> Quaternion:
    """The rotation that lies ``part`` of the shorter way from one unit quaternion to another."""
    cosine = sum(a * b for a, b in zip(begin, end, strict=True))
    sign = math.copysign(1.0, cosine)
    angle = math.acos(min(1.0, abs(cosine)))
    if angle < 1e-6:
        first, second = 1.0 - part, part
    else:
        first, second = math.sin((1.0 - part) * angle) / math.sin(angle), math.sin(part * angle) / math.sin(angle)
    x, y, z, w = (first * a + sign * second * b for a, b in zip(begin, end, strict=True))
    norm = math.hypot(x, y, z, w)
    return x / norm, y / norm, z / norm, w / norm
