# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What nav2 reads: docks for its docking server, and a graph of the ways that were driven for its route server."""

import io
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML

from oort._core import OccupancyGrid
from oort.areas import Area
from oort.errors import InputError
from oort.export.files import write_atomically
from oort.export.geojson import feature, write_geojson
from oort.export.map_server import write_map_server
from oort.export.painting import paint
from oort.recording.types import Pose

_DOCK = "simple_charging_dock"
_FRAME = "map"


def write_docks(path: Path, docks: Sequence[tuple[str, Pose]]) -> None:
    """Writes docks, names with T_map_dock, as nav2's ``dock_database`` (YAML).

    Raises InputError if there is none, OortError if the file cannot be written.
    """
    if not docks:
        raise InputError(
            "the map has no dock: name it while mapping (with oort replay --events FILE, in a robot graph_loc/create)"
        )
    entries = {
        name: {"type": _DOCK, "frame": _FRAME, "pose": [round(value, 6) for value in pose]} for name, pose in docks
    }
    stream = io.StringIO()
    yaml = YAML()
    yaml.default_flow_style = None
    yaml.dump({"docks": entries}, stream)
    write_atomically(path, stream.getvalue().encode())


def write_keepout(base: Path, grid: OccupancyGrid, areas: Sequence[Area]) -> None:
    """Writes ``base``.pgm and .yaml, a mask as large as the map for nav2's keepout filter: no-go areas are occupied.

    Raises InputError if there is none, OortError if a file cannot be written.
    """
    if not areas:
        raise InputError("the map has no no-go areas: oort areas --add makes one")
    mask = paint(grid, [(area.points, area.kind == "no_go_area") for area in areas])
    cells = np.where(mask > 0, 100, 0).astype(np.int8)
    write_map_server(base, cells, grid.resolution, (*grid.origin, 0.0))


def write_route(path: Path, nodes: NDArray[np.float64], edges: NDArray[np.int64]) -> None:
    """Writes a route graph (GeoJSON): nodes (n, 2) x, y [m] and edges (m, 2), each to be driven both ways.

    Raises OortError if the file cannot be written.
    """
    features: list[dict[str, Any]] = [
        feature({"id": k, "frame": _FRAME}, "Point", [round(x, 4), round(y, 4)])
        for k, (x, y) in enumerate(nodes.tolist())
    ]
    both = np.concatenate([edges, edges[:, ::-1]]) if len(edges) else edges
    for k, (i, j) in enumerate(both.tolist()):
        ends = np.round(nodes[[i, j]], 4).tolist()
        features.append(feature({"id": len(nodes) + k, "startid": i, "endid": j}, "MultiLineString", [ends]))
    write_geojson(path, features, "route_graph")


def thin_route(
    positions: NDArray[np.float64], edges: NDArray[np.int64], spacing: float = 0.5
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A graph with one node per place of a driven way: positions (n, 2) closer than ``spacing`` [m] become one.

    ``edges`` (m, 2) are the ways driven between positions. Returns nodes (k, 2) and edges (l, 2), each once.
    """
    kept: list[int] = []
    squares: dict[tuple[int, int], list[int]] = {}  # of a spacing's width: which of the kept lie there
    place = np.zeros(len(positions), dtype=np.int64)
    for k, (x, y) in enumerate(positions.tolist()):
        column, row = math.floor(x / spacing), math.floor(y / spacing)
        around = sorted(
            number for dx in (-1, 0, 1) for dy in (-1, 0, 1) for number in squares.get((column + dx, row + dy), ())
        )
        distances = np.linalg.norm(positions[[kept[number] for number in around]] - positions[k], axis=1)
        if len(around) and distances.min() < spacing:
            place[k] = around[int(distances.argmin())]
        else:
            place[k] = len(kept)
            squares.setdefault((column, row), []).append(len(kept))
            kept.append(k)
    ends = np.sort(place[edges], axis=1) if len(edges) else edges
    ends = ends[ends[:, 0] != ends[:, 1]] if len(ends) else ends
    return positions[kept], np.unique(ends, axis=0).reshape(-1, 2)
