# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Shapes painted onto the cells of a map."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from oort._core import OccupancyGrid


def paint(grid: OccupancyGrid, shapes: Sequence[tuple[Sequence[Sequence[float]], bool]]) -> NDArray[np.int32]:
    """(height, width), row 0 at the bottom: 0, or the number, from 1, of the last shape that takes the cell.

    Shapes are points [m] of the map's frame, and whether they are closed to a polygon; lines are a cell wide.
    """
    picture = Image.new("I", (grid.width, grid.height), 0)
    draw = ImageDraw.Draw(picture)
    origin = np.array(grid.origin)
    for number, (points, closed) in enumerate(shapes, start=1):
        at = [tuple(cell) for cell in ((np.array(points) - origin) / grid.resolution - 0.5).tolist()]
        if closed:
            draw.polygon(at, fill=number, outline=number)
        else:
            draw.line(at, fill=number)
    return np.array(picture, dtype=np.int32)
