# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finds a robot on a saved map, without changing the map."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort import _core
from oort._core import (
    Hypothesis,
    LocalizationState,
    Map,
    Parameters,
    PlacedScan,
    ReferenceMap,
    Relocalization,
    Relocalizer,
)
from oort.errors import InputError
from oort.poses import as_pose, between, compose
from oort.recording import LaserScan, Pose, Recording, Scan
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


class Localizer(_core.Localizer):
    """Follows a robot on a map that does not change; without a start it searches the whole map. Not thread-safe."""

    def __init__(
        self, map_: Map | ReferenceMap, config: Parameters | None = None, sensor_on_base: ArrayLike = (0.0, 0.0, 0.0)
    ) -> None:
        """Starts searching. ``config`` are the parameters, the defaults if not given; ``sensor_on_base`` T_base_sensor.

        Raises InputError if the map is empty or contradicts itself.
        """
        parameters = Parameters() if config is None else config
        reference = map_ if isinstance(map_, ReferenceMap) else ReferenceMap(map_, parameters)
        mount = as_pose(sensor_on_base, "Localizer: sensor_on_base")
        super().__init__(reference, parameters, mount)
        self._sensor_to_base = between(mount, (0.0, 0.0, 0.0))  # T_sensor_base

    def add_scan(self, scan: LaserScan, odometry: ArrayLike) -> LocalizationState:
        """Takes the next scan with ``odometry``, T_odom_base at its stamp; the state, see `state`.

        Raises InputError if the scan's limits or the pose are not finite; nothing changes then.
        """
        self.add_ranges(*scan.readings, as_pose(odometry, "Localizer.add_scan: odometry"), scan.sweep)
        return self.state

    def add_scan_of_other(self, scan: LaserScan, odometry: ArrayLike, sensor_on_base: ArrayLike) -> None:
        """Takes a scan of another laser, which sits at ``sensor_on_base``: it joins the next scan of the main laser.

        Raises InputError as add_scan().
        """
        pose = as_pose(odometry, "Localizer.add_scan_of_other: odometry")
        mount = as_pose(sensor_on_base, "Localizer.add_scan_of_other: sensor_on_base")
        self.add_ranges_of_other(mount, *scan.readings, pose, scan.sweep)

    @property
    def T_map_base(self) -> Pose | None:  # noqa: N802
        """The base's pose at the latest scan; None while searching."""
        return None if self.T_map_sensor is None else _pose(compose(self.T_map_sensor, self._sensor_to_base))


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
    recording.require_odometry("a search for where it begins")
    localizer = Localizer(ReferenceMap(map_, parameters), parameters, recording.sensor_on_base)
    first: Scan | None = None
    for scan in recording.scans():
        if scan.mount is not None:
            localizer.add_scan_of_other(scan, scan.odometry, scan.mount)
            continue
        first = first or scan
        localizer.add_scan(scan, scan.odometry)
        if localizer.T_map_odom is not None:
            return _pose(compose(compose(localizer.T_map_odom, first.odometry), recording.sensor_on_base))
    reasons = ", ".join(f"{why} {n}" for why, n in sorted(localizer.statistics["search_rejections"].items()))
    raise InputError(
        f"{recording.name}: where on the map it begins was not found ({reasons or 'no scan'}); give the pose"
    )


def start_pose(map_: Map, parameters: Parameters, start: str) -> Pose:
    """T_map_sensor at the dock (``dock``) or where mapping ended (``last``). Raises InputError if there is none."""
    if len(map_) == 0:
        raise InputError("the map is empty: there is no place on it to start at")
    if start == "last":
        return _pose(map_.node_poses[-1])
    docks = [id for name_space, id, *_ in map_.locations if name_space == "dock"]
    pose = map_.locate("dock", docks[0]) if docks else None
    if pose is None:
        raise InputError(
            "the map has no dock: name it while mapping (with oort replay --events FILE, in a robot graph_loc/create), "
            "or start another way"
        )
    return pose


def start_covariance(position: float = 0.15, heading: float = 0.15) -> NDArray[np.float64]:
    """Covariance (3, 3) of a pose that is known to about so many metres and radians (standard deviations)."""
    return np.diag([position**2, position**2, heading**2])


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
    sweep = placement.of_child(mount).sweep if mount else None
    return PlacedScan(*scan.readings, pose, sweep)


def _pose(pose: NDArray[np.float64]) -> Pose:
    x, y, theta = pose.tolist()
    return x, y, theta
