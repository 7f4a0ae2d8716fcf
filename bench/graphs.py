# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How false closures, and graphs of 10,000 nodes, become the optimiser: prints tables.

    .venv/bin/python bench/graphs.py [--counts 0 10 100 1000 5000] [--kinds random ...] [--seeds 10] [--scale 2 4]
        [--gtsam PYTHON [--methods plain gnc dcs] [--gtsam-seeds 1] [--limit 120]] [--closing]

Manhattan 3500 (with its truth) is found through OORT_DATASETS. PYTHON is one that has GTSAM
(`python3 -m venv DIR; DIR/bin/pip install gtsam`). --closing prints what closing a loop costs in long drives.
"""

import argparse
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from closing import measure_closing
from false_closures import (
    KINDS,
    Floats,
    SpoiltGraph,
    add_false_closures,
    count_agreeing_groups,
    is_closure,
    relative,
    squared_distance,
)
from oort import _core
from oort._core import SWITCH_ON
from oort.evaluation.graph import position_rmse
from oort.export.g2o import PoseGraph, read_g2o
from trials.datasets import datasets

ROOT = Path(__file__).resolve().parents[1]

BENT = 0.8
"""A map of Manhattan is bent if its error is above this [m]; without false closures it is 0.797 m."""


class Outcome(NamedTuple):
    """How one solver did on one graph."""

    rmse: float
    """[m]; infinite if it was stopped"""
    seconds: float
    kept: int = -1
    """False closures that the solution agrees with; -1: not known"""
    gain: float = 0.0
    """By how much it costs less than what the graph without false closures gives"""


def robust_cost(graph: PoseGraph, poses: Floats, scale: float) -> float:
    """What the optimiser minimises, at these poses and the best switches."""
    i, j = graph.edges.T
    information = np.linalg.inv(graph.covariances).astype(np.float64)
    chi2 = squared_distance(relative(poses[i], poses[j]), graph.measurements, information)
    return 0.5 * float(np.where(is_closure(graph), scale * chi2 / (scale + chi2), chi2).sum())


def optimise(graph: PoseGraph, scale: float) -> tuple[Floats, Floats]:
    """(n, 3) poses and (m,) switches."""
    i, j = graph.edges.T
    options = _core.OptimizerOptions(switchable_constraint_scale=scale)
    poses, switches, _ = _core.optimize_graph(
        graph.poses, i, j, graph.measurements, graph.covariances, is_closure(graph), options
    )
    return poses, switches


def solve_with_oort(spoilt: SpoiltGraph, truth: Floats, clean: Floats, scale: float) -> Outcome:
    start = time.process_time()
    poses, switches = optimise(spoilt.graph, scale)
    seconds = time.process_time() - start
    return Outcome(
        position_rmse(poses, truth),
        seconds,
        int((switches[spoilt.false] >= SWITCH_ON).sum()),
        robust_cost(spoilt.graph, clean, scale) - robust_cost(spoilt.graph, poses, scale),
    )


def solve_with_gtsam(spoilt: SpoiltGraph, truth: Floats, python: str, method: str, limit: float) -> Outcome:
    graph = spoilt.graph
    with tempfile.TemporaryDirectory() as scratch:
        source, target = Path(scratch) / "graph.npz", Path(scratch) / "result.npz"
        np.savez(
            source,
            poses=graph.poses,
            edges=graph.edges,
            measurements=graph.measurements,
            covariances=graph.covariances,
            switchable=is_closure(graph),
        )
        worker = Path(__file__).with_name("solve_with_gtsam.py")
        try:
            subprocess.run([python, str(worker), method, str(source), str(target)], check=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return Outcome(float("inf"), limit)
        result = np.load(target)
        return Outcome(position_rmse(result["poses"], truth), float(result["seconds"]))


def row(name: str, count: int, kind: str, outcomes: list[Outcome], groups: str = "") -> str:
    errors = [outcome.rmse for outcome in outcomes]
    seconds = [outcome.seconds for outcome in outcomes]
    kept = sum(outcome.kept for outcome in outcomes)
    return (
        f"| {count} | {kind} | {name} | {len(outcomes)} | {statistics.median(errors):.4f} / {max(errors):.4f} | "
        f"{statistics.median(seconds):.2f} / {max(seconds):.2f} | {'' if kept < 0 else kept} | "
        f"{sum(outcome.rmse > BENT for outcome in outcomes)} | "
        f"{sum(outcome.rmse > BENT and outcome.gain > 0 for outcome in outcomes)} | {groups} |"
    )


def measure_manhattan(args: argparse.Namespace) -> Iterator[str]:
    folder = datasets() / "posegraphs"
    manhattan = read_g2o(folder / "manhattanOlson3500.g2o")
    truth = np.loadtxt(folder / "manhattan_nodes_groundTruth.dat")
    clean = {scale: optimise(manhattan, scale)[0] for scale in args.scale}
    yield (
        "| false | kind | solver | graphs | RMSE, m, median / worst | CPU s, median / worst | kept | bent | cheaper |"
        " groups agree |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for count in args.counts:
        for kind in args.kinds if count else ["none"]:
            seeds = range(args.seeds if count else 1)
            graphs = [add_false_closures(manhattan, truth, kind if count else KINDS[0], count, seed) for seed in seeds]
            groups = sum(count_agreeing_groups(graph, truth) for graph in graphs)
            text = f"{groups} of {sum(graph.group.max() + 1 for graph in graphs)}" if "grouped" in kind else ""
            for scale in args.scale:
                outcomes = [solve_with_oort(graph, truth, clean[scale], scale) for graph in graphs]
                yield row(f"Oort, scale {scale:g}", count, kind, outcomes, text)
            for method in args.methods if args.gtsam else []:
                few = graphs[: args.gtsam_seeds]
                outcomes = [solve_with_gtsam(graph, truth, args.gtsam, method, args.limit) for graph in few]
                yield row(f"GTSAM {method}", count, kind, outcomes)


def measure_clean(graph: PoseGraph, name: str, scales: list[float]) -> Iterator[str]:
    """How far the optimiser moves a clean graph from where plain least squares has it."""
    i, j = graph.edges.T
    never = np.zeros(len(i), dtype=bool)
    plain, _, _ = _core.optimize_graph(graph.poses, i, j, graph.measurements, graph.covariances, never)
    for scale in scales:
        poses, switches = optimise(graph, scale)
        off = int((switches < SWITCH_ON).sum())
        yield f"| {name} | {scale:g} | {position_rmse(poses, plain):.5f} | {off} of {is_closure(graph).sum()} |"


def describe_run() -> str:
    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()

    changed = " with changes" if git("status", "--porcelain") else ""
    return f"commit {git('rev-parse', '--short', 'HEAD')}{changed}, {platform.machine()}, load {os.getloadavg()[0]:.1f}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--counts", type=int, nargs="+", default=[0, 10, 100, 1000, 5000])
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--scale", type=float, nargs="+", default=[2.0, 4.0], help="switchable_constraint_scale")
    parser.add_argument("--gtsam", metavar="PYTHON")
    parser.add_argument("--methods", nargs="+", choices=("plain", "gnc", "dcs"), default=["plain", "gnc", "dcs"])
    parser.add_argument("--gtsam-seeds", type=int, default=1)
    parser.add_argument("--limit", type=float, default=120.0, help="seconds for one run of GTSAM")
    parser.add_argument("--closing", action="store_true", help="only what closing a loop costs")
    args = parser.parse_args()
    print(describe_run())
    if args.closing:
        for line in measure_closing():
            print(line, flush=True)
        return 0
    print("| graph | scale | RMSE to plain least squares, m | closures off |\n|---|---|---|---|")
    for name in ("manhattanOlson3500", "intel"):
        for line in measure_clean(read_g2o(datasets() / "posegraphs" / f"{name}.g2o"), name, args.scale):
            print(line, flush=True)
    print()
    for line in measure_manhattan(args):
        print(line, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
