# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The transforms of a bag: collects tf, finds the way from one frame to another, and brings it to the plane."""

import math
from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort.errors import InputError
from oort.poses import between
from oort.recording.types import Pose

_TILT = math.radians(5.0)  # a planar laser's range errs by 0.4 % at this tilt
_FIXED = (0.02, 0.02)  # [m], [rad]: how far a transform that should be fixed may vary


@dataclass(slots=True)
class Link:
    """All transforms of one parent and child: T_parent_child."""

    first: NDArray[np.float64]
    """(4, 4), the first one"""
    samples: "array[float]" = field(default_factory=lambda: array("d"))
    """time [s], x, y [m], theta [rad] of each, one after another"""
    by_topic: dict[str, Pose] = field(default_factory=dict)
    """the first one of each topic that told it"""

    def by_time(self) -> NDArray[np.float64]:
        """(n, 4) samples in the order of time; of equal times, in the order of the recording."""
        samples = np.frombuffer(self.samples, dtype=np.float64).reshape(-1, 4)
        return samples[np.argsort(samples[:, 0], kind="stable")]


class FrameTree:
    """The transforms seen so far, by parent and child frame."""

    def __init__(self) -> None:
        """An empty tree."""
        self.links: dict[str, dict[str, Link]] = {}
        """links[child][parent], in the order of appearance"""
        self.unusable = 0
        """how many transforms were left out because they are not finite or have no rotation"""

    def add(
        self,
        parent: str,
        child: str,
        time: float,
        translation: Sequence[float],
        quaternion: Sequence[float],
        topic: str = "",
    ) -> None:
        """Adds T_parent_child: translation x, y, z [m] and quaternion x, y, z, w of any length but zero."""
        rotation = unit_quaternion(*quaternion)
        if rotation is None or not all(map(math.isfinite, (time, *translation))):
            self.unusable += 1
            return
        parents = self.links.setdefault(child, {})
        if parent not in parents:
            parents[parent] = Link(homogeneous(translation, *rotation))
        pose = translation[0], translation[1], heading(*rotation)
        parents[parent].samples.extend((time, *pose))
        parents[parent].by_topic.setdefault(topic, pose)

    def above(self, frame: str) -> list[str]:
        """The frame and all frames above it, nearest first."""
        found = [frame]
        for current in found:
            found.extend(parent for parent in self.links.get(current, {}) if parent not in found)
        return found

    def way_up(self, frame: str, ancestor: str) -> list[str]:
        """The frames from `frame` up to `ancestor`, both included, by the shortest way; empty if there is none."""
        came_from = {frame: ""}
        queue = [frame]
        for current in queue:
            for parent in self.links.get(current, {}):
                if parent not in came_from:
                    came_from[parent] = current
                    queue.append(parent)
        if ancestor not in came_from:
            return []
        way = [ancestor]
        while came_from[way[-1]]:
            way.append(came_from[way[-1]])
        return way[::-1]

    def mount(self, base: str, sensor: str, kind: str = "laser") -> NDArray[np.float64]:
        """T_base_sensor (4, 4) of a kind of sensor. Raises InputError if there is no transform or it varies."""
        up, down = self.ways(base, sensor)
        named = f"{kind} (frame {sensor})"
        return np.asarray(np.linalg.inv(self._fixed(up, named)) @ self._fixed(down, named), dtype=np.float64)

    def ways(self, base: str, sensor: str) -> tuple[list[str], list[str]]:
        """From base and from sensor up to where they meet (way_up). Raises InputError if they do not."""
        above_sensor = self.above(sensor)
        common = next((frame for frame in self.above(base) if frame in above_sensor), None)
        if common is None:
            raise InputError(
                f"no transform leads from the base's frame {base!r} to the laser's {sensor!r}; the bag has "
                f"{self.describe()}. Record /tf and /tf_static, or say where the laser sits with mount (--mount X "
                "Y THETA)"
            )
        return self.way_up(base, common), self.way_up(sensor, common)

    def _fixed(self, way: list[str], sensor: str) -> NDArray[np.float64]:
        """T_last_first of a way up whose transforms must not vary, as they carry a sensor."""
        total = np.eye(4)
        for child, parent in pairwise(way):
            link = self.links[child][parent]
            poses = link.by_time()[:, 1:]
            variation = describe_variation(parent, child, poses[0], poses, sensor)
            if variation:
                raise InputError(variation + _told_by(link))
            total = link.first @ total
        return total

    def describe(self) -> str:
        """All links, for messages."""
        pairs = [f"{parent} -> {child}" for child, parents in self.links.items() for parent in parents]
        return ", ".join(sorted(pairs)[:20]) or "no transforms"


def _told_by(link: Link) -> str:
    """What each topic says of a link that several topics tell, and what to do."""
    said = [f"{topic} says ({x:z.3f}, {y:z.3f}, {theta:z.3f})" for topic, (x, y, theta) in link.by_topic.items()]
    several = f". {' and '.join(said)}: several programs tell it" if len(said) > 1 else ""
    return f"{several}; mount (--mount X Y THETA) says where it is"


def describe_variation(parent: str, child: str, first: ArrayLike, others: ArrayLike, sensor: str = "laser") -> str:
    """Says so if poses (x, y [m], theta [rad]) of a link that carries a sensor differ from the first; else empty."""
    changes = np.abs(between(first, np.atleast_2d(others))).max(axis=0)
    moved, turned = changes[:2].max(), changes[2]
    if moved <= _FIXED[0] and turned <= _FIXED[1]:
        return ""
    return (
        f"the transform {parent} -> {child} between the robot's base and its {sensor} varies by {moved:.2f} m and "
        f"{math.degrees(turned):.1f} degrees; the {sensor} must be fixed on the base"
    )


def unit_quaternion(x: float, y: float, z: float, w: float) -> tuple[float, float, float, float] | None:
    """The quaternion at length 1; None if it is not finite or has no length."""
    norm = math.hypot(x, y, z, w)
    if not math.isfinite(norm) or norm < 1e-3:
        return None
    return x / norm, y / norm, z / norm, w / norm


def heading(x: float, y: float, z: float, w: float) -> float:
    """The yaw [rad] of a unit quaternion."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def to_plane(T_base_sensor: NDArray[np.float64], sensor: str) -> tuple[Pose, bool]:  # noqa: N803
    """The sensor's planar pose on the base, and whether it hangs upside down.

    Upside down (a roll of 180 degrees), a bearing counts clockwise on the base: the caller turns the beams round.
    Raises InputError if the sensor is tilted by more than 5 degrees.
    """
    upward = float(T_base_sensor[2, 2])  # cosine of the angle between the two z axes
    if abs(upward) < math.cos(_TILT):
        raise InputError(
            f"the laser's frame {sensor} is tilted by {math.degrees(math.acos(abs(upward))):.0f} degrees against the "
            "base; only a level laser, upright or upside down, can be used"
        )
    yaw = math.atan2(T_base_sensor[1, 0], T_base_sensor[0, 0])
    return (float(T_base_sensor[0, 3]), float(T_base_sensor[1, 3]), yaw), upward < 0.0


def homogeneous(translation: Sequence[float], x: float, y: float, z: float, w: float) -> NDArray[np.float64]:
    """The homogeneous matrix of a translation and a unit quaternion."""
    tx, ty, tz = translation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), tx],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), ty],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), tz],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
