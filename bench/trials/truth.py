# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the truth says of a map's chain: covariances that promise too much or too little.

An edge's error is its measured T_i_j less the true one, x, y along the axes of node i, and theta: what the optimiser
and the edge's covariance speak of. NEES (normalised estimation error squared) is e^T covariance^-1 e; where a
covariance is honest its mean is the number of components.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort import Map
from oort.poses import Array, between, compose, wrap_angle
from oort.simulate import Drive
from oort.simulate.person import LEG_RADIUS
from oort.simulate.sensor import cast_drive

WIDE = 3.0
"""A covariance is wide in one direction if its standard deviation there is this many times that across."""

FREE = 3.0
"""A scan leaves a direction free if what holds it there is less than this many beams on a wall head-on."""

CHI2_99 = 11.345
"""Of 3 degrees of freedom."""

_JUMP = 0.5  # [m] between the ends of beams that are not on the same surface

Edges = dict[str, NDArray[Any]]


def true_nodes(map_: Map, drive: Drive) -> tuple[Array, NDArray[np.int64]]:
    """T_map_sensor (N, 3) of each node as it is, and the index (N,) of the scan that made the node."""
    scans = np.searchsorted(drive.scan_times, map_.cloud_times - 1e-4)
    if np.abs(drive.scan_times[scans] - map_.cloud_times).max() > 1e-4:
        raise ValueError("a node's cloud is of no scan of the drive")
    return compose(drive.T_map_base[scans], drive.T_base_sensor), scans.astype(np.int64)


def edge_errors(edges: Edges, truth: Array) -> Array:
    """(E, 3) errors of edges between nodes whose true poses are given."""
    i, j = edges["i"].astype(np.int64), edges["j"].astype(np.int64)
    errors: Array = edges["pose"] - between(truth[i], truth[j])
    errors[:, 2] = wrap_angle(errors[:, 2])
    return errors


def nees(errors: Array, covariances: Array) -> Array:
    """(n,) of errors (n, d) with covariances (n, d, d)."""
    return np.asarray(np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariances), errors))


def calibration_figures(map_: Map, drive: Drive) -> dict[str, float]:
    """Sums over the chain's edges; a mean is a sum over its count. See the table for what they mean."""
    truth, scans = true_nodes(map_, drive)
    edges = map_.edges
    laser = edges["type"] == 0
    errors, covariances = edge_errors(edges, truth), np.asarray(edges["covariance"])
    figures = _sums("laser", errors[laser], covariances[laser]) | _way(edges["pose"][laser], errors[laser])
    figures |= _sums("odometry", errors[~laser], covariances[~laser])
    figures |= _sums("span", *_spans(edges, truth))
    figures |= _wide(errors[laser], covariances[laser])
    i, j = edges["i"][laser].astype(np.int64), edges["j"][laser].astype(np.int64)
    direction, free = free_directions(drive, scans)
    turned = direction[j] + (truth[j, 2] - truth[i, 2])
    figures |= _along("free", errors[laser][free[j]], covariances[laser][free[j]], turned[free[j]])
    return figures


def _sums(name: str, errors: Array, covariances: Array) -> dict[str, float]:
    values = nees(errors, covariances)
    variances = np.diagonal(covariances, axis1=1, axis2=2)
    x, y, theta = np.sum(errors**2 / variances, axis=0).tolist()
    return {
        f"{name}_edges": float(len(errors)),
        f"{name}_nees": float(values.sum()),
        f"{name}_over_99": float((values > CHI2_99).sum()),
        f"{name}_nees_x": x,
        f"{name}_nees_y": y,
        f"{name}_nees_theta": theta,
    }


def _way(measured: Array, errors: Array) -> dict[str, float]:
    """How far the edges went forwards or backwards in truth, and how much farther they say that they did [m]."""
    true = measured[:, 0] - errors[:, 0]
    return {"laser_way": float(np.abs(true).sum()), "laser_way_error": float(np.sum(np.sign(true) * errors[:, 0]))}


def _wide(errors: Array, covariances: Array) -> dict[str, float]:
    """Of the edges that say themselves that they know one direction badly: the error along it."""
    values, vectors = np.linalg.eigh(covariances[:, :2, :2])
    wide = values[:, 1] > WIDE**2 * values[:, 0]
    angles = np.arctan2(vectors[:, 1, 1], vectors[:, 0, 1])
    return _along("wide", errors[wide], covariances[wide], angles[wide])


def _along(name: str, errors: Array, covariances: Array, angles: Array) -> dict[str, float]:
    """Squared errors and variances along directions (n,) [rad] in the frames of the edges' first nodes, summed."""
    direction = np.column_stack([np.cos(angles), np.sin(angles)])
    along = np.einsum("ni,ni->n", direction, errors[:, :2])
    variance = np.einsum("ni,nij,nj->n", direction, covariances[:, :2, :2], direction)
    return {
        f"{name}_edges": float(len(errors)),
        f"{name}_nees": float(np.sum(along**2 / variance)),
        f"{name}_squared_error": float(np.sum(along**2)),
        f"{name}_variance": float(np.sum(variance)),
    }


def free_directions(drive: Drive, scans: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
    """The direction (n,) [rad] in which each scan holds least by what it truly sees, and whether it is free there.

    From the surfaces where its beams end, without noise: sum n n^T over their normals n, whose least eigenvalue is in
    units of beams on a wall head-on.
    """
    poses = compose(drive.T_map_base[scans], drive.T_base_sensor)
    sensor = drive.config.sensor
    ranges, _ = cast_drive(sensor, poses, drive.home.segments, drive.home.discs, drive.legs[scans], LEG_RADIUS)
    ends = np.where(np.isfinite(ranges), ranges, 0.0)[:, :, None] * np.column_stack(
        [np.cos(sensor.angles), np.sin(sensor.angles)]
    )
    side = ends[:, 1:] - ends[:, :-1]
    length = np.hypot(side[:, :, 0], side[:, :, 1])
    held = np.isfinite(ranges[:, 1:] + ranges[:, :-1]) & (length > 0.0) & (length < _JUMP)
    tangent = np.where(held[:, :, None], side / np.where(held, length, 1.0)[:, :, None], 0.0)
    normal = np.stack([-tangent[:, :, 1], tangent[:, :, 0]], axis=-1)
    values, vectors = np.linalg.eigh(np.einsum("nbi,nbj->nij", normal, normal))
    return np.arctan2(vectors[:, 1, 0], vectors[:, 0, 0]), values[:, 0] < FREE


def _spans(edges: Edges, truth: Array, length: int = 10) -> tuple[Array, Array]:
    """Errors and covariances over so many laser edges in a row: errors that hang together show only there."""
    errors, covariances = [], []
    i, j, laser = edges["i"].astype(np.int64), edges["j"].astype(np.int64), edges["type"] == 0
    ends: list[int] = []
    for edge in np.flatnonzero(laser):
        ends = [*ends, int(edge)] if ends and j[ends[-1]] == i[edge] else [int(edge)]
        if len(ends) == length:
            pose, covariance = compose_chain(edges["pose"][ends], edges["covariance"][ends])
            error = pose - between(truth[i[ends[0]]], truth[j[ends[-1]]])
            errors.append([error[0], error[1], float(wrap_angle(error[2]))])
            covariances.append(covariance)
            ends = []
    return np.array(errors).reshape(-1, 3), np.array(covariances).reshape(-1, 3, 3)


def compose_chain(poses: Array, covariances: Array) -> tuple[Array, Array]:
    """T_first_last (3,) of steps (n, 3) one after another, with its covariance along the axes of the first."""
    pose, covariance = np.zeros(3), np.zeros((3, 3))
    for step, its in zip(poses, covariances, strict=True):
        cosine, sine = np.cos(pose[2]), np.sin(pose[2])
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        lever = np.eye(3)
        lever[:2, 2] = [-sine * step[0] - cosine * step[1], cosine * step[0] - sine * step[1]]
        covariance = lever @ covariance @ lever.T + turn @ its @ turn.T
        pose = compose(pose, step)
    return pose, covariance
