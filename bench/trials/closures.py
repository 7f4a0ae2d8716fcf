# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the truth says of a map's loop closures: which are wrong, and what they do to the map."""

import numpy as np
from numpy.typing import NDArray

from oort import Map
from oort._core import OptimizerOptions, optimize_graph
from oort.evaluation.trajectories import alignment
from oort.poses import Array, between, compose
from trials.truth import CHI2_99, edge_errors, nees

FALSE_BY = (0.3, np.radians(10.0))
"""A closure is false that is off by more than this [m], [rad]."""

POOR_BY = 0.1
"""A closure that is not false, but off by more than this [m], bends the map."""

ON = 0.5
"""A switch at least at this value counts as on: it is no closer to 0, off, than to 1."""


def false_closures(map_: Map, truth: Array) -> NDArray[np.bool_]:
    """(K,) whether each switchable edge is far from the truth, for true node poses (N, 3)."""
    errors = edge_errors(map_.switchable_edges, truth)
    far = np.hypot(errors[:, 0], errors[:, 1]) > FALSE_BY[0]
    return np.asarray(far | (np.abs(errors[:, 2]) > FALSE_BY[1]))


def closure_figures(map_: Map, truth: Array) -> dict[str, float]:
    """How many closures are true and false, kept and switched off; how honest those kept are; what they are worth."""
    edges = map_.switchable_edges
    false, on = false_closures(map_, truth), edges["switch"] >= ON
    errors, covariances = edge_errors(edges, truth)[on], np.asarray(edges["covariance"])[on]
    values, distance = nees(errors, covariances), np.hypot(errors[:, 0], errors[:, 1])
    return {
        "false_kept": float((false & on).sum()),
        "false_off": float((false & ~on).sum()),
        "true_kept": float((~false & on).sum()),
        "true_off": float((~false & ~on).sum()),
        "poor_kept": float(((distance > POOR_BY) & ~false[on]).sum()),
        "kept_nees": float(values.sum()),
        "kept_nees_median": float(np.median(values)) if len(values) else 0.0,
        "kept_over_99": float((values > CHI2_99).sum()),
        **_worth(map_, truth),
    }


def _worth(map_: Map, truth: Array) -> dict[str, float]:
    """Position errors [m] of the nodes: as mapped, of the chain alone, and with true closures instead of those kept."""
    chain, loops = map_.edges, map_.switchable_edges
    on = loops["switch"] >= ON

    def solved(kept: NDArray[np.bool_]) -> float:
        i, j = (np.concatenate([chain[end], loops[end][kept]]).astype(np.int64) for end in ("i", "j"))
        true = between(truth[i[len(chain["i"]) :]], truth[j[len(chain["i"]) :]])
        covariances = np.concatenate([chain["covariance"], loops["covariance"][kept]])
        measured = np.concatenate([chain["pose"], true])
        always = np.zeros(len(i), dtype=np.bool_)
        return _rmse(optimize_graph(map_.node_poses, i, j, measured, covariances, always, _ENOUGH)[0], truth)

    return {
        "nodes_rmse": _rmse(map_.node_poses, truth),
        "nodes_rmse_chain": solved(np.zeros_like(on)),
        "nodes_rmse_true_closures": solved(on),
    }


_ENOUGH = OptimizerOptions(max_iterations=100)


def _rmse(poses: Array, truth: Array) -> float:
    aligned = compose(alignment(poses, truth), poses)
    return float(np.sqrt(np.mean(np.sum((aligned - truth)[:, :2] ** 2, axis=1))))
