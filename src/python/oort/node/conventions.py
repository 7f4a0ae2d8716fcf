# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What users of slam_toolbox know of a mapping node in ROS 2: their topics, and their services for what Oort does."""

from pathlib import Path
from typing import Any

import numpy as np
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData

from oort._core import save_map
from oort.errors import StateError
from oort.export.map_server import write_map_server
from oort.live import Drawing, LiveSession
from oort.live.paths import check_absolute, make_room
from oort.node.messages import nanoseconds, place_grid, pose_with_covariance
from oort.node.middleware import Middleware, Quality
from oort.session import Session, State

_ENDINGS = (".pgm", ".yaml")


class MappingConventions:
    """Beside the node's own topics and services."""

    def __init__(self, live: LiveSession, middleware: Middleware, map_frame: str) -> None:
        """Offers them."""
        self._live = live
        self._middleware = middleware
        self._map_frame = map_frame
        self._meta_data = middleware.publisher("map_metadata", MapMetaData, Quality.LATCHED)
        self._pose = middleware.publisher("pose", PoseWithCovarianceStamped, Quality.STREAM)
        middleware.offer("save_map", "SetString", lambda request: self._save_map(request.data))
        middleware.offer("serialize_map", "SetString", lambda request: self._serialize(request.data))
        middleware.offer("deserialize_map", "SetString", lambda request: live.call("map/load", [request.data]))
        middleware.offer("pause_new_measurements", "Empty", lambda _: self._pause())
        middleware.offer("reset", "Empty", lambda _: self._reset())
        middleware.offer("dynamic_map", "GetOccupancyGrid", lambda _: self._map())

    def scan_taken(self) -> None:
        """Tells where the base was at the scan that was mapped just now."""
        figures = self._live.figures
        if figures.last_result is None or not self._pose.is_wanted():
            return
        stamp = self._middleware.stamp(nanoseconds(figures.last_stamp))
        result = figures.last_result
        self._pose.publish(pose_with_covariance(result.T_map_base, result.covariance, self._map_frame, stamp))

    def drawn(self, drawing: Drawing) -> None:
        """Tells how large the map is."""
        stamp = self._middleware.stamp(self._middleware.now())
        message = place_grid(self._middleware.grid(drawing.grid), drawing.grid, self._map_frame, stamp)
        self._meta_data.publish(message.info)

    def _save_map(self, path: str) -> None:
        """The map for map_server, as PATH.pgm and PATH.yaml."""
        _check("save_map", path)
        base = Path(path).with_suffix("") if Path(path).suffix in _ENDINGS else Path(path)
        grid = self._live.gallery.latest(self._live.snapshot.revision).grid
        x, y = map(float, grid.origin)
        write_map_server(base, np.asarray(grid.cells), float(grid.resolution), (x, y, 0.0))

    def _serialize(self, path: str) -> None:
        """A copy of the map as it is now, to go on with; mapping goes on as before."""
        _check("serialize_map", path)

        def write(session: Session) -> None:
            save_map(path, session.map)

        self._live.run(write)

    def _pause(self) -> None:
        """Pauses, or goes on after a pause."""
        paused = self._live.snapshot.state is State.PAUSED
        self._live.call("map/resume_from_paused" if paused else "map/pause")

    def _reset(self) -> None:
        """Drops the map; mapping goes on with an empty one."""
        snapshot = self._live.snapshot
        self._live.call("map/clear")
        if snapshot.state is not State.NOT_MAPPING:
            self._live.call("map/start", [snapshot.path])

    def _map(self) -> dict[str, Any]:
        grid = self._live.gallery.latest(self._live.snapshot.revision).grid
        stamp = self._middleware.stamp(self._middleware.now())
        return {"map": place_grid(self._middleware.grid(grid), grid, self._map_frame, stamp)}


def _check(call: str, path: str) -> None:
    """Makes the folder. Raises StateError or MapFileError for a path that nothing can be saved to."""
    if not path:
        raise StateError(f"{call}: a path must be given, such as /home/me/map")
    check_absolute(call, path)
    make_room(call, path)
