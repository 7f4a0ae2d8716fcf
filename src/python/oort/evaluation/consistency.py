# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Does a map agree with itself? What two scans of one place see, laid over each other as the solution says.

No truth is needed: where scans from early and late in a drive do not agree, walls are doubled or the map is bent.
"""

from dataclasses import dataclass

import numpy as np

from oort._core import SWITCH_ON, Map
from oort.poses import Array, between, compose

_FAR_APART = 5.0
"""[m] of driving between two scans of a pair: beyond what the local map of either holds"""
_NEAR = 1.5
"""[m] between the two sensors: from there they see the same walls"""
_STEP = (0.5, 2.0)
"""[m] of driving between the scans of the pairs to compare with, which local SLAM laid over each other"""
_TOLERANCE = 0.1
"""[m] between returns of the same wall; twice the side of a cell, and far above the noise of a laser"""
_REACH = 8.0
"""[m] up to which returns are compared: farther away a degree of heading alone moves them by more than that"""
_FEWEST = 20
"""returns of one scan that the other could see, for a pair to count"""
_BENT = 0.6
"""agreement below which a pair contradicts: a person or a door changes less of what a scan sees"""
_MOST_PAIRS = 1500
_TIED = 1.0
"""[m], standard deviation of an edge's position above which it ties nothing"""


@dataclass(frozen=True, slots=True)
class Consistency:
    """How far a map agrees with itself."""

    pairs: int
    """of scans that overlap and are far apart"""
    agreement: float
    """median share of the returns that agree, of those pairs; NaN if there are none"""
    agreement_near: float
    """the same of scans taken right after each other: what the place and the sensor allow"""
    contradicting: float
    """share of the pairs that contradict; NaN if there are none"""
    untied_nodes: int
    """nodes that no certain edge ties to the largest part of the map"""


def consistency(map_: Map, poses: Array | None = None) -> Consistency:
    """Of a map as solved, or with its nodes at other poses (n, 3)."""
    poses = map_.node_poses if poses is None else poses
    travelled = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))])
    views = [_View(cloud) for cloud in map_.clouds]
    far = _agreements(views, poses, _pairs(poses, travelled, (_FAR_APART, np.inf)))
    near = _agreements(views, poses, _pairs(poses, travelled, _STEP))
    return Consistency(
        pairs=len(far),
        agreement=float(np.median(far)) if len(far) else np.nan,
        agreement_near=float(np.median(near)) if len(near) else np.nan,
        contradicting=float((far < _BENT).mean()) if len(far) else np.nan,
        untied_nodes=_untied(map_),
    )


class _View:
    """What one scan saw."""

    def __init__(self, cloud: Array) -> None:
        """Takes a cloud as Map.cloud gives it."""
        points = cloud[np.isfinite(cloud[:, 2]), :2]
        bearings = np.arctan2(points[:, 1], points[:, 0])
        order = np.argsort(bearings, kind="stable")
        self.points = points[order]
        self.bearings = bearings[order]
        self.ranges = np.hypot(*self.points.T)
        steps = np.diff(self.bearings)
        self.step = float(np.median(steps)) if len(steps) else np.pi

    def agreement(self, T_self_other: Array, other: "_View") -> tuple[int, int]:  # noqa: N803
        """How many returns of the other scan lie on returns of this one, and how many of them this one could see."""
        seen = compose(T_self_other, np.column_stack([other.points, np.zeros(len(other.points))]))[:, :2]
        ranges, bearings = np.hypot(*seen.T), np.arctan2(seen[:, 1], seen[:, 0])
        if len(self.points) < 2:
            return 0, 0
        after = np.clip(np.searchsorted(self.bearings, bearings), 1, len(self.bearings) - 1)
        closer = bearings - self.bearings[after - 1] < self.bearings[after] - bearings
        beam = np.where(closer, after - 1, after)
        in_view = np.abs(self.bearings[beam] - bearings) < 1.5 * self.step
        # What lies behind a return of this scan is hidden from it: another side of the wall, or another room.
        visible = in_view & (ranges < _REACH) & (self.ranges[beam] > ranges - _TOLERANCE)
        points = seen[visible]
        if not len(points):
            return 0, 0
        nearest = np.sqrt(((points[:, None, :] - self.points[None, :, :]) ** 2).sum(axis=2).min(axis=1))
        return int((nearest < np.maximum(_TOLERANCE, ranges[visible] * self.step)).sum()), len(points)


def _pairs(poses: Array, travelled: Array, apart: tuple[float, float]) -> list[tuple[int, int]]:
    """For each node up to three earlier ones nearby, spread over the drive; thinned evenly if they are too many."""
    pairs = []
    for i in range(len(poses)):
        driven = travelled[i] - travelled[:i]
        near = np.hypot(*(poses[:i, :2] - poses[i, :2]).T) < _NEAR
        others = np.flatnonzero(near & (driven >= apart[0]) & (driven <= apart[1]))
        if len(others):
            chosen = np.unique(others[np.linspace(0, len(others) - 1, 3).round().astype(np.int64)])
            pairs += [(i, int(j)) for j in chosen]
    return pairs[:: -(-len(pairs) // _MOST_PAIRS)] if pairs else []


def _agreements(views: list[_View], poses: Array, pairs: list[tuple[int, int]]) -> Array:
    """Share of the returns that agree, of each pair with enough overlap."""
    shares = []
    for i, j in pairs:
        one = views[i].agreement(between(poses[i], poses[j]), views[j])
        two = views[j].agreement(between(poses[j], poses[i]), views[i])
        agree, seen = one[0] + two[0], one[1] + two[1]
        if seen >= _FEWEST:
            shares.append(agree / seen)
    return np.array(shares)


def _untied(map_: Map) -> int:
    """Counts the nodes outside the largest part that certain edges and closures that are on hold together."""
    edges, closures = map_.edges, map_.switchable_edges
    certain = np.hypot(*np.sqrt(np.diagonal(edges["covariance"], axis1=1, axis2=2)[:, :2]).T) < _TIED
    on = closures["switch"] >= SWITCH_ON
    part = list(range(len(map_)))

    def root(node: int) -> int:
        while part[node] != node:
            part[node] = part[part[node]]
            node = part[node]
        return node

    for kind, kept in ((edges, certain), (closures, on)):
        for i, j in zip(kind["i"][kept].tolist(), kind["j"][kept].tolist(), strict=True):
            part[root(i)] = root(j)
    sizes = np.bincount([root(node) for node in range(len(map_))])
    return len(map_) - int(sizes.max())
