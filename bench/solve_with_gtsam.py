# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Solves a pose graph with GTSAM, in whatever Python has it: reads and writes .npz files; needs nothing of Oort.

python solve_with_gtsam.py plain|gnc|dcs graph.npz result.npz
"""

import sys
import time
from typing import Any

import gtsam  # type: ignore[import-not-found]
import numpy as np

ANCHOR_SIGMA = 1e-6


def rotated(covariance: Any, theta: float) -> Any:
    """From the axes of node i to those of the measured node j, along which GTSAM's error is."""
    c, s = np.cos(theta), np.sin(theta)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return turn @ covariance @ turn.T


def build(data: Any, method: str) -> tuple[Any, Any, list[int]]:
    graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    for k, pose in enumerate(data["poses"]):
        values.insert(k, gtsam.Pose2(*pose))
    graph.add(
        gtsam.PriorFactorPose2(0, gtsam.Pose2(*data["poses"][0]), gtsam.noiseModel.Isotropic.Sigma(3, ANCHOR_SIGMA))
    )
    known = [0]
    for (i, j), measured, covariance, closure in zip(
        data["edges"], data["measurements"], data["covariances"], data["switchable"], strict=True
    ):
        noise = gtsam.noiseModel.Gaussian.Covariance(rotated(covariance, measured[2]))
        if closure and method == "dcs":
            noise = gtsam.noiseModel.Robust.Create(gtsam.noiseModel.mEstimator.DCS.Create(1.0), noise)
        if not closure:
            known.append(graph.size())
        graph.add(gtsam.BetweenFactorPose2(int(i), int(j), gtsam.Pose2(*measured), noise))
    return graph, values, known


def solve(graph: Any, values: Any, known: list[int], method: str) -> Any:
    if method != "gnc":
        return gtsam.LevenbergMarquardtOptimizer(graph, values).optimize()
    parameters = gtsam.GncLMParams()
    parameters.setLossType(gtsam.GncLossType.TLS)
    parameters.setKnownInliers(known)
    return gtsam.GncLMOptimizer(graph, values, parameters).optimize()


def main() -> None:
    method, source, target = sys.argv[1:]
    data = np.load(source)
    graph, values, known = build(data, method)
    start = time.process_time()
    result = solve(graph, values, known, method)
    seconds = time.process_time() - start
    poses = [result.atPose2(k) for k in range(len(data["poses"]))]
    np.savez(target, poses=np.array([[p.x(), p.y(), p.theta()] for p in poses]), seconds=seconds)


if __name__ == "__main__":
    main()
