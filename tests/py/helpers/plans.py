# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The same small home as a picture and as JSON, for tests of the simulator: three rooms, walls at right angles."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

RESOLUTION = 0.05
SIZE = 7.0, 6.0
"""[m] of the floor within the outer walls, from x, y = 0"""

# The living room lies left, kitchen and bedroom right; doors are gaps.
_ROOMS = {"LivingRoom": (0.0, 0.0, 4.0, 6.0), "Kitchen": (4.0, 0.0, 7.0, 3.0), "Bedroom": (4.0, 3.0, 7.0, 6.0)}
_DOORS = [("wall|a", "LivingRoom", "Kitchen", 1.0), ("wall|b", "LivingRoom", "Bedroom", 1.0)]  # m along the wall
_DOOR = 1.0
_SOFA = (0.0, 5.0, 1.6, 5.9)


def write_picture_of_plan(path: Path) -> None:
    """The home with walls of 0.1 m, white floor, white outside and the sofa in black."""
    margin = round(0.5 / RESOLUTION)
    height, width = (round(side / RESOLUTION) + 2 * margin for side in SIZE[::-1])
    grey = np.full((height, width), 255, dtype=np.uint8)

    def paint(x0: float, y0: float, x1: float, y1: float, value: int) -> None:
        rows = slice(*(margin + round(y / RESOLUTION) for y in (y0, y1)))
        grey[rows, slice(*(margin + round(x / RESOLUTION) for x in (x0, x1)))] = value

    paint(-0.1, -0.1, SIZE[0] + 0.1, SIZE[1] + 0.1, 0)
    paint(0.0, 0.0, *SIZE, 255)
    paint(3.95, 0.0, 4.05, 6.0, 0)
    paint(4.0, 2.95, 7.0, 3.05, 0)
    paint(3.95, 1.0, 4.05, 1.0 + _DOOR, 255)
    paint(3.95, 4.0, 4.05, 4.0 + _DOOR, 255)
    paint(*_SOFA, 0)
    Image.fromarray(grey[::-1]).save(path)


def house() -> dict[str, Any]:
    """The home as ProcTHOR has it; a lamp hangs above the beams, and one object tells no size."""
    walls = {"wall|a": ((4.0, 0.0), (4.0, 3.0)), "wall|b": ((4.0, 3.0), (4.0, 6.0)), "wall|c": ((0.0, 0.0), (4.0, 0.0))}
    front = {"id": "door|3", "room0": "LivingRoom", "room1": "LivingRoom", "wall0": "wall|c", "holePolygon": _hole(1.0)}
    return {
        "rooms": [
            {"id": name, "roomType": name, "floorPolygon": [_at(*p) for p in ((a, b), (a, d), (c, d), (c, b))]}
            for name, (a, b, c, d) in _ROOMS.items()
        ],
        "walls": [
            {"id": name, "polygon": [_at(*begin), _at(*end), _at(*end, 2.5), _at(*begin, 2.5)]}
            for name, (begin, end) in walls.items()
        ],
        "doors": [
            *(
                {"id": f"door|{k}", "room0": a, "room1": b, "wall0": wall, "holePolygon": _hole(along)}
                for k, (wall, a, b, along) in enumerate(_DOORS)
            ),
            front,
        ],
        "objects": [
            {"id": "Sofa|1", "axisAlignedBoundingBox": _box(*_SOFA, 0.0, 0.8)},
            {"id": "Lamp|1", "axisAlignedBoundingBox": _box(1.8, 1.8, 2.2, 2.2, 2.0, 2.3)},
            {"id": "Cup|1", "assetId": "Cup_1"},
        ],
    }


def write_house(path: Path) -> None:
    """The same as a file."""
    path.write_text(json.dumps(house()))


def _at(x: float, z: float, y: float = 0.0) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def _hole(along: float) -> list[dict[str, float]]:
    return [_at(along, 0.0), _at(along + _DOOR, 0.0, 2.1)]


def _box(x0: float, z0: float, x1: float, z1: float, low: float, high: float) -> dict[str, Any]:
    return {
        "center": {"x": 0.5 * (x0 + x1), "y": 0.5 * (low + high), "z": 0.5 * (z0 + z1)},
        "size": {"x": x1 - x0, "y": high - low, "z": z1 - z0},
    }
