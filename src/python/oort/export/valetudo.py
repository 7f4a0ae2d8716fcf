# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps in Valetudo's JSON format, version 2, for the map cards of home automation."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import OccupancyGrid
from oort.export.files import write_atomically
from oort.recording.types import Pose

_LAYERS = (("floor", 0), ("wall", 100))


def write_valetudo(path: Path, grid: OccupancyGrid, docks: Sequence[Pose]) -> None:
    """Writes floor, walls and the chargers. Lengths are whole centimetres from the upper left corner, y down.

    Raises OortError if the file cannot be written.
    """
    cells = grid.cells[::-1]
    pixel = round(100.0 * grid.resolution)
    layers = [layer for kind, value in _LAYERS if (layer := _layer(kind, cells == value, pixel))]
    document = {
        "__class": "ValetudoMap",
        "metaData": {"version": 2, "totalLayerArea": sum(layer["metaData"]["area"] for layer in layers)},
        "size": {"x": grid.width * pixel, "y": grid.height * pixel},
        "pixelSize": pixel,
        "layers": layers,
        "entities": [_charger(grid, pose) for pose in docks],
    }
    write_atomically(path, (json.dumps(document) + "\n").encode())


def _layer(kind: str, mask: NDArray[np.bool_], pixel: int) -> dict[str, Any] | None:
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
        "metaData": {"area": int(mask.sum()) * pixel * pixel},
        "type": kind,
        "pixels": [],
        "dimensions": {"x": _extent(columns), "y": _extent(rows), "pixelCount": int(mask.sum())},
        "compressedPixels": runs,
    }


def _extent(values: NDArray[np.int64]) -> dict[str, int]:
    low, high = int(values.min()), int(values.max())
    return {"min": low, "max": high, "mid": (low + high) // 2, "avg": round(float(values.mean()))}


def _charger(grid: OccupancyGrid, pose: Pose) -> dict[str, Any]:
    x = round(100.0 * (pose[0] - grid.origin[0]))
    y = round(100.0 * (grid.height * grid.resolution - (pose[1] - grid.origin[1])))
    angle = round(float(np.degrees(-pose[2]))) % 360
    return {"__class": "PointMapEntity", "metaData": {"angle": angle}, "type": "charger_location", "points": [x, y]}
