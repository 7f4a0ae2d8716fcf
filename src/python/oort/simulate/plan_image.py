# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Floor plans from pictures: what is dark is wall, what is light is floor; pictures of map_server among them."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from PIL import Image

from oort.errors import InputError
from oort.export.map_server import GridMap, read_map_server
from oort.inputs import check_regular, quoted
from oort.poses import Array
from oort.simulate.free_space import BoolArray
from oort.simulate.home import Room
from oort.simulate.plan import Plan

WALL, FLOOR = 0.65, 0.196  # darkness from which a pixel is wall, and below which it is floor: those of map_server
RESOLUTIONS = (0.002, 0.5)  # m of a pixel
MOST_PIXELS = 25_000_000
STAIRS = 0.99  # pixels by which a slanted wall may be off the stairs of its pixels; what is a pixel deep stays
LEAST_FLOOR = 0.5  # m^2; what is enclosed and smaller is no room


def read_plan_image(path: Path, resolution: float | None) -> Plan:
    """The plan of a picture whose pixels have sides of ``resolution`` [m], or of a map of map_server (.yaml).

    Its frame is the picture's: x to the right and y up from the lower left corner, or as the .yaml says. Floor is the
    largest light area that does not reach the picture's border, if there is one: outside of the walls is no floor.
    Raises InputError.
    """
    import shapely

    grid = _read(path, resolution)
    free = _inside(grid.cells == 0, path, grid.resolution)
    floor, walls = (_shape(shapely, mask, grid) for mask in (free, grid.cells == 100))
    rooms = tuple(
        Room("floor", np.array(shapely.geometry.polygon.orient(part).exterior.coords)[:-1])
        for part in shapely.get_parts(floor)
    )
    return Plan(str(path), rooms, floor, segments_of(shapely, walls), segments_of(shapely, floor))


def segments_of(shapely: ModuleType, shape: Any) -> Array:
    """The sides (n, 4) of polygons, those of their holes too."""
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(shapely.get_parts(shape))]
    return np.vstack([np.empty((0, 4)), *(np.hstack([ring[:-1], ring[1:]]) for ring in rings)])


def _read(path: Path, resolution: float | None) -> GridMap:
    if path.suffix.lower() in (".yaml", ".yml"):
        if resolution is not None:
            raise InputError(f"{path} says itself how large its pixels are; leave out --resolution")
        return read_map_server(path)
    check_regular(path)
    if resolution is None:
        raise InputError(f"{path}: how many metres is a pixel? Say so with --resolution, for example 0.05")
    if not RESOLUTIONS[0] <= resolution <= RESOLUTIONS[1]:
        raise InputError(f"--resolution {resolution:g}: choose {RESOLUTIONS[0]:g} to {RESOLUTIONS[1]:g} m for a pixel")
    try:
        with Image.open(path) as picture:
            if picture.width * picture.height > MOST_PIXELS:
                raise InputError(f"{path} has {picture.width} x {picture.height} pixels; scale it down")
            paper = Image.new("RGBA", picture.size, "white")
            grey = np.asarray(Image.alpha_composite(paper, picture.convert("RGBA")).convert("L"), dtype=np.float64)
    except (OSError, ValueError, SyntaxError, MemoryError, Image.DecompressionBombError) as error:  # as Pillow has it
        raise InputError(f"{path} cannot be read as a picture: {quoted(str(error))}") from None
    darkness = (255.0 - grey) / 255.0
    cells = np.full(grey.shape, -1, dtype=np.int8)
    cells[darkness > WALL] = 100
    cells[darkness < FLOOR] = 0
    return GridMap(np.ascontiguousarray(cells[::-1]), resolution, (0.0, 0.0, 0.0))


def _inside(free: BoolArray, path: Path, resolution: float) -> BoolArray:
    """The largest free area that walls enclose; if none is enclosed, the largest."""
    from scipy import ndimage

    labels, _ = ndimage.label(free)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    enclosed = sizes.copy()
    enclosed[np.unique(np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]]))] = 0
    least = LEAST_FLOOR / resolution**2
    chosen = enclosed if enclosed.max() >= least else sizes
    if chosen.max() < least:
        raise InputError(f"{path} has no light area of {LEAST_FLOOR} m2 or more that could be floor")
    return np.asarray(labels == int(np.argmax(chosen)))


def _shape(shapely: ModuleType, mask: BoolArray, grid: GridMap) -> Any:
    """The cells of a mask as polygons [m], with straight sides where pixels make stairs."""
    edges = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    rows, begins = np.nonzero(edges == 1)
    _, ends = np.nonzero(edges == -1)
    side = grid.resolution
    shape = shapely.union_all(shapely.box(begins * side, rows * side, ends * side, (rows + 1) * side))
    x, y, theta = grid.origin
    cosine, sine = np.cos(theta), np.sin(theta)
    return shapely.affinity.affine_transform(shape.simplify(STAIRS * side), [cosine, -sine, sine, cosine, x, y])
