# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Compares trajectories of the robot's base with the truth: errors of relations and of absolute poses."""

import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from oort.errors import InputError
from oort.export.tum import Trajectory
from oort.inputs import read_rows
from oort.poses import between, compose, wrap_angle

_ROUNDED = 1.001e-4  # [s] between a time of a relation that was rounded and the pose's
_MAX_MISSING = 0.05  # share of relations or poses without a counterpart above which the result would mislead
_MAX_GAP = 0.2  # [s]; the truth is interpolated between stamps at most this far apart


@dataclass(frozen=True, slots=True)
class RelationsResult:
    """The errors over all relations that could be compared."""

    n: int
    missing: int
    """relations whose times are not in the trajectory"""
    translation_mean: float
    """[m], like std and max, of the absolute error"""
    translation_std: float
    translation_max: float
    rotation_mean: float
    """[deg], like std and max, of the absolute error"""
    rotation_std: float
    rotation_max: float
    squared_translation_mean: float
    """[m^2], like std"""
    squared_translation_std: float
    squared_rotation_mean: float
    """[deg^2], like std"""
    squared_rotation_std: float


@dataclass(frozen=True, slots=True)
class AteResult:
    """The absolute trajectory error after the best rigid motion of the plane."""

    n: int
    missing: int
    """poses of the trajectory without truth at their time"""
    position_rmse: float
    """[m]"""
    position_max: float
    """[m]"""
    heading_rmse: float
    """[deg]"""


def evaluate_relations(
    trajectory: Trajectory, path: str | os.PathLike[str], *, max_seconds: float | None = None
) -> RelationsResult:
    """The metric of Kuemmerle et al., "On measuring the accuracy of SLAM algorithms" (2009).

    A line of the file, `t1 t2 x y z roll pitch yaw`, is the true pose at t2 seen from the pose at t1. The error of a
    relation is the motion from the true to the estimated one. Times are keys, compared after rounding to 6 decimals.
    With `max_seconds`, only relations with |t2 - t1| < max_seconds [s] count. The standard deviation is that of the
    relations themselves (division by n). Raises InputError if the file is damaged, more than 5 % of the relations
    are not in the trajectory, or none is left.
    """
    errors = relation_errors(trajectory, path, max_seconds=max_seconds)
    found = np.isfinite(errors[:, 0])
    missing = int(np.count_nonzero(~found))
    errors = errors[found]
    translation, rotation = np.hypot(errors[:, 0], errors[:, 1]), np.degrees(np.abs(errors[:, 2]))
    return RelationsResult(
        n=len(errors),
        missing=missing,
        translation_mean=float(translation.mean()),
        translation_std=float(translation.std()),
        translation_max=float(translation.max()),
        rotation_mean=float(rotation.mean()),
        rotation_std=float(rotation.std()),
        rotation_max=float(rotation.max()),
        squared_translation_mean=float((translation**2).mean()),
        squared_translation_std=float((translation**2).std()),
        squared_rotation_mean=float((rotation**2).mean()),
        squared_rotation_std=float((rotation**2).std()),
    )


def relation_errors(
    trajectory: Trajectory, path: str | os.PathLike[str], *, max_seconds: float | None = None
) -> NDArray[np.float64]:
    """The motion from the true to the estimated pose, (n, 3) in m and rad, of each relation of the file in its order.

    Rows are NaN where a time is not in the trajectory. The file and what is raised are those of evaluate_relations.
    """
    return compare_relations(trajectory, path, max_seconds=max_seconds)[1]


def compare_relations(
    trajectory: Trajectory, path: str | os.PathLike[str], *, max_seconds: float | None = None
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Which poses of the trajectory (n, 2) each relation is of, -1 for none, and relation_errors()."""
    relations = read_relations(Path(path))
    if max_seconds is not None:
        relations = relations[np.abs(relations[:, 1] - relations[:, 0]) < max_seconds]
    if not len(relations):
        raise InputError(f"{path} holds no relation{'' if max_seconds is None else f' under {max_seconds} s'}")
    ends = _places(trajectory, relations[:, :2])
    found: NDArray[np.bool_] = np.all(ends >= 0, axis=1)
    _check_missing(int(np.count_nonzero(~found)), len(found), f"relations of {path}")
    errors = np.full((len(relations), 3), np.nan)
    estimated = between(trajectory.poses[ends[found, 0]], trajectory.poses[ends[found, 1]])
    errors[found] = between(relations[found][:, [2, 3, 7]], estimated)
    return ends, errors


def read_relations(path: Path) -> NDArray[np.float64]:
    """(n, 8) rows as in the file."""
    rows = [values for _, _, values in read_rows(path, "t1 t2 x y z roll pitch yaw")]
    return np.array(rows, dtype=np.float64).reshape(-1, 8)


def _places(trajectory: Trajectory, times: NDArray[np.float64]) -> NDArray[np.int64]:
    """Which pose is that of each time, in the shape of ``times``; -1 for none.

    A time is one to 6 decimals; of a file whose times were rounded, one within 1e-4 s of it.
    """
    index = {round(time, 6): i for i, time in enumerate(trajectory.times.tolist())}
    if len(index) < len(trajectory.stamps):
        raise InputError("two poses of the trajectory have the same time to 6 decimals: a relation could mean either")
    order = np.argsort(trajectory.times, kind="stable")
    known = trajectory.times[order]
    after = np.clip(np.searchsorted(known, times), 1, max(len(known) - 1, 1))
    places = np.full(times.shape, -1, dtype=np.int64)
    for place, time in np.ndenumerate(times):
        exact = index.get(round(float(time), 6))
        if exact is not None:
            places[place] = exact
        elif len(known) > 1:
            k = int(after[place])
            nearest = k if abs(known[k] - time) < abs(known[k - 1] - time) else k - 1
            if abs(known[nearest] - time) <= _ROUNDED:
                places[place] = order[nearest]
    return places


def evaluate_ate(trajectory: Trajectory, truth: Trajectory) -> AteResult:
    """Position and heading errors after a rigid motion (no scale) that fits the positions best in least squares.

    The truth is interpolated at the trajectory's times, where its neighbours are at most 0.2 s apart. Raises
    InputError if more than 5 % of the poses have no truth.
    """
    _, errors = compare_poses(trajectory, truth)
    found = np.isfinite(errors[:, 0])
    errors = errors[found]
    distances = np.hypot(errors[:, 0], errors[:, 1])
    return AteResult(
        n=len(errors),
        missing=int(np.count_nonzero(~found)),
        position_rmse=float(np.sqrt(np.mean(distances**2))),
        position_max=float(distances.max()),
        heading_rmse=math.degrees(float(np.sqrt(np.mean(errors[:, 2] ** 2)))),
    )


def compare_poses(trajectory: Trajectory, truth: Trajectory) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The true poses (n, 3), moved onto the trajectory as evaluate_ate() does it, and the motion from each to the
    trajectory's (n, 3), in m and rad. Rows are NaN where there is no truth. Raises what evaluate_ate() raises.
    """
    reference, found = _truth_at(trajectory.times, truth)
    _check_missing(int(np.count_nonzero(~found)), len(found), "poses")
    T_reference_estimated = alignment(trajectory.poses[found], reference[found])
    errors = np.full((len(found), 3), np.nan)
    errors[found] = between(reference[found], compose(T_reference_estimated, trajectory.poses[found]))
    moved = np.full((len(found), 3), np.nan)
    moved[found] = between(T_reference_estimated, reference[found])
    return moved, errors


def _truth_at(times: NDArray[np.float64], truth: Trajectory) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """The true poses (n, 3) at the times, and where there are any."""
    order = np.argsort(truth.times, kind="stable")
    known, poses = truth.times[order], truth.poses[order]
    after = np.clip(np.searchsorted(known, times - 1e-6), 0, len(known) - 1)
    exact = np.abs(known[after] - times) <= 1e-6
    before = np.where(exact, after, np.maximum(after - 1, 0))
    gap = known[after] - known[before]
    found = exact | ((known[before] < times) & (times < known[after]) & (gap <= _MAX_GAP))
    fraction = np.where(gap > 0.0, (times - known[before]) / np.where(gap > 0.0, gap, 1.0), 0.0)[:, None]
    step = poses[after] - poses[before]
    step[:, 2] = wrap_angle(step[:, 2])
    return poses[before] + fraction * step, found


def alignment(estimated: NDArray[np.float64], reference: NDArray[np.float64]) -> NDArray[np.float64]:
    """T_reference_estimated (3,) that minimises the sum of squared distances of the positions.

    The planar case of Umeyama (1991) without scale: with centred positions a and b the angle is
    atan2(sum a x b, sum a . b). Of a robot that never moved the headings' mean difference is taken.
    """
    p, q = estimated[:, :2], reference[:, :2]
    a, b = p - p.mean(axis=0), q - q.mean(axis=0)
    cross, dot = float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b))
    if math.hypot(cross, dot) < 1e-12:
        turns = reference[:, 2] - estimated[:, 2]
        cross, dot = float(np.sin(turns).sum()), float(np.cos(turns).sum())
    theta = math.atan2(cross, dot)
    turned = compose((0.0, 0.0, theta), (*p.mean(axis=0), 0.0))
    return np.array([*(q.mean(axis=0) - turned[:2]), theta])


def _check_missing(missing: int, total: int, what: str) -> None:
    if missing > _MAX_MISSING * total:
        raise InputError(
            f"{missing} of {total} {what} have no counterpart at their time; are the two files of the same recording?"
        )
