# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps in Valetudo's JSON format, version 2, for the map cards of home automation."""

import json
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import OccupancyGrid
from oort.areas import Area
from oort.export.files import write_atomically
from oort.export.named_rooms import NamedRoom
from oort.export.painting import paint
from oort.recording.types import Pose

_FREE, _WALL = 0, 100


def write_valetudo(
    path: Path,
    grid: OccupancyGrid,
    docks: Sequence[Pose],
    rooms: Sequence[NamedRoom] = (),
    areas: Sequence[Area] = (),
) -> None:
    """Writes floor, rooms as segments, walls, chargers, no-go areas and lines.

    Lengths are whole centimetres from the upper left corner, y down. An area of other than four corners becomes the
    rectangle around it, and a line several lines, for Valetudo has no others. Raises OortError if the file cannot be
    written.
    """
    cells = grid.cells[::-1]
    pixel = round(100.0 * grid.resolution)
    painted = paint(grid, [(named.room.outline.tolist(), True) for named in rooms])[::-1]
    parts: list[tuple[str, NDArray[np.bool_], dict[str, Any]]]
    parts = [("floor", (cells == _FREE) & (painted == 0), {})]
    for k, named in enumerate(rooms, start=1):
        data = {"segmentId": str(named.number), "name": named.name or f"Room {named.number}", "active": False}
        parts.append(("segment", (cells == _FREE) & (painted == k), data))
    parts.append(("wall", cells == _WALL, {}))
    layers = [layer for kind, mask, data in parts if (layer := _layer(kind, mask, pixel, data))]
    document = {
        "__class": "ValetudoMap",
        "metaData": {"version": 2, "totalLayerArea": sum(layer["metaData"]["area"] for layer in layers)},
        "size": {"x": grid.width * pixel, "y": grid.height * pixel},
        "pixelSize": pixel,
        "layers": layers,
        "entities": [_charger(grid, pose) for pose in docks] + [part for area in areas for part in _no_go(grid, area)],
    }
    write_atomically(path, (json.dumps(document) + "\n").encode())


def _layer(kind: str, mask: NDArray[np.bool_], pixel: int, data: dict[str, Any]) -> dict[str, Any] | None:
    if not mask.any():
        return None
    rows, columns = np.nonzero(mask)
    runs: list[int] = []
    for row in np.unique(rows).tolist():
        changes = np.flatnonzero(np.diff(mask[row], prepend=False, append=False))
        for begin, end in changes.reshape(-1, 2).tolist():
            runs += [begin, row, end - begin]
    return {
        "__class": "MapLayer",
        "metaData": {"area": int(mask.sum()) * pixel * pixel, **data},
        "type": kind,
        "pixels": [],
        "dimensions": {"x": _extent(columns), "y": _extent(rows), "pixelCount": int(mask.sum())},
        "compressedPixels": runs,
    }


def _extent(values: NDArray[np.int64]) -> dict[str, int]:
    low, high = int(values.min()), int(values.max())
    return {"min": low, "max": high, "mid": (low + high) // 2, "avg": round(float(values.mean()))}


def _centimetres(grid: OccupancyGrid, x: float, y: float) -> list[int]:
    return [
        round(100.0 * (x - grid.origin[0])),
        round(100.0 * (grid.height * grid.resolution - (y - grid.origin[1]))),
    ]


def _no_go(grid: OccupancyGrid, area: Area) -> list[dict[str, Any]]:
    if area.kind == "no_go_line":
        ends = [[*_centimetres(grid, *a), *_centimetres(grid, *b)] for a, b in pairwise(area.points)]
        return [{"__class": "LineMapEntity", "metaData": {}, "type": "virtual_wall", "points": end} for end in ends]
    corners = np.array(area.points)
    if len(corners) != 4:
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
        corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    points = [value for x, y in corners.tolist() for value in _centimetres(grid, x, y)]
    return [{"__class": "PolygonMapEntity", "metaData": {}, "type": "no_go_area", "points": points}]


def _charger(grid: OccupancyGrid, pose: Pose) -> dict[str, Any]:
    x, y = _centimetres(grid, pose[0], pose[1])
    angle = round(float(np.degrees(-pose[2]))) % 360
    return {"__class": "PointMapEntity", "metaData": {"angle": angle}, "type": "charger_location", "points": [x, y]}
