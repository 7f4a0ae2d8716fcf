# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Relations to evaluate trajectories with, taken from a solved map where nothing better is known.

What Cartographer's evaluation does: at a loop closure that fits the whole solution, the solution's own relative pose of
the two nodes is taken for the truth. It judges tracking and odometry over long ways; it cannot judge the map itself.
"""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort._core import SWITCH_ON, Map
from oort.errors import InputError
from oort.export.files import decimal, write_atomically
from oort.poses import between, compose


@dataclass(frozen=True, slots=True)
class RelationLimits:
    """Which closures are taken. The defaults are Cartographer's."""

    min_covered_distance: float = 100.0
    """[m] driven between the two nodes"""
    outlier_threshold_meters: float = 0.15
    """of a closure's measurement from the solution"""
    outlier_threshold_radians: float = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class GroundTruth:
    """Relations, and what became of the map's closures; each is counted once."""

    relations: NDArray[np.float64]
    """(n, 5) t1, t2 [s] of the older and the newer node, and the base's pose x, y [m], theta [rad] at t2 from t1"""
    closures: int
    switched_off: int
    """that the solution rejects"""
    too_short: int
    outliers: int
    repeated: int
    """of the same two nodes as another"""


def autogenerate_relations(
    map_: Map, sensor_on_base: ArrayLike = (0.0, 0.0, 0.0), limits: RelationLimits | None = None
) -> GroundTruth:
    """Relations from the closures of a solved map. `sensor_on_base` is T_base_sensor, which a map does not hold.

    What lies between two segments of a map is not driven and does not count as distance. Raises InputError if the
    map has no closure, or none is within the limits.
    """
    limits = limits or RelationLimits()
    edges, poses = map_.switchable_edges, map_.node_poses
    ends = np.sort(np.stack([edges["i"], edges["j"]], axis=1).astype(np.int64), axis=1)
    on = edges["switch"] >= SWITCH_ON
    covered = _driven(map_)
    long = covered[ends[:, 1]] - covered[ends[:, 0]] >= limits.min_covered_distance
    off_by = between(edges["pose"], between(poses[edges["i"].astype(np.int64)], poses[edges["j"].astype(np.int64)]))
    fits = np.hypot(off_by[:, 0], off_by[:, 1]) <= limits.outlier_threshold_meters
    fits &= np.abs(off_by[:, 2]) <= limits.outlier_threshold_radians
    chosen = np.unique(ends[on & long & fits], axis=0)
    if not len(chosen):
        raise InputError(
            f"none of the map's {len(on)} closures gives a relation: {int((~on).sum())} are switched off, "
            f"{int((on & ~long).sum())} are over less than {limits.min_covered_distance:g} m, "
            f"{int((on & long & ~fits).sum())} do not fit the solution; lower the limits or drive a longer way"
        )
    base = compose(poses, between(sensor_on_base, np.zeros(3)))
    relative = between(base[chosen[:, 0]], base[chosen[:, 1]])
    return GroundTruth(
        relations=np.concatenate([map_.cloud_times[chosen], relative], axis=1),
        closures=len(on),
        switched_off=int((~on).sum()),
        too_short=int((on & ~long).sum()),
        outliers=int((on & long & ~fits).sum()),
        repeated=int((on & long & fits).sum()) - len(chosen),
    )


def write_relations(path: str | os.PathLike[str], relations: NDArray[np.float64]) -> None:
    """Writes (n, 5) rows as lines `t1 t2 x y z roll pitch yaw`. Raises OortError if the file cannot be written."""
    lines = [
        f"{decimal(t1)} {decimal(t2)} {decimal(x)} {decimal(y)} 0 0 0 {decimal(yaw)}\n"
        for t1, t2, x, y, yaw in relations.tolist()
    ]
    write_atomically(Path(path), "".join(lines).encode())


def _driven(map_: Map) -> NDArray[np.float64]:
    """(N,) the way driven up to each node [m]."""
    steps = np.hypot(*np.diff(map_.node_poses[:, :2], axis=0, prepend=map_.node_poses[:1, :2]).T)
    results = map_.incremental_results
    steps[results["id"][results["id"] == results["target"]].astype(np.int64)] = 0.0  # the first of a segment
    return np.asarray(np.cumsum(steps), dtype=np.float64)
