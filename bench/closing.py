# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What closing a loop costs in a long drive, on made-up graphs that are solved when the mapper would solve them."""

import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from false_closures import Floats, compose, is_closure, relative, squared_distance
from oort import _core
from oort.export.g2o import PoseGraph

STEP = 0.25
"""Between nodes [m]."""
ODOMETRY_SIGMA = np.array([0.005, 0.005, 0.005])
CLOSURE_SIGMA = np.array([0.02, 0.02, 0.01])
REACH = 0.4
"""A closure's ends are at most this far apart [m],"""
PAUSE = 60
"""and at least this many nodes."""
EVERY = 8
"""So many nodes, one is matched: with the nearest node of each earlier pass in reach."""

SURPRISE = 11.345
"""A closure this far from what is expected is solved at once, as the mapper does; else solving waits until the"""
GROWTH = 20
"""th part of the graph is new."""
WINDOW = 1000
"""With a window, a surprise is solved by moving so many of the newest nodes."""
AGREEMENT = 7.815
"""If most of the new closures disagree even then, the whole graph is solved."""


def drive(nodes: int, side: float, random: np.random.Generator) -> Floats:
    """True poses (nodes, 3) of a drive from one random place of a square room to the next, along its axes."""
    poses = [np.zeros(3)]
    while len(poses) < nodes:
        goal = random.uniform(0.0, side, size=2)
        for axis in random.permutation(2):
            way = goal[axis] - poses[-1][axis]
            heading = np.arctan2(way * (axis == 1), way * (axis == 0))
            start = poses[-1][:2]
            for distance in np.arange(STEP, abs(way), STEP):
                x, y = start + distance * np.array([np.cos(heading), np.sin(heading)])
                poses.append(np.array([x, y, heading]))
    return np.array(poses[:nodes])


def earlier_passes(truth: Floats, j: int) -> list[int]:
    """The node nearest to node j of each earlier pass of its place."""
    distance = np.hypot(*(truth[: max(0, j - PAUSE), :2] - truth[j, :2]).T)
    near = np.flatnonzero(distance < REACH)
    runs = np.split(near, np.flatnonzero(np.diff(near) > 1) + 1) if len(near) else []
    return [int(run[np.argmin(distance[run])]) for run in runs]


def long_drive(nodes: int, side: float, seed: int) -> tuple[PoseGraph, Floats]:
    """A drive's graph, its edges in the order in which they come, and its true poses."""
    random = np.random.Generator(np.random.PCG64(seed))
    truth = drive(nodes, side, random)
    pairs = [(j - 1, j) for j in range(1, nodes)]
    for j in range(0, nodes, EVERY):
        pairs += [(i, j) for i in earlier_passes(truth, j)]
    edges = np.array(sorted(pairs, key=lambda pair: (pair[1], -pair[0])))
    sigma = np.where((edges[:, 1] == edges[:, 0] + 1)[:, None], ODOMETRY_SIGMA, CLOSURE_SIGMA)
    measured = relative(truth[edges[:, 0]], truth[edges[:, 1]]) + sigma * random.standard_normal((len(edges), 3))
    covariances = sigma[:, :, None] ** 2 * np.eye(3)
    return PoseGraph(np.arange(nodes), truth.copy(), edges, measured, covariances), truth


class Solving:
    """A graph that grows: what each solve costs. Without a window each is of the whole graph, as in the mapper."""

    def __init__(self, graph: PoseGraph, begin: int, window: bool) -> None:
        self.graph = graph
        self.window = window
        self.closure = is_closure(graph)
        self.poses = graph.poses.copy()
        self.switches = np.ones(len(graph.edges))
        self.begin = self.solved = begin
        self.seconds: dict[str, list[float]] = {"whole": [], "newest": []}
        self._solve(begin, "whole", 0)
        self.seconds["whole"].clear()

    def run(self) -> None:
        """Adds the nodes from `begin` on."""
        last = np.searchsorted(self.graph.edges[:, 1], np.arange(len(self.poses)), side="right")
        for node in range(self.begin, len(self.poses)):
            new = slice(int(last[node - 1]), int(last[node]))
            step = np.flatnonzero(~self.closure[new])[0] + new.start
            self.poses[node] = compose(self.poses[node - 1 : node], self.graph.measurements[step : step + 1])[0]
            if not self.closure[new].any():
                continue
            surprised = self._disagreement(new).max() > SURPRISE
            if surprised and self.window:
                self._solve(node + 1, "newest", node + 1 - WINDOW)
                surprised = bool(np.median(self._disagreement(new)) > AGREEMENT)
            if surprised or node + 1 > self.solved * (1 + 1 / GROWTH):
                self._solve(node + 1, "whole", 0)

    def _disagreement(self, edges: slice) -> Floats:
        """Squared Mahalanobis distances of the closures among these edges."""
        i, j = self.graph.edges[edges].T
        error = squared_distance(
            relative(self.poses[i], self.poses[j]), self.graph.measurements[edges], np.diag(CLOSURE_SIGMA**-2.0)
        )
        return error[self.closure[edges]]

    def _solve(self, nodes: int, kind: str, first_free_node: int) -> None:
        count = int(np.searchsorted(self.graph.edges[:, 1], nodes))
        i, j = self.graph.edges[:count].T
        options = _core.OptimizerOptions(
            switchable_constraint_scale=4.0, max_iterations=15, first_free_node=first_free_node
        )
        start = time.process_time()
        self.poses[:nodes], self.switches[:count], _ = _core.optimize_graph(
            self.poses[:nodes],
            i,
            j,
            self.graph.measurements[:count],
            self.graph.covariances[:count],
            self.closure[:count],
            options,
            self.switches[:count],
        )
        self.seconds[kind].append(time.process_time() - start)
        if kind == "whole":
            self.solved = nodes


def measure_closing(nodes: int = 10000, begin: int = 9900) -> Iterator[str]:
    """The rows of a table: for rooms of several sizes, what the solves of the last nodes cost."""
    yield "| room, m | closures | surprises are solved by moving | solve of | number | CPU ms, median / worst |"
    yield "|---|---|---|---|---|---|"
    for side in (12.0, 40.0, 100.0):
        graph, _ = long_drive(nodes, side, seed=1)
        for window in (False, True):
            solving = Solving(graph, begin, window)
            solving.run()
            moved = f"the newest {WINDOW} nodes" if window else "all nodes"
            for kind, seconds in solving.seconds.items():
                if not seconds:
                    continue
                times: NDArray[np.float64] = 1e3 * np.array(seconds)
                yield (
                    f"| {side:g} x {side:g} | {int(solving.closure.sum())} | {moved} | {kind} | {len(seconds)} | "
                    f"{np.median(times):.0f} / {times.max():.0f} |"
                )
