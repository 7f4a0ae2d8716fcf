# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The solved drive as a recording of Rerun.

All is drawn on the plane z = 0, the grid a little below, and seen from above: Rerun's 2D views have y down, and would
show a map mirrored.
"""

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from oort._core import Map, OccupancyGrid
from oort.areas import Area
from oort.errors import InputError, OortError
from oort.recording.types import Pose

_FRAME = "map"
_END_OF_TIME = 9.2e9  # [s] Rerun counts nanoseconds from 1970 in an int64
_BELOW = 0.1  # [m] the grid is under what is drawn on it, which it would hide else
_ARROW = 0.5  # [m] length of the arrow where the sensor is
_EYE = 1.3  # height of the eye over the map, in lengths of the map's longer side
_SCAN, _WAY, _SENSOR, _PLACE, _NO_GO = 0x0072B2FF, 0x56B4E9FF, 0xD55E00FF, 0x009E73FF, 0xCC79A7FF  # Okabe and Ito's


def write_rerun(
    path: Path, map_: Map, grid: OccupancyGrid, places: Sequence[tuple[str, Pose]], areas: Sequence[Area]
) -> None:
    """Writes the map, the trajectory, places (label and pose) and areas, and at each node's stamp its pose and scan.

    The timelines are ``stamp`` and ``node``, positions are metres in the map's frame.
    Raises InputError if Rerun has no such stamps, OortError without rerun-sdk or if the file cannot be written.
    """
    try:
        import rerun
        from rerun import GridMap, blueprint  # older ones have no GridMap
    except ImportError:
        raise OortError("Rerun's recordings need the package rerun-sdk: pip install 'oort[rerun]'") from None
    if not np.abs(map_.cloud_times).max() < _END_OF_TIME:
        first, last = float(map_.cloud_times.min()), float(map_.cloud_times.max())
        raise InputError(f"the nodes' stamps, {first:g} to {last:g} s, are none that Rerun can have: it ends in 2262")
    height, width = grid.cells.shape
    low = np.array(grid.origin)
    high = low + grid.resolution * np.array([width, height])
    middle = 0.5 * (low + high)
    eye = blueprint.EyeControls3D(
        kind=blueprint.Eye3DKind.Orbital,
        position=[*middle, _EYE * float((high - low).max())],
        look_target=[*middle, 0.0],
        eye_up=[0.0, 1.0, 0.0],
    )
    view = blueprint.Spatial3DView(origin=_FRAME, name="map", eye_controls=eye, line_grid=False)
    layout = blueprint.Blueprint(view, blueprint.TimePanel(timeline="stamp"), collapse_panels=True)
    try:
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=".oort-") as folder:
            made = Path(folder) / "drive.rrd"
            stream = rerun.RecordingStream("oort")
            stream.set_log_tick_enabled(False)
            stream.set_log_time_enabled(False)
            stream.save(made, layout)
            _log_lasting(rerun, stream, map_, places, areas)
            stream.log(
                f"{_FRAME}/grid",
                GridMap(
                    data=grid.cells.astype(np.int8).tobytes(),
                    format=rerun.components.ImageFormat(
                        width=width, height=height, color_model="L", channel_datatype="U8"
                    ),
                    cell_size=grid.resolution,
                    translation=[*low, -_BELOW],
                    colormap=rerun.components.Colormap.RvizMap,
                ),
                static=True,
            )
            for k in np.argsort(map_.cloud_times, kind="stable").tolist():
                _log_node(rerun, stream, map_, k)
            stream.flush()
            stream.disconnect()
            os.replace(made, path)
    except OSError as error:
        raise OortError(f"{path}: the recording of Rerun cannot be written: {error.strerror}") from error


def _log_lasting(rerun: Any, stream: Any, map_: Map, places: Sequence[tuple[str, Pose]], areas: Sequence[Area]) -> None:
    """What is there at all times."""
    way = rerun.LineStrips3D([_flat(map_.node_poses[:, :2])], colors=_WAY, radii=0.02)
    stream.log(f"{_FRAME}/trajectory", way, static=True)
    if places:
        points = _flat(np.array([pose[:2] for _, pose in places]))
        labels = [label for label, _ in places]
        stream.log(f"{_FRAME}/places", rerun.Points3D(points, colors=_PLACE, radii=0.08, labels=labels), static=True)
    if areas:
        lines = [_flat(np.array([*a.points, *a.points[: a.kind == "no_go_area"]])) for a in areas]
        names = [area.name for area in areas]
        drawn = rerun.LineStrips3D(lines, colors=_NO_GO, radii=0.03, labels=names)
        stream.log(f"{_FRAME}/no_go", drawn, static=True)


def _log_node(rerun: Any, stream: Any, map_: Map, k: int) -> None:
    """The sensor's pose and its scan, in the map's frame, so that scans of many nodes can be shown at once."""
    x, y, theta = map_.node_poses[k].tolist()
    stream.set_time("stamp", timestamp=np.datetime64(round(1e9 * map_.cloud_times[k]), "ns"))
    stream.set_time("node", sequence=k)
    turned = rerun.RotationAxisAngle(axis=[0.0, 0.0, 1.0], radians=theta)
    stream.log(f"{_FRAME}/laser", rerun.Transform3D(translation=[x, y, 0.0], rotation=turned))
    stream.log(f"{_FRAME}/laser", rerun.Arrows3D(vectors=[_ARROW, 0.0, 0.0], colors=_SENSOR, radii=0.04))
    cloud = map_.cloud(k)
    points = cloud[cloud[:, 2] == 1.0, :2]
    cos, sin = np.cos(theta), np.sin(theta)
    points = points @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
    stream.log(f"{_FRAME}/scan", rerun.Points3D(_flat(points), colors=_SCAN, radii=0.02))


def _flat(points: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Points (N, 2) on the plane z = 0, (N, 3)."""
    return np.column_stack([points, np.zeros(len(points))])
