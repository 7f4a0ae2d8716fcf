# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Solves pose graphs of any origin."""

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from oort._core import AGREEMENT_CHI2, SWITCH_ON, OptimizerOptions, OptimizerSummary, optimize_graph
from oort.errors import InputError
from oort.evaluation.trajectories import alignment
from oort.export import PoseGraph, read_g2o
from oort.inputs import read_rows
from oort.poses import between, compose, wrap_angle

METHODS = {
    "decide": "closures have switches; those that disagree with the solution at 95 % are then left out",
    "switch": "the optimum of the switches (Sünderhauf and Protzel 2012)",
    "plain": "least squares: all edges are believed",
}
_MAX_ITERATIONS = 200


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """A solved pose graph."""

    graph: PoseGraph
    """with the solved poses, and all edges"""
    believed: NDArray[np.bool_]
    """(m,) the edges that are not switched off"""
    closures: NDArray[np.bool_]
    """(m,) the edges that could be switched off"""
    switches: NDArray[np.float64]
    """(m,) in [0, 1]; 1 for the others"""
    chi_squared: NDArray[np.float64]
    """(m,) of each edge at the solved poses"""
    summary: OptimizerSummary


def solve_graph(graph: PoseGraph, method: str = "decide", scale: float = 2.0) -> Solution:
    """Solves a pose graph from its poses; the first node of each connected part keeps its own.

    Edges between nodes whose ids do not follow on one another are closures, which all of METHODS but "plain" can
    switch off; `scale` is the chi^2 at which one is half off. Raises InputError and ParameterError.
    """
    closures = find_closures(graph) & (method != "plain")
    options = OptimizerOptions(
        switchable_constraint_scale=scale, max_iterations=_MAX_ITERATIONS, decide=method == "decide"
    )
    i, j = _positions(graph).T
    poses, switches, summary = optimize_graph(
        graph.poses, i, j, graph.measurements, graph.covariances, closures, options
    )
    solved = replace(graph, poses=poses)
    chi2 = chi_squared(solved)
    agrees = chi2 <= AGREEMENT_CHI2 if method == "decide" else switches >= SWITCH_ON
    return Solution(solved, agrees | ~closures, closures, switches, chi2, summary)


def find_closures(graph: PoseGraph) -> NDArray[np.bool_]:
    """(m,) whether an edge links nodes that do not follow on one another in the order of their ids."""
    rank = np.searchsorted(np.sort(graph.ids), graph.edges)
    return np.asarray(np.abs(rank[:, 1] - rank[:, 0]) != 1)


def chi_squared(graph: PoseGraph) -> NDArray[np.float64]:
    """(m,) e^T C^-1 e of each edge, e being where node j is seen from node i less where it was measured."""
    i, j = _positions(graph).T
    return squared_errors(graph.poses[i], graph.poses[j], graph.measurements, graph.covariances)


def squared_errors(
    T_map_i: NDArray[np.float64],  # noqa: N803
    T_map_j: NDArray[np.float64],  # noqa: N803
    measured: NDArray[np.float64],
    covariances: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(m,) squared Mahalanobis distances of T_i_j from what was measured (m, 3), with its covariances (m, 3, 3)."""
    errors = between(T_map_i, T_map_j) - measured
    errors[:, 2] = wrap_angle(errors[:, 2])
    return np.asarray(np.einsum("ka,ka->k", errors, np.linalg.solve(covariances, errors[..., None])[..., 0]))


def position_rmse(poses: NDArray[np.float64], truth: NDArray[np.float64]) -> float:
    """Root mean square distance of positions (n, 3) after the best rigid motion [m]."""
    errors = compose(alignment(poses, truth), poses)[:, :2] - truth[:, :2]
    return float(np.sqrt(np.mean(np.sum(errors**2, axis=1))))


def read_truth(path: str | os.PathLike[str], graph: PoseGraph) -> NDArray[np.float64]:
    """(n, 3) the true poses of a graph's nodes: from a g2o file by their ids, else from a line `x y theta` for each.

    Raises InputError if the file is damaged or does not fit the graph.
    """
    path = Path(path)
    if path.suffix == ".g2o":
        truth = read_g2o(path)
        missing = np.setdiff1d(graph.ids, truth.ids)
        if len(missing):
            raise InputError(f"{path} has no vertex {missing[0]}; is it the truth of this graph?")
        return truth.poses[_find(truth.ids, graph.ids)]
    rows = [values for _, _, values in read_rows(path, "x y theta")]
    if len(rows) != len(graph.ids):
        raise InputError(f"{path} has {len(rows)} poses, but the graph has {len(graph.ids)} nodes; is it its truth?")
    return np.array(rows)


def _find(ids: NDArray[np.int64], wanted: NDArray[np.int64]) -> NDArray[np.int64]:
    """Where each of `wanted` is in `ids`, which has them all."""
    order = np.argsort(ids)
    return np.asarray(order[np.searchsorted(ids[order], wanted)], dtype=np.int64)


def _positions(graph: PoseGraph) -> NDArray[np.int64]:
    """(m, 2) where the nodes of each edge are in the arrays."""
    return _find(graph.ids, graph.edges)
