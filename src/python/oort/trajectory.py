# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where every scan of a drive was, at the map's final solution."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from oort._core import ScanResult
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
        self._made_node.append(result is not None and result.outcome == "node")

    def base_poses(self, node_poses: NDArray[np.float64]) -> NDArray[np.float64]:
        """T_map_base of every scan, (n, 3), in their order, given T_map_sensor of every node, (m, 3).

        A scan between two nodes of a chain is carried by both: what the solution moved the next node by, relative to
        where the scan matcher saw it, is given to the scans in proportion to their place between the two. Scans that no
        node carries follow odometry from the scan before (the first ones: back from the first scan that has a node).
        """
        nodes = np.array(self._nodes, dtype=np.int64)
        if len(node_poses) == 0 or not (nodes != _NO_NODE).any():
            return np.array(self._odometry, dtype=np.float64).reshape(-1, 3)
        sensor = compose(node_poses[np.maximum(nodes, 0)], np.array(self._relative).reshape(-1, 3))
        sensor = self._spread(sensor, nodes, node_poses)
        base = compose(sensor, between(self._sensor_on_base, np.zeros(3)))
        return self._carry(base, nodes)

    def _spread(
        self, sensor: NDArray[np.float64], nodes: NDArray[np.int64], node_poses: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        made = np.flatnonzero(self._made_node)
        out = sensor.copy()
        for before, after in zip(made[:-1], made[1:], strict=True):
            last = after - 1  # the last scan that is carried by the node before
            if nodes[after] != nodes[before] + 1 or (nodes[before : after] != nodes[before]).any():
                continue
            step = compose(sensor[last], self._motion(last, after))
            correction = between(step, node_poses[nodes[after]])
            fraction = np.arange(1, after - before)[:, None] / (after - before)
            out[before + 1 : after] = compose(sensor[before + 1 : after], correction * fraction)
        return out

    def _motion(self, a: int, b: int) -> NDArray[np.float64]:
        """The sensor's motion between two scans by odometry."""
        odometry = compose(np.array([self._odometry[a], self._odometry[b]]), self._sensor_on_base)
        return between(odometry[0], odometry[1])

    def _carry(self, base: NDArray[np.float64], nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        odometry = np.array(self._odometry)
        anchor = int(np.flatnonzero(nodes != _NO_NODE)[0])
        for i in range(len(nodes)):
            if nodes[i] != _NO_NODE:
                anchor = i
            else:
                base[i] = compose(base[anchor], between(odometry[anchor], odometry[i]))
        return base
