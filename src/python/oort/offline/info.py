# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a saved map or a recording is, in figures."""

from pathlib import Path
from typing import Any

import numpy as np

from oort._core import SWITCH_ON, Map, Parameters, normalise_map_path, read_map_format
from oort.areas import areas_of, is_area
from oort.history import describe, versions
from oort.offline.drawing import draw_map
from oort.offline.export import places_of
from oort.recording import Recording
from oort.saved_maps import open_map

_FILES = (".map_capnp", ".map_meta_capnp", ".md5")


_UNITS = {
    "seconds": "s",
    "size": "m",
    "free_area": "m²",
    "range_max": "m",
    "sensor_on_base": "(m, m, rad)",
    "driven_by_odometry": "m",
}
"""of what format_info() tells"""


def is_saved_map(path: str) -> bool:
    """Whether a path, with or without an ending, leads to an Oort map; a folder is a ROS 2 bag, if anything."""
    return not Path(path).is_dir() and Path(f"{normalise_map_path(path)}{_FILES[0]}").is_file()


def map_info(path: str, parameters: Parameters, *, ignore_checksum: bool = False) -> dict[str, Any]:
    """The figures of a saved map. Raises MapFileError if it cannot be read."""
    base = normalise_map_path(path)
    map_ = open_map(path, ignore_checksum=ignore_checksum)
    format_ = read_map_format(base, True)
    loops = map_.switchable_edges["switch"]
    places = places_of(map_)
    files = [Path(base + ending) for ending in _FILES]
    return {
        "path": base,
        "kind": "Oort map",
        "bytes": sum(file.stat().st_size for file in files if file.is_file()),
        "format": format_.version,
        "written_by": format_.written_by,
        "nodes": len(map_),
        "chains": _chains(map_),
        "seconds": [float(map_.cloud_times.min()), float(map_.cloud_times.max())] if len(map_) else [],
        "closures": int((loops >= SWITCH_ON).sum()),
        "closures_undone": int((loops < SWITCH_ON).sum()),
        **_area(map_, parameters),
        "places": [f"{space}/{id_}" for space, id_, _ in places if not is_area(space)],
        "areas": [area.name_space for area in areas_of(places)],
        "versions": [describe(version) for version in versions(base)],
    }


def recording_info(recording: Recording) -> dict[str, Any]:
    """The figures of a recording, for which all of it is read. Raises InputError if it cannot be."""
    times, beams, farthest, poses = [], set(), 0.0, []
    angles: tuple[float, float] = (0.0, 0.0)
    for scan in recording.scans():
        if scan.mount is not None:
            continue
        times.append(scan.time)
        beams.add(len(scan.ranges))
        farthest = max(farthest, scan.range_max)
        poses.append(scan.odometry[:2])
        angles = scan.angle_min, scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1)
    seconds = max(times) - min(times) if times else 0.0
    steps = np.linalg.norm(np.diff(np.array(poses).reshape(-1, 2), axis=0), axis=1)
    return {
        "name": recording.name,
        "kind": recording.kind,
        "scans": len(times),
        "seconds": seconds,
        "scans_per_second": (len(times) - 1) / seconds if seconds > 0.0 else None,
        "beams": sorted(beams),
        "view_degrees": float(np.degrees(abs(angles[1] - angles[0]))),
        "range_max": farthest,
        "sensor_on_base": list(recording.sensor_on_base),
        "odometry": recording.without_odometry or "there",
        "driven_by_odometry": float(steps.sum()) if not recording.without_odometry else None,
        "notes": list(recording.notes),
    }


def format_info(info: dict[str, Any]) -> str:
    """As aligned lines for people."""
    width = max(map(len, info))
    lines = []
    for name, value in info.items():
        unit = _UNITS.get(name) if value not in (None, []) else None
        lines.append(f"{name.replace('_', ' '):<{width}}  {_text(value) or '-'}{f' {unit}' if unit else ''}")
    return "\n".join(lines)


def _text(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, list):
        return ", ".join(map(_text, value)) or "none"
    return f"{value:z.3f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)


def _chains(map_: Map) -> int:
    """Runs of nodes that the chain's edges tie together: one for each session or trajectory segment."""
    edges = map_.edges
    parents = list(range(len(map_)))

    def root(node: int) -> int:
        while parents[node] != node:
            parents[node] = parents[parents[node]]
            node = parents[node]
        return node

    for i, j in zip(edges["i"].tolist(), edges["j"].tolist(), strict=True):
        parents[root(j)] = root(i)
    return sum(parent == node for node, parent in enumerate(parents))


def _area(map_: Map, parameters: Parameters) -> dict[str, Any]:
    if not len(map_):
        return {"size": [], "free_area": 0.0}
    (_, grid), _ = draw_map(map_, parameters)
    size = [grid.width * grid.resolution, grid.height * grid.resolution]
    return {"size": size, "free_area": float((grid.cells == 0).sum() * grid.resolution**2)}
