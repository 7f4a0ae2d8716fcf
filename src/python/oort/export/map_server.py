# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Grid maps as ROS's map_server writes and reads them: a grey picture (.pgm, .png) and its description (.yaml)."""

import io
import json
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from oort.errors import InputError
from oort.export.files import decimal, write_atomically
from oort.inputs import check_regular, floats, quoted, read_text
from oort.recording.types import Pose

FREE, OCCUPIED, UNKNOWN = 254, 0, 205
"""Grey values of the picture."""
_GREY = {0: FREE, 100: OCCUPIED, -1: UNKNOWN}
_OCCUPIED_THRESH, _FREE_THRESH = 0.65, 0.196


@dataclass(frozen=True, slots=True, eq=False)
class GridMap:
    """An occupancy map."""

    cells: NDArray[np.int8]
    """(height, width), row 0 at the bottom: 0 free, 100 occupied, -1 unknown"""
    resolution: float
    """side of a cell [m]"""
    origin: Pose
    """the pose of the lower left corner of cell (0, 0)"""


def write_map_server(
    path_base: str | os.PathLike[str],
    cells: ArrayLike,
    resolution: float,
    origin: Pose,
    *,
    image_format: Literal["pgm", "png"] = "pgm",
) -> None:
    """Writes `path_base`.pgm (or .png) and then `path_base`.yaml. Arguments as in GridMap.

    Raises InputError for cells of another shape or value, OortError if a file cannot be written.
    """
    base = Path(path_base)
    grey = grey_picture(cells)
    image = f"{base.name}.{image_format}"
    plain = re.fullmatch(r"[A-Za-z_][\w.-]*", image, re.ASCII)  # needs no quotes in YAML
    description = (
        f"image: {image if plain else json.dumps(image)}\n"
        "mode: trinary\n"
        f"resolution: {decimal(resolution)}\n"
        f"origin: [{', '.join(decimal(value) for value in origin)}]\n"
        "negate: 0\n"
        f"occupied_thresh: {decimal(_OCCUPIED_THRESH)}\n"
        f"free_thresh: {decimal(_FREE_THRESH)}\n"
    )
    picture = io.BytesIO()
    Image.fromarray(grey).save(picture, format={"pgm": "PPM", "png": "PNG"}[image_format])
    write_atomically(base.with_name(image), picture.getvalue())
    write_atomically(base.with_name(f"{base.name}.yaml"), description.encode())


def grey_picture(cells: ArrayLike) -> NDArray[np.uint8]:
    """(height, width) grey values with the top row first, of cells as in GridMap. Raises InputError as above."""
    cells = np.asarray(cells)
    if cells.ndim != 2 or not cells.size:
        raise InputError(f"a map must have rows and columns, not the shape {cells.shape}")
    grey = np.zeros(cells.shape, dtype=np.uint8)
    known = np.zeros(cells.shape, dtype=bool)
    for value, shade in _GREY.items():
        grey[cells == value] = shade
        known |= cells == value
    if not known.all():
        raise InputError(f"a cell holds {cells[~known].flat[0]}; only 0 (free), 100 (occupied) and -1 (unknown) can be")
    return np.ascontiguousarray(grey[::-1])


def read_map_server(path: str | os.PathLike[str]) -> GridMap:
    """Reads a map by the path of its .yaml. Raises InputError if one of the two files is missing or damaged."""
    path = Path(path)
    try:
        entries: Any = YAML(typ="safe", pure=True).load(read_text(path))
        image = path.parent / str(entries["image"])
        mode, negate = entries.get("mode", "trinary"), bool(entries["negate"])
        numbers = [entries["resolution"], *entries["origin"], entries["occupied_thresh"], entries["free_thresh"]]
        resolution, x, y, theta, occupied, free = floats([str(number) for number in numbers], str(path))
    except (YAMLError, KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise InputError(f"{path} is no map description as map_server has it: {quoted(error)}") from None
    if mode != "trinary":
        raise InputError(f"{path}: only maps of the mode trinary can be read, not {mode}")
    check_regular(image, f"{image}, the picture of {path},")
    try:
        with Image.open(image) as picture:
            grey = np.asarray(picture.convert("L"), dtype=np.float64)
    except (OSError, ValueError, SyntaxError, MemoryError, Image.DecompressionBombError) as error:  # as Pillow has it
        raise InputError(f"{image}, the picture of {path}, cannot be read: {quoted(str(error))}") from None
    occupancy = (grey if negate else 255.0 - grey) / 255.0
    cells = np.full(grey.shape, -1, dtype=np.int8)
    cells[occupancy > occupied] = 100
    cells[occupancy < free] = 0
    return GridMap(np.ascontiguousarray(cells[::-1]), resolution, (x, y, theta))
