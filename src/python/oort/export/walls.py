# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Straight walls of a map: line segments of the scans, those of one wall joined.

Each scan is cut into straight runs by iterative end point fits, and runs are fitted by total least squares (Nguyen et
al. 2007 compare these). Segments of all scans that lie on one line, and overlap or touch, become one wall.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oort._core import Map
from oort.poses import compose

Array = NDArray[np.float64]

_APART = 0.04  # [m] a point may lie off the line of its run; a range error of three sigma at home
_GAP = 0.25  # [m] between neighbours of one run
_GAP_AT_RANGE = 0.06  # of the range: far away the beams are farther apart
_SHORTEST = 0.3  # [m] of a run, and of a wall
_FEWEST = 5  # points of a run
_ANGLE = np.radians(4.0)  # between segments of one wall
_OFFSET = 0.06  # [m] between segments of one wall: below the thickness of inner walls, so that both faces stay
_JOIN = 0.2  # [m] of a wall that no scan saw; narrower than any door
_COVER = 0.1  # [m] from a longer wall: what lies so near is a piece of it that was fitted badly
_VIEWS = 2  # scans that must have seen a wall


@dataclass(frozen=True)
class _Line:
    """A straight line n . p = offset, and its direction."""

    normal: Array
    offset: float

    @property
    def along(self) -> Array:
        return np.array([-self.normal[1], self.normal[0]])


def fit_walls(map_: Map) -> Array:
    """(k, 4) x0, y0, x1, y1 [m] in the map's frame, the longest first."""
    segments, views = [], []
    for k in range(len(map_)):
        found = scan_segments(map_.cloud(k))
        ends = compose(map_.node_poses[k], np.column_stack([found.reshape(-1, 2), np.zeros(2 * len(found))]))
        segments.append(ends[:, :2].reshape(-1, 4))
        views += [k] * len(found)
    return join_segments(np.concatenate([np.zeros((0, 4)), *segments]), np.array(views, dtype=np.int64))


def scan_segments(cloud: Array) -> Array:
    """(k, 4) straight runs of a scan, (m, 3) as Map.cloud() gives it, in its frame."""
    points = cloud[cloud[:, 2] == 1.0, :2]
    if len(points) < _FEWEST:
        return np.zeros((0, 4))
    breaks = np.flatnonzero(np.linalg.norm(np.diff(points, axis=0), axis=1) > _gaps(points)) + 1
    runs = [run for part in np.split(points, breaks) for run in _split(part)]
    fitted = [_fit(run) for run in runs if len(run) >= _FEWEST]
    return np.array([segment for segment in fitted if _length(segment) >= _SHORTEST]).reshape(-1, 4)


def join_segments(segments: Array, views: NDArray[np.int64]) -> Array:
    """(k, 4) walls from segments (n, 4) and the scan that each comes from."""
    lengths = np.linalg.norm(segments[:, 2:] - segments[:, :2], axis=1)
    angles = np.arctan2(segments[:, 3] - segments[:, 1], segments[:, 2] - segments[:, 0])
    left = np.ones(len(segments), dtype=np.bool_)
    walls: list[Array] = []
    for seed in np.argsort(-lengths, kind="stable"):
        if not left[seed]:
            continue
        line = _through(segments[seed])
        mates = left & _on_line(segments, angles, line, angles[seed])
        line = _mean_line(segments[mates], lengths[mates])
        mates = left & _on_line(segments, angles, line, float(np.arctan2(*line.along[::-1])))
        mates[seed] = True
        left &= ~mates
        walls += _pieces(segments[mates], views[mates], line)
    walls.sort(key=lambda wall: -_length(wall))
    kept: list[Array] = []
    for wall in walls:
        if not any(_covers(longer, wall) for longer in kept):
            kept.append(wall)
    return np.array(kept).reshape(-1, 4)


def _gaps(points: Array) -> Array:
    """[m] that may lie between neighbours."""
    gaps: Array = np.maximum(_GAP, _GAP_AT_RANGE * np.linalg.norm(points[1:], axis=1))
    return gaps


def _split(points: Array) -> list[Array]:
    """Parts of a run whose points lie on the line through the part's ends."""
    stack, parts = [points], []
    while stack:
        part = stack.pop()
        chord = part[-1] - part[0]
        norm = float(np.linalg.norm(chord))
        if len(part) < 3 or norm == 0.0:
            parts.append(part)
            continue
        off = np.abs(chord[0] * (part[:, 1] - part[0, 1]) - chord[1] * (part[:, 0] - part[0, 0])) / norm
        worst = int(off.argmax())
        if off[worst] <= _APART:
            parts.append(part)
        else:
            stack += [part[worst:], part[: worst + 1]]
    return parts


def _fit(points: Array) -> Array:
    """The segment through points by total least squares."""
    centre = points.mean(axis=0)
    along = np.linalg.svd(points - centre, full_matrices=False)[2][0]
    t = (points - centre) @ along
    return np.concatenate([centre + t.min() * along, centre + t.max() * along])


def _length(segment: Array) -> float:
    return float(np.hypot(segment[2] - segment[0], segment[3] - segment[1]))


def _through(segment: Array) -> _Line:
    along = (segment[2:] - segment[:2]) / max(_length(segment), 1e-9)
    normal = np.array([along[1], -along[0]])
    return _Line(normal, float(normal @ (segment[:2] + segment[2:]) / 2.0))


def _on_line(segments: Array, angles: Array, line: _Line, angle: float) -> NDArray[np.bool_]:
    turned = np.abs((angles - angle + np.pi / 2.0) % np.pi - np.pi / 2.0)
    off = np.abs(segments.reshape(-1, 2, 2) @ line.normal - line.offset).max(axis=1)
    near: NDArray[np.bool_] = (turned <= _ANGLE) & (off <= _OFFSET)
    return near


def _mean_line(segments: Array, weights: Array) -> _Line:
    """The line through the ends of segments by total least squares, long ones counting more."""
    points, w = segments.reshape(-1, 2), np.repeat(weights, 2)[:, None]
    centre = (w * points).sum(axis=0) / w.sum()
    along = np.linalg.svd(np.sqrt(w) * (points - centre), full_matrices=False)[2][0]
    normal = np.array([along[1], -along[0]])
    return _Line(normal, float(normal @ centre))


def _covers(longer: Array, wall: Array) -> bool:
    """Whether a wall is a less exact piece of a longer one."""
    line = _through(longer)
    ends = wall.reshape(2, 2)
    t, limits = ends @ line.along, np.sort(longer.reshape(2, 2) @ line.along)
    along_it = (t >= limits[0] - _COVER).all() and (t <= limits[1] + _COVER).all()
    return bool(along_it and (np.abs(ends @ line.normal - line.offset) <= _COVER).all())


def _pieces(segments: Array, views: NDArray[np.int64], line: _Line) -> list[Array]:
    """Where the segments cover the line."""
    t = np.sort((segments.reshape(-1, 2, 2) @ line.along), axis=1)
    order = np.argsort(t[:, 0], kind="stable")
    pieces: list[tuple[float, float, set[int]]] = []
    for k in order.tolist():
        low, high = float(t[k, 0]), float(t[k, 1])
        if pieces and low <= pieces[-1][1] + _JOIN:
            pieces[-1] = (pieces[-1][0], max(pieces[-1][1], high), pieces[-1][2] | {int(views[k])})
        else:
            pieces.append((low, high, {int(views[k])}))
    foot = line.offset * line.normal
    return [
        np.concatenate([foot + low * line.along, foot + high * line.along])
        for low, high, seen in pieces
        if high - low >= _SHORTEST and len(seen) >= _VIEWS
    ]
