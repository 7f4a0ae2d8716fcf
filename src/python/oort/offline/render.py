# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Draws a saved map as pictures for map_server."""

from collections.abc import Generator
from pathlib import Path
from typing import Any

from oort._core import Parameters
from oort.diagnosis import loose_parts
from oort.errors import InputError
from oort.export import write_map_server
from oort.export.files import make_folder
from oort.offline.drawing import draw_map
from oort.saved_maps import open_map


def render(
    map_path: str, prefix: str, parameters: Parameters, *, ignore_checksum: bool = False
) -> Generator[str, None, dict[str, Any]]:
    """Writes PREFIX_map and PREFIX_map_cleaned, each .png and .yaml; yields the names of each pair, after notes.

    Returns both.

    Raises MapFileError, InputError if there is nothing to draw, and OortError if a file cannot be written.
    """
    map_ = open_map(map_path, ignore_checksum=ignore_checksum)
    make_folder(Path(prefix).parent)
    grids, notes = draw_map(map_, parameters)
    notes = [*notes, *(str(trouble) for trouble in loose_parts(map_))]
    yield from notes
    written: list[str] = []
    for grid, name in zip(grids, ("map", "map_cleaned"), strict=True):
        if not grid.cells.size:
            raise InputError(f"{map_path}: there is nothing to draw, for no scan of this map has a return")
        base = f"{prefix}_{name}"
        write_map_server(base, grid.cells, grid.resolution, (*grid.origin, 0.0), image_format="png")
        written += [f"{base}.png", f"{base}.yaml"]
        yield " ".join(written[-2:])
    return {"notes": notes, "written": written}
