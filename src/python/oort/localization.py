# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finds a robot on a saved map, without changing the map."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from oort._core import (
    Hypothesis,
    Localizer,
    Map,
    Mapper,
    Parameters,
    PlacedScan,
    ReferenceMap,
    Relocalization,
    Relocalizer,
)
from oort.errors import InputError
from oort.poses import between, compose
from oort.recording import Pose, Recording, Scan
from oort.recording.motion import Placement

__all__ = [
    "Hypothesis",
    "Localizer",
    "PlacedScan",
    "ReferenceMap",
    "Relocalization",
    "Relocalizer",
    "find_pose",
    "find_start",
    "start_covariance",
    "start_pose",
]

STARTS = ("global", "dock", "last", "pose")
"""How a localiser may begin: by a search of the whole map, at the dock, where mapping ended, or at a given pose."""


def find_pose(
    map_: Map, parameters: Parameters, scans: Sequence[Scan], sensor_on_base: Pose = (0.0, 0.0, 0.0)
) -> Relocalization:
    """Finds where on the map the last of some scans was taken, without a guess.

    ``scans`` are consecutive scans of a drive with their odometry, oldest first; of these the latest few different
    views are looked for together (``localization.relocalizer``). Raises InputError for an empty map or no scan.
    """
    views = _views(parameters, scans, sensor_on_base)
    return Relocalizer(ReferenceMap(map_, parameters), parameters).find(views)


def find_start(map_: Map, parameters: Parameters, recording: Recording) -> Pose:
    """T_map_sensor at the first scan of a recording, found without a guess in the first scans that allow it.

    Raises InputError if the whole recording does not tell where on the map it was taken.
    """
    localizer = Localizer(ReferenceMap(map_, parameters), parameters, recording.sensor_on_base)
    first: Scan | None = None
    for scan in recording.scans():
        first = first or scan
        _add(localizer, scan)
        if localizer.T_map_odom is not None:
            return _pose(compose(compose(localizer.T_map_odom, first.odometry), recording.sensor_on_base))
    reasons = ", ".join(f"{why} {n}" for why, n in sorted(localizer.statistics["search_refusals"].items()))
    raise InputError(
        f"{recording.name}: where on the map it begins was not found ({reasons or 'no scan'}); give the pose"
    )


def start_pose(map_: Map, parameters: Parameters, start: str) -> Pose:
    """T_map_sensor at the dock (``dock``) or where mapping ended (``last``). Raises InputError if there is none."""
    if len(map_) == 0:
        raise InputError("the map is empty: there is no place on it to start at")
    if start == "last":
        return _pose(map_.node_poses[-1])
    mapper = Mapper(parameters)
    mapper.set_map(map_)
    docks = [id for name_space, id, *_ in mapper.locations if name_space == "dock"]
    pose = mapper.locate("dock", docks[0]) if docks else None
    if pose is None:
        raise InputError("the map has no dock: create the place dock/dock while mapping, or start another way")
    return pose


def start_covariance(position: float = 0.15, heading: float = 0.15) -> NDArray[np.float64]:
    """Covariance (3, 3) of a pose that is known to about so many metres and radians (standard deviations)."""
    return np.diag([position**2, position**2, heading**2])


def _add(localizer: Localizer, scan: Scan) -> None:
    localizer.add_scan(*scan.arguments)


def _views(parameters: Parameters, scans: Sequence[Scan], sensor_on_base: Pose) -> list[PlacedScan]:
    """The last scan, and before it up to max_scans in all that each show something else than the one after."""
    count = int(parameters.get("localization.relocalizer.max_scans"))
    distance = float(parameters.get("localization.relocalizer.scan_distance"))
    angle = float(parameters.get("localization.relocalizer.scan_angle"))
    compensates = bool(parameters.get("motion_compensation"))
    views: list[PlacedScan] = []
    newer: NDArray[np.float64] | None = None
    for scan in reversed(scans):
        pose = compose(scan.odometry, sensor_on_base)
        moved = None if newer is None else between(newer, pose)
        if moved is not None and np.hypot(moved[0], moved[1]) < distance and abs(moved[2]) < angle:
            continue
        newer = pose
        views.insert(0, _placed(scan, _pose(pose), sensor_on_base if compensates else None))
        if len(views) == count:
            break
    return views


def _placed(scan: Scan, pose: Pose, mount: Pose | None) -> PlacedScan:
    """``mount`` is T_base_sensor, or None where the beams count as measured at once."""
    placement = Placement(scan.odometry, scan.sweep if mount else None)
    time_, angle_min, angle_increment, range_min, range_max, ranges, *_ = scan.arguments
    sweep = placement.of_child(mount).sweep if mount else None
    return PlacedScan(time_, angle_min, angle_increment, range_min, range_max, ranges, pose, sweep)


def _pose(pose: NDArray[np.float64]) -> Pose:
    x, y, theta = pose.tolist()
    return x, y, theta
