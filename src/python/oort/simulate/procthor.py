# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Homes from JSON as ProcTHOR has it (Deitke et al. 2022): rooms as polygons, doors as holes in walls, objects.

Read are ``rooms`` (``roomType``, ``floorPolygon``), ``walls`` (``id``, ``polygon``; ``empty`` where there is none),
``doors`` (``room0``, ``room1``, ``wall0``, ``holePolygon``, whose x counts from the wall's first corner; before schema
1.0.0 ``boundingBox`` and ``assetOffset``) and ``objects``. An object's size is its ``axisAlignedBoundingBox``
(``center``, ``size``), which a file has once a simulator wrote it, or that of its ``assetId`` in ProcTHOR's
asset-database.json. Positions are x and z [m]; y is up.
"""

import json
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from oort.errors import InputError
from oort.inputs import quoted, read_text
from oort.poses import Array
from oort.simulate.floor_plan import Rect
from oort.simulate.furniture import Piece
from oort.simulate.home import Room
from oort.simulate.plan import Plan
from oort.simulate.planar import transform

FARTHEST = 1000.0  # m from the origin
MOST = 10_000  # rooms, doors or objects
BEAM = 0.2  # m above the floor: what a scan sees must reach from below to above
WALL_OFF = 0.05  # m that a door may be off its wall


def read_procthor(path: Path, assets: Path | None = None) -> Plan:
    """The plan of a house; doors between rooms stand open, those to the outside are shut.

    ``assets`` is ProcTHOR's asset-database.json, with the sizes of objects that do not tell theirs. Raises InputError.
    """
    import shapely

    house = _load(path)
    reader = _Reader(path, shapely, {} if assets is None else _read_sizes(assets))
    rooms = [reader.room(number, entry) for number, entry in enumerate(reader.entries(house, "rooms"))]
    if not rooms:
        raise InputError(f"{path} has no rooms; a house as ProcTHOR has it lists them as 'rooms'")
    shapes = [shapely.Polygon(room.corners) for room in rooms]
    lines = shapely.union_all([shape.exterior for shape in shapes])
    holes = reader.holes(reader.entries(house, "walls"), reader.entries(house, "doors"))
    left = lines.difference(shapely.union_all(holes)) if holes else lines
    walls = _sides(shapely, left)
    pieces = [reader.piece(number, entry) for number, entry in enumerate(reader.entries(house, "objects"))]
    kept = tuple(piece for piece in pieces if piece is not None)
    notes: tuple[str, ...] = ()
    if reader.unknown:
        notes = (
            f"{reader.unknown} of {len(pieces)} objects do not tell their size and are left out; ProcTHOR's "
            "asset-database.json has it (--assets)",
        )
    return Plan(str(path), tuple(rooms), shapely.union_all(shapes), walls, walls, kept, notes=notes)


def _load(path: Path) -> Any:
    try:
        return json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path} is no JSON: {quoted(str(error))}") from None


def _read_sizes(path: Path) -> dict[str, tuple[float, float, float]]:
    """Width, height and depth [m] of each asset."""
    content = _load(path)
    try:
        found = {
            str(asset["assetId"]): tuple(float(asset["boundingBox"][key]) for key in ("x", "y", "z"))
            for kind in content.values()
            for asset in kind
        }
        if not all(0.0 <= side <= FARTHEST for size in found.values() for side in size):
            raise ValueError
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError):
        raise InputError(f"{path} is no asset-database.json: lists of assetId and boundingBox, by kind") from None
    return {name: (size[0], size[1], size[2]) for name, size in found.items()}


def _sides(shapely: ModuleType, lines: Any) -> Array:
    """The straight pieces (n, 4) of lines."""
    parts = [shapely.get_coordinates(line) for line in shapely.get_parts(lines)]
    return np.vstack([np.empty((0, 4)), *(np.hstack([part[:-1], part[1:]]) for part in parts)])


def _ends(wall: Array) -> Array:
    """The first corner of a wall, and the one farthest from it."""
    ends: Array = wall[[0, int(np.argmax(np.hypot(*(wall - wall[0]).T)))]]
    return ends


class _Reader:
    """Reads the entries of a house; every error says which."""

    def __init__(self, path: Path, shapely: ModuleType, sizes: Mapping[str, tuple[float, float, float]]) -> None:
        self._path, self._shapely, self._sizes = path, shapely, sizes
        self.unknown = 0  # objects without a size

    def entries(self, house: Any, name: str) -> list[Any]:
        """A list of the house, empty if it has none."""
        found = house.get(name, []) if isinstance(house, dict) else None
        if not isinstance(found, list) or len(found) > MOST:
            raise InputError(f"{self._path}: {name!r} must be a list of at most {MOST}")
        return found

    def room(self, number: int, entry: Any) -> Room:
        """A room with its corners counter-clockwise."""
        corners = self._points(entry, "floorPolygon", f"room {number}")
        shape = self._shapely.Polygon(corners) if len(corners) >= 3 else None
        if shape is None or not shape.is_valid or shape.area < 0.1:
            raise InputError(f"{self._path}: the floorPolygon of room {number} is no polygon of 0.1 m2 or more")
        outline = np.array(self._shapely.geometry.polygon.orient(shape).exterior.coords)[:-1]
        words = re.findall("[A-Z]?[a-z0-9]+", str(entry.get("roomType", ""))[:40])  # LivingRoom: living room
        return Room(" ".join(words).lower() or "room", outline)

    def holes(self, walls: Sequence[Any], doors: Sequence[Any]) -> list[Any]:
        """Shapes around the doors between rooms, and around walls that are not there."""
        known = {
            str(entry["id"]): self._points(entry, "polygon", f"wall {number}")
            for number, entry in enumerate(walls)
            if isinstance(entry, dict) and "id" in entry
        }
        missing = {str(entry.get("id")) for entry in walls if isinstance(entry, dict) and entry.get("empty")}
        empty = [wall for name, wall in known.items() if name in missing]
        found = [self._shapely.LineString(_ends(wall)).buffer(WALL_OFF, cap_style="flat") for wall in empty]
        for number, door in enumerate(doors):
            what = f"door {number}"
            if not isinstance(door, dict) or str(door.get("wall0")) not in known:
                raise InputError(f"{self._path}: {what} names no wall of the file as its wall0")
            if door.get("room0") == door.get("room1"):
                continue  # to the outside
            ends = _ends(known[str(door["wall0"])])
            length = float(np.hypot(*(ends[1] - ends[0])))
            along = self._hole(door, what)
            if not along or length == 0.0 or not -WALL_OFF <= min(along) < max(along) <= length + WALL_OFF:
                raise InputError(f"{self._path}: the holePolygon of {what} does not lie within its wall")
            hole = ends[0] + np.outer([min(along), max(along)], (ends[1] - ends[0]) / length)
            found.append(self._shapely.LineString(hole).buffer(WALL_OFF, cap_style="flat"))
        return found

    def piece(self, number: int, entry: Any) -> Piece | None:
        """What a scan sees of an object; None if it hangs above, lies below, or its size is not known."""
        what = f"object {number}"
        box = entry.get("axisAlignedBoundingBox") if isinstance(entry, dict) else None
        size = self._sizes.get(str(entry.get("assetId"))) if isinstance(entry, dict) else None
        turned = 0.0
        if box is not None:
            ((x, y, z),) = self._pairs({"center": [box.get("center")]} if isinstance(box, dict) else {}, "center", what)
            ((width, height, depth),) = self._pairs({"size": [box.get("size")]}, "size", what)
        elif size is not None:
            (width, height, depth), turned = size, self._turned(entry, what)
            ((x, y, z),) = self._pairs({"position": [entry.get("position")]}, "position", what)
            y = max(y, 0.5 * height)  # some generators put what stands at 0
        else:
            self.unknown += 1
            return None
        if min(width, height, depth) <= 0.0 or not y - 0.5 * height < BEAM < y + 0.5 * height:
            return None
        corners = transform((x, z, turned), Rect(-0.5 * width, -0.5 * depth, 0.5 * width, 0.5 * depth).polygon())
        return Piece(str(entry.get("id", what))[:40], corners, (corners,), np.empty((0, 3)))

    def _turned(self, entry: dict[str, Any], what: str) -> float:
        """Heading [rad] in x and z, counter-clockwise; the file's degrees count clockwise seen from above."""
        rotation = entry.get("rotation", {"y": 0.0})
        ((degrees,),) = self._pairs({"rotation": [rotation]}, "rotation", what, ("y",))
        return math.radians(-degrees)

    def _hole(self, door: dict[str, Any], what: str) -> list[float]:
        """Where along its wall a door is [m]."""
        box = door.get("boundingBox")
        if "holePolygon" in door or not isinstance(box, dict):
            return [x for x, _ in self._pairs(door, "holePolygon", what, ("x", "y"))]
        ends = self._pairs({"boundingBox": [box.get("min"), box.get("max")]}, "boundingBox", what, ("x",))
        ((offset,),) = self._pairs({"assetOffset": [door.get("assetOffset", {"x": 0.0})]}, "assetOffset", what, ("x",))
        return [x + offset for (x,) in ends]

    def _points(self, entry: Any, name: str, what: str) -> Array:
        """(n, 2) x and z."""
        return np.array(self._pairs(entry, name, what, ("x", "z"))).reshape(-1, 2)

    def _pairs(self, entry: Any, name: str, what: str, keys: Sequence[str] = ("x", "y", "z")) -> list[list[float]]:
        points = entry.get(name) if isinstance(entry, dict) else None
        try:
            found = [[float(point[key]) for key in keys] for point in points or []]
        except (KeyError, TypeError, ValueError, OverflowError):
            found = [[math.nan]]
        if not found or len(found) > MOST or not all(abs(value) <= FARTHEST for point in found for value in point):
            raise InputError(f"{self._path}: {name} of {what} must be points with {', '.join(keys)} in metres")
        return found
