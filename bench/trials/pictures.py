# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A picture of a mapped drive against the truth."""

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from oort import render_map
from oort.evaluation.trajectories import alignment
from oort.poses import Array, compose
from oort.simulate import Drive
from oort.simulate.planar import transform
from trials.closures import ON, false_closures
from trials.replays import Replayed
from trials.truth import true_nodes

SCALE, MARGIN = 60.0, 0.5  # pixels per metre, m
WALL, WAY, TRUE_WAY = (120, 190, 120), (30, 80, 220), (240, 160, 40)
FALSE_KEPT, FALSE_OFF, TRUE_OFF = (230, 0, 0), (200, 160, 160), (150, 60, 200)


def draw(path: Path, drive: Drive, replayed: Replayed) -> None:
    """Write a PNG in the truth's frame, to which the map is aligned.

    Black: the map's occupied cells. Green: true walls and furniture. Orange and blue: the true way and the mapped.
    Red: false closures that were kept. Pale: false ones switched off. Violet: true ones switched off.
    """
    map_ = replayed.drive.session.map
    T_truth_map = alignment(replayed.T_map_base, drive.T_map_base)
    grid = render_map(map_, replayed.drive.parameters)[0]
    rows, columns = np.nonzero(grid.cells == 100)
    occupied = np.array(grid.origin[:2]) + grid.resolution * (np.column_stack([columns, rows]) + 0.5)
    way = compose(T_truth_map, replayed.T_map_base)[:, :2]
    canvas = _Canvas(np.vstack([drive.T_map_base[:, :2], drive.home.segments.reshape(-1, 2), way]))
    for segment in drive.home.segments:
        canvas.line(segment.reshape(2, 2), WALL, 2)
    for x, y, radius in drive.home.discs:
        canvas.dot(np.array([x, y]), WALL, radius)
    for point in transform(T_truth_map, occupied):
        canvas.dot(point, (0, 0, 0), 0.5 * grid.resolution)
    canvas.line(drive.T_map_base[:, :2], TRUE_WAY, 2)
    canvas.line(way, WAY, 2)
    edges, places = map_.switchable_edges, transform(T_truth_map, map_.node_poses[:, :2])
    false, on = false_closures(map_, true_nodes(map_, drive)[0]), edges["switch"] >= ON
    for chosen, colour in ((false & ~on, FALSE_OFF), (~false & ~on, TRUE_OFF), (false & on, FALSE_KEPT)):
        for i, j in zip(edges["i"][chosen].tolist(), edges["j"][chosen].tolist(), strict=True):
            canvas.line(places[[i, j]], colour, 3)
    canvas.image.save(path, format="PNG")


class _Canvas:
    """Draws points given in metres."""

    def __init__(self, points: Array) -> None:
        low, high = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
        self._left, self._top = float(low[0]), float(high[1])
        size = np.ceil((high - low) * SCALE).astype(int)
        self.image = Image.new("RGB", (int(size[0]), int(size[1])), "white")
        self._draw = ImageDraw.Draw(self.image)

    def line(self, points: Array, colour: tuple[int, int, int], width: int) -> None:
        self._draw.line(
            [((x - self._left) * SCALE, (self._top - y) * SCALE) for x, y in points.tolist()], fill=colour, width=width
        )

    def dot(self, point: Array, colour: tuple[int, int, int], radius: float) -> None:
        x, y = (point[0] - self._left) * SCALE, (self._top - point[1]) * SCALE
        half = max(radius * SCALE, 1.0)
        self._draw.ellipse((x - half, y - half, x + half, y + half), fill=colour)
