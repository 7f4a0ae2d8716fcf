# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where every scan of a drive was, at the map's final solution."""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from oort._core import Map, ScanOutcome, ScanResult
from oort.poses import between, compose
from oort.recording import Pose

_NO_NODE = -1


class TrajectoryRecorder:
    """Remembers each scan relative to its node, so that its pose follows when the nodes move."""

    def __init__(self, sensor_on_base: Pose) -> None:
        """``sensor_on_base`` is T_base_sensor."""
        self._sensor_on_base = np.array(sensor_on_base)
        self._stamps: list[str] = []
        self._nodes: list[int] = []
        self._relative: list[Pose] = []
        self._odometry: list[Pose] = []
        self._made_node: list[bool] = []

    @property
    def stamps(self) -> Sequence[str]:
        """The stamp of each scan, as the recording writes it."""
        return self._stamps

    def add(self, stamp: str, odometry: Pose, result: ScanResult | None) -> None:
        """Adds the next scan with T_odom_base and what the mapper made of it (None: it was not mapping)."""
        known = result is not None and result.node_id is not None
        self._stamps.append(stamp)
        self._odometry.append(odometry)
        self._nodes.append(result.node_id if result is not None and result.node_id is not None else _NO_NODE)
        self._relative.append(result.T_node_sensor if result is not None and known else (0.0, 0.0, 0.0))
        self._made_node.append(result is not None and result.outcome == ScanOutcome.NODE)

    def forget_nodes(self) -> None:
        """The map was dropped or replaced: scans so far are placed by odometry from what comes."""
        self._nodes = [_NO_NODE] * len(self._nodes)
        self._made_node = [False] * len(self._made_node)

    def follow(self, renumbering: tuple[NDArray[np.int64], NDArray[np.float64]] | None) -> None:
        """Takes what Mapper.take_renumbering tells after a call: which nodes carry the scans now, and where."""
        if renumbering is None:
            return
        carriers, T_carrier_node = renumbering
        nodes = np.array(self._nodes, dtype=np.int64)
        known = nodes != _NO_NODE
        relative = np.array(self._relative, dtype=np.float64).reshape(-1, 3)
        relative[known] = compose(T_carrier_node[nodes[known]], relative[known])
        nodes[known] = carriers[nodes[known]]
        self._nodes, self._relative = nodes.tolist(), [(x, y, theta) for x, y, theta in relative.tolist()]

    def carriers(self) -> NDArray[np.int64]:
        """(n,) the node that carries each scan, or the one of the scan next to it that has one; -1 if none has."""
        nodes = np.array(self._nodes, dtype=np.int64)
        known = np.flatnonzero(nodes != _NO_NODE)
        if not len(known):
            return nodes
        latest = np.maximum.accumulate(np.where(nodes != _NO_NODE, np.arange(len(nodes)), known[0]))
        return nodes[latest]

    def base_poses(self, map_: Map, first_node: int = 0) -> NDArray[np.float64]:
        """T_map_base of every scan, (n, 3), in their order, at the map's solution.

        ``first_node`` is the id that the drive's first node has there, if its map was merged into another.

        A scan between two nodes of a segment moves with both: how far the solution moved the next node from where the
        scan matcher had seen it is given to the scans in proportion to their place between the two. Scans that no node
        carries follow odometry from the scan before (the first ones: back from the first scan that has a node).
        """
        nodes = np.array(self._nodes, dtype=np.int64)
        if len(map_) == 0 or not (nodes != _NO_NODE).any():
            return np.array(self._odometry, dtype=np.float64).reshape(-1, 3)
        carrier = np.maximum(nodes, 0) + first_node
        correction = _corrections(map_)[carrier] * self._progress(nodes)[:, None]
        relative = compose(np.array(self._relative).reshape(-1, 3), correction)
        base = compose(compose(map_.node_poses[carrier], relative), between(self._sensor_on_base, np.zeros(3)))
        return self._carry(base, nodes)

    def _progress(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """How far each scan is on the way from the scan of its node to that of the next, in [0, 1]."""
        progress = np.zeros(len(nodes))
        first = np.flatnonzero((np.diff(nodes, prepend=_NO_NODE) != 0) & (nodes != _NO_NODE))  # moves with each node
        # A node that a call made is the scan before the first that it carries.
        made = first - ~np.array(self._made_node, dtype=np.bool_)[first]
        for (before, begin), (after, end) in itertools.pairwise(zip(made, first, strict=True)):
            if after > before:  # not where scans went over from nodes that are gone
                progress[begin:end] = (np.arange(begin, end) - before) / (after - before)
        return progress

    def _carry(self, base: NDArray[np.float64], nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        odometry = np.array(self._odometry)
        anchor = int(np.flatnonzero(nodes != _NO_NODE)[0])
        for i in range(len(nodes)):
            if nodes[i] != _NO_NODE:
                anchor = i
            else:
                base[i] = compose(base[anchor], between(odometry[anchor], odometry[i]))
        return base


def _corrections(map_: Map) -> NDArray[np.float64]:
    """(m, 3): by how much the solution moved the node after each node from where the scan matcher saw it."""
    poses, results = map_.node_poses, map_.incremental_results
    corrections = np.zeros_like(poses)
    linked = results["target"] + 1 == results["id"]
    target, id = results["target"][linked], results["id"][linked]
    corrections[target] = between(compose(poses[target], results["pose"][linked]), poses[id])
    return corrections
