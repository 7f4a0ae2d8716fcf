# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A bare corridor: does the map shrink or stretch along it more than the odometry does, and does the chain say so?

The map's x axis is the corridor's: the drive begins along it, and the map's origin is the first sensor pose.
"""

import numpy as np

from oort.poses import Array, between, compose
from oort.simulate import Drive
from trials.replays import Replayed
from trials.truth import Edges, compose_chain, true_nodes

Figures = dict[str, float]


def measure_corridor(drive: Drive, replayed: Replayed) -> Figures:
    """Errors along (x) and across (y) at the drive's end, or where they are largest, and how honest the chain is."""
    errors = replayed.T_map_base - drive.T_map_base
    figures: Figures = {
        "along_end": abs(float(errors[-1, 0])),
        "along_max": float(np.abs(errors[:, 0]).max()),
        "across_max": float(np.abs(errors[:, 1]).max()),
    }
    raw = compose(drive.T_map_base[0], between(drive.T_odom_base_at_scans[0], drive.T_odom_base_at_scans))
    steered = _with_true_headings(drive)
    for name, seen in (("odometry", raw), ("odometry_steered", steered)):
        off = seen[:, :2] - drive.T_map_base[:, :2]
        figures[f"{name}_along_end"] = abs(float(off[-1, 0]))
        figures[f"{name}_along_max"] = float(np.abs(off[:, 0]).max())
        figures[f"{name}_across_max"] = float(np.abs(off[:, 1]).max())
    return figures | _chain(drive, replayed)


def _with_true_headings(drive: Drive) -> Array:
    """(n, 2) positions by the odometry's ways and the true headings: what a match can do that knows nothing along."""
    moved = between(drive.T_odom_base_at_scans[:-1], drive.T_odom_base_at_scans[1:])
    moved[:, 2] = 0.0
    steps = compose(drive.T_map_base[:-1] * [0.0, 0.0, 1.0], moved)[:, :2]
    return drive.T_map_base[0, :2] + np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])


def _chain(drive: Drive, replayed: Replayed) -> Figures:
    """The last node as the chain alone places it: its error and what the chain's covariances say of that."""
    map_ = replayed.drive.session.map
    truth, _ = true_nodes(map_, drive)
    last = _way_to(map_.edges, len(map_) - 1)
    pose, covariance = compose_chain(map_.edges["pose"][last], map_.edges["covariance"][last])
    error = pose - between(truth[0], truth[-1])
    return {
        "chain_along": abs(float(error[0])),
        "chain_along_std": float(np.sqrt(covariance[0, 0])),
        "chain_along_nees": float(error[0] ** 2 / covariance[0, 0]),
        "chain_across": abs(float(error[1])),
        "chain_across_nees": float(error[1] ** 2 / covariance[1, 1]),
    }


def _way_to(edges: Edges, node: int) -> list[int]:
    """The edges that lead from node 0 to a node: of each node the matched one if there is one, else odometry's."""
    into: dict[int, int] = {}
    for edge in range(len(edges["i"])):
        j = int(edges["j"][edge])
        if j not in into or edges["type"][edge] == 0:
            into[j] = edge
    way: list[int] = []
    while node != 0:
        way.append(into[node])
        node = int(edges["i"][into[node]])
    return way[::-1]
