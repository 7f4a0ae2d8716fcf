# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a saved map in the formats of other programs."""

import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import numpy as np

from oort._core import Map, OccupancyGrid, Parameters
from oort.areas import Area, areas_of, is_area
from oort.errors import InputError, OortError
from oort.export.drawing import FloorPlan, write_dxf, write_svg
from oort.export.files import make_folder
from oort.export.g2o import write_g2o
from oort.export.geojson import feature, write_geojson
from oort.export.kitti import write_kitti
from oort.export.map_server import write_map_server
from oort.export.mcap import write_mcap
from oort.export.named_rooms import ROOMS, NamedRoom, named_rooms
from oort.export.nav2 import thin_route, write_docks, write_keepout, write_route
from oort.export.rerun import write_rerun
from oort.export.tum import write_tum
from oort.export.valetudo import write_valetudo
from oort.export.walls import fit_walls
from oort.offline.drawing import draw_map
from oort.offline.results import pose_graph
from oort.recording.types import Pose

_DOCKS = "dock"  # the namespace of docks

FORMATS = {
    "pgm": "map.pgm and map.yaml for map_server (the name's ending counts: .pgm or .png)",
    "svg": "floor plan: straight walls, rooms with their areas, no-go areas and places",
    "dxf": "the same for CAD programs, in metres",
    "geojson": "walls, rooms, no-go areas, places and docks, in metres",
    "nav2-docks": "database of docks for nav2's docking server (YAML)",
    "nav2-keepout": "mask of no-go areas for nav2's keepout filter (a map for its map_server)",
    "nav2-route": "graph of the ways driven for nav2's route server (GeoJSON)",
    "valetudo": "map for home automation in Valetudo's JSON",
    "mcap": "the solved drive for Foxglove and ros2 bag play: map, tf, trajectory, the nodes' scans",
    "rerun": "the same for Rerun: map, trajectory, places, the nodes' poses and scans over time",
    "g2o": "the pose graph",
    "tum": "poses of the sensor at the nodes, TUM",
    "kitti": "the same, KITTI",
}


def export(map_: Map, parameters: Parameters, format_: str, out: str) -> list[str]:
    """Writes a map in one of FORMATS to a file; returns the names of what was written.

    Raises InputError if the map holds nothing for that format, OortError if the file cannot be written.
    """
    if not len(map_):
        raise InputError("the map is empty: there is nothing to export")
    if Path(out).is_file() or not Path(out).exists():  # a device has its folder
        make_folder(Path(out).parent)
    return _WRITERS[format_](map_, parameters, Path(out)) or [out]


def places_of(map_: Map) -> list[tuple[str, str, Pose]]:
    """Namespace, name and pose of each place."""
    found = ((space, id_, map_.locate(space, id_)) for space, id_, *_ in map_.locations)
    return [(space, id_, pose) for space, id_, pose in found if pose is not None]


def rooms_of(map_: Map, parameters: Parameters) -> list[NamedRoom]:
    """The rooms of a map, the largest first. Raises OortError without scipy and shapely."""
    return named_rooms(fit_walls(map_), _grid(map_, parameters), places_of(map_))


def floor_plan(map_: Map, parameters: Parameters) -> FloorPlan:
    """What a floor plan of a map shows; without scipy and shapely no rooms, and the log says so."""
    walls, places = fit_walls(map_), places_of(map_)
    rooms: list[NamedRoom] = []
    try:
        rooms = named_rooms(walls, _grid(map_, parameters), places)
    except OortError as error:
        logging.getLogger("oort").warning("rooms are left out: %s", error)
    names = {name for room in rooms for name in room.name.split(", ")}
    shown = [
        (f"{space}/{id_}", pose)
        for space, id_, pose in places
        if not is_area(space) and not (space == ROOMS and id_ in names)
    ]
    return FloorPlan(walls, shown, rooms, areas_of(places))


def _docks(map_: Map) -> list[tuple[str, Pose]]:
    return [(id_, pose) for space, id_, pose in places_of(map_) if space == _DOCKS]


def _grid(map_: Map, parameters: Parameters) -> OccupancyGrid:
    (_, cleaned), _ = draw_map(map_, parameters)
    return cleaned


def _pgm(map_: Map, parameters: Parameters, out: Path) -> list[str]:
    grid = _grid(map_, parameters)
    image: Literal["png", "pgm"] = "png" if out.suffix == ".png" else "pgm"
    base = out.with_suffix("") if out.suffix in (".pgm", ".png", ".yaml") else out
    write_map_server(str(base), grid.cells, grid.resolution, (*grid.origin, 0.0), image_format=image)
    return [f"{base}.{image}", f"{base}.yaml"]


def _geojson(map_: Map, parameters: Parameters, out: Path) -> None:
    plan = floor_plan(map_, parameters)
    walls = np.round(plan.walls, 4).reshape(-1, 2, 2).tolist()
    features = [feature({"kind": "wall"}, "LineString", wall) for wall in walls]
    features += [_room_feature(named) for named in plan.rooms] + [_area_feature(area) for area in plan.areas]
    for space, id_, (x, y, theta) in places_of(map_):
        if is_area(space):
            continue
        properties: dict[str, Any] = {"kind": "place", "namespace": space, "name": id_, "theta": round(theta, 6)}
        features.append(feature(properties, "Point", [round(x, 4), round(y, 4)]))
    write_geojson(out, features, "oort_map")


def _room_feature(named: NamedRoom) -> dict[str, Any]:
    ring = np.round(named.room.outline, 4).tolist()
    properties = {"kind": "room", "number": named.number, "name": named.name, "area": round(named.room.area, 2)}
    return feature(properties, "Polygon", [[*ring, ring[0]]])


def _area_feature(area: Area) -> dict[str, Any]:
    points = [[round(x, 4), round(y, 4)] for x, y in area.points]
    properties = {"kind": area.kind, "name": area.name}
    if area.kind == "no_go_area":
        return feature(properties, "Polygon", [[*points, points[0]]])
    return feature(properties, "LineString", points)


def _keepout(map_: Map, parameters: Parameters, out: Path) -> list[str]:
    base = out.with_suffix("") if out.suffix in (".pgm", ".yaml") else out
    write_keepout(base, _grid(map_, parameters), areas_of(places_of(map_)))
    return [f"{base}.pgm", f"{base}.yaml"]


def _valetudo(map_: Map, parameters: Parameters, out: Path) -> None:
    plan = floor_plan(map_, parameters)
    write_valetudo(out, _grid(map_, parameters), [pose for _, pose in _docks(map_)], plan.rooms, plan.areas)


def _route(map_: Map, _: Parameters, out: Path) -> None:
    edges = map_.edges
    ends = np.stack([edges["i"], edges["j"]], axis=1).astype(np.int64).reshape(-1, 2)
    write_route(out, *thin_route(map_.node_poses[:, :2], ends))


def _rerun(map_: Map, parameters: Parameters, out: Path) -> None:
    places = places_of(map_)
    shown = [(f"{space}/{id_}", pose) for space, id_, pose in places if not is_area(space)]
    write_rerun(out, map_, _grid(map_, parameters), shown, areas_of(places))


def _tum(map_: Map, _: Parameters, out: Path) -> None:
    write_tum(out, [f"{time:.6f}" for time in map_.cloud_times.tolist()], map_.node_poses)


_WRITERS: dict[str, Callable[[Map, Parameters, Path], list[str] | None]] = {
    "pgm": _pgm,
    "svg": lambda map_, parameters, out: write_svg(out, floor_plan(map_, parameters)),
    "dxf": lambda map_, parameters, out: write_dxf(out, floor_plan(map_, parameters)),
    "geojson": _geojson,
    "nav2-docks": lambda map_, _, out: write_docks(out, _docks(map_)),
    "nav2-keepout": _keepout,
    "nav2-route": _route,
    "valetudo": _valetudo,
    "mcap": lambda map_, parameters, out: write_mcap(out, map_, _grid(map_, parameters)),
    "rerun": _rerun,
    "g2o": lambda map_, _, out: write_g2o(out, pose_graph(map_)),
    "tum": _tum,
    "kitti": lambda map_, _, out: write_kitti(out, map_.node_poses),
}
