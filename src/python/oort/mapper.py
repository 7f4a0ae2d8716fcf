# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The mapper for programs: scans and odometry in, a map and poses out."""

from numpy.typing import ArrayLike

from oort import _core
from oort._core import Parameters, ScanResult
from oort.errors import InputError
from oort.poses import as_pose
from oort.recording.types import LaserScan

__all__ = ["Mapper"]


class Mapper(_core.Mapper):
    """Turns scans with odometry into a map: nodes and edges, closures, solved poses, named places. Not thread-safe.

    Deterministic: the same calls give the same map. Poses are x, y [m], theta [rad]; `T_a_b` takes coordinates of b to
    a. Nodes are sensor poses, and the first of a new map is its origin.
    """

    def __init__(self, config: Parameters | None = None, sensor_on_base: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """An empty map; ``config`` are the parameters, the defaults if not given, ``sensor_on_base`` T_base_sensor.

        Raises ParameterError if the parameters contradict each other, InputError if the pose is not finite.
        """
        parameters = Parameters() if config is None else config
        super().__init__(parameters, as_pose(sensor_on_base, "Mapper: sensor_on_base"))
        self._use_odometry = bool(parameters.get("use_odometry"))

    def add_scan(self, scan: LaserScan, odometry: ArrayLike | None = None) -> ScanResult:
        """Takes the next scan with ``odometry``, T_odom_base at its stamp; what became of it, with the pose in the map.

        With use_odometry off it may be left out, and has no effect.

        Raises InputError if the scan's limits or the pose are not finite or the pose is missing, with nothing changed,
        and StateError after set_map() without begin_session().
        """
        if odometry is None:
            if self._use_odometry:
                raise InputError(
                    "Mapper.add_scan: no odometry was given; map without by Mapper(Config(use_odometry=False))"
                )
            odometry = (0.0, 0.0, 0.0)
        return self.add_ranges(*scan.readings, as_pose(odometry, "Mapper.add_scan: odometry"), scan.sweep)

    def add_scan_of_other(self, scan: LaserScan, odometry: ArrayLike, sensor_on_base: ArrayLike) -> None:
        """Takes a scan of another laser, which sits at ``sensor_on_base``: it joins the next scan of the main laser.

        Raises InputError as add_scan().
        """
        pose = as_pose(odometry, "Mapper.add_scan_of_other: odometry")
        mount = as_pose(sensor_on_base, "Mapper.add_scan_of_other: sensor_on_base")
        self.add_ranges_of_other(mount, *scan.readings, pose, scan.sweep)
