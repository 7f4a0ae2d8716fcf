# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The mapping node: topics and transforms around a live session."""

import threading
import time
from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import Imu, LaserScan
from std_msgs.msg import Int64, String
from visualization_msgs.msg import MarkerArray

from oort._core import Parameters, Saved
from oort.events import EventLog
from oort.live import Drawing, Listener, LiveSession, Snapshot
from oort.live.inbox import Resolve
from oort.live.saver import NAMES
from oort.node.conventions import MappingConventions
from oort.node.diagnostics import diagnostic_array
from oort.node.health import look_over
from oort.node.laser import Laser
from oort.node.logs import Seldom, log
from oort.node.markers import graph_markers
from oort.node.messages import place_grid, transform
from oort.node.middleware import Middleware, Quality
from oort.node.running import repeat
from oort.node.services import Services
from oort.node.settings import ViewSettings
from oort.node.transforms import Transforms, frame
from oort.recording import Pose
from oort.recording.limits import NO_LIMITS, ScanLimits
from oort.view import Viewer

_TF_PERIOD = 0.05  # [s]
_QUEUE_PERIOD = 0.1  # [s]
_HEALTH_PERIOD = 1.0  # [s]


class Node(Listener):
    """Topics in, topics out. The callbacks of subscribers only put things into the session's queue."""

    def __init__(
        self,
        middleware: Middleware,
        parameters: Parameters,
        event_log: EventLog | None,
        limits: ScanLimits = NO_LIMITS,
    ) -> None:
        """Advertises, subscribes, and offers the services; mapping begins with map/start."""
        self._middleware = middleware
        self._map_frame, self._odom_frame = frame(parameters, "map"), frame(parameters, "odom")
        self._base_frame, self._sensor_frame = frame(parameters, "base"), frame(parameters, "sensor")
        self._view: Viewer | None = None
        self._last_tf = 0  # [ns]
        self._tf_lock = threading.Lock()

        self._map = middleware.publisher("map", OccupancyGrid, Quality.LATCHED)
        self._map_cleaned = middleware.publisher("map_cleaned", OccupancyGrid, Quality.LATCHED)
        self._queue_size = middleware.publisher("~queue_size", Int64, Quality.STREAM)
        self._file_changed = middleware.publisher("~file_changed", String, Quality.STREAM)
        self._diagnostics = middleware.publisher("/diagnostics", DiagnosticArray, Quality.STREAM)

        self._say_waiting, self._say_imu = Seldom(), Seldom()
        self._transforms = Transforms(parameters, self._poke, middleware)
        self._laser = Laser(self._transforms, bool(parameters.get("motion_compensation")), self._laser_found, limits)
        self.live = LiveSession(
            parameters,
            self,
            clock=lambda: middleware.now() / 1e9,
            localiser=self._sensor_on_map,
            event_log=event_log,
        )
        # Only who looks at the graph costs its drawing, so that a late one is served when it comes.
        self._graph = middleware.publisher("~graph", MarkerArray, Quality.STREAM, on_subscriber=self._show_graph)
        self._services = Services(self.live, middleware, self._map_frame)
        self._conventions = MappingConventions(self.live, middleware, self._map_frame) if middleware.ros == 2 else None
        middleware.subscribe_transforms(self._transforms.set_transform, self._transforms.set_transform_static)
        self._scans = middleware.subscribe("scan", LaserScan, Quality.SENSOR, self._on_scan)
        if parameters.get("use_imu"):
            middleware.subscribe("imu", Imu, Quality.SENSOR, self._transforms.add_imu)
        for period, work in (
            (_TF_PERIOD, self._tell_pose),
            (_QUEUE_PERIOD, self._tell_queue),
            (_HEALTH_PERIOD, self._tell_health),
        ):
            threading.Thread(target=repeat, args=(middleware.is_running, period, work), daemon=True).start()

    def show_view(self, settings: ViewSettings) -> None:
        """Serves the live view until the node ends. Raises OortError if it cannot be served."""
        name = self._middleware.name
        self._view = Viewer(
            self.live, title=name, address=settings.address, port=settings.port, control=settings.control
        )
        log.info("%s is shown at %s", name, self._view.url)

    def close(self) -> None:
        """Saves the map."""
        if self._view is not None:
            self._view.close()
        self._scans.close()
        self.live.close()

    # ---- what comes in ----

    def _on_scan(self, message: LaserScan) -> None:
        self.live.add_scan(*self._resolve(message, time.monotonic()))

    def _resolve(self, message: LaserScan, arrived: float) -> tuple[Resolve, Resolve]:
        sensor_frame = message.header.frame_id.lstrip("/") or self._sensor_frame
        self._sensor_frame = self._laser.awaited(sensor_frame, self._sensor_frame)
        return self._laser.resolve_later(message, sensor_frame, arrived)

    def _laser_found(self, sensor_frame: str, mount: Pose) -> None:
        self.live.mount_sensor(mount)
        self._sensor_frame = sensor_frame

    def _poke(self) -> None:
        self.live.inbox.poke()

    def _sensor_on_map(self) -> Pose | None:
        return self._transforms.sensor_on_map(self._sensor_frame)

    # ---- what the session tells ----

    def scan_taken(self, snapshot: Snapshot) -> None:
        """A scan was mapped: the new map -> odom goes out at once."""
        self._tell_pose()
        if self._conventions is not None:
            self._conventions.scan_taken()

    def call_made(self, snapshot: Snapshot) -> None:
        """A call took effect: when its caller hears of it, no pose of before is still on its way out."""
        self._tell_pose()

    def places_changed(self, snapshot: Snapshot) -> None:
        """Places came, went or moved, and nothing else of the map changed."""
        self._tell_graph()

    def drawn(self, drawing: Drawing) -> None:
        """The map was drawn, or is to be shown again."""
        if drawing.grid.cells.size == 0:
            return
        stamp = self._middleware.stamp(self._middleware.now())
        for publisher, grid in ((self._map, drawing.grid), (self._map_cleaned, drawing.cleaned)):
            publisher.publish(place_grid(self._middleware.grid(grid), grid, self._map_frame, stamp))
        if self._conventions is not None:
            self._conventions.drawn(drawing)
        self._tell_graph()

    def saved(self, what: Saved) -> None:
        """Files were written."""
        self._file_changed.publish(String(data=NAMES[what]))

    def note(self, text: str) -> None:
        """Something that its owner should know."""
        log.info("%s", text)

    def trouble(self, text: str) -> None:
        """Something went wrong that no caller waits to hear of."""
        log.warning("%s", text)

    # ---- what goes out by itself ----

    def _tell_pose(self) -> None:
        """map -> odom, dated one period ahead, so that a look-up for now finds it until the next one.

        And odom -> base, where no odometry is used and so nobody else tells it.
        """
        with self._tf_lock:
            pose, made = self.live.snapshot.odom_pose, self.live.snapshot.made_odometry
            now = self._middleware.now() + round(1e9 * _TF_PERIOD)
            if pose is None or now == self._last_tf:
                return  # where the clock stands, listeners complain of repeated data
            self._last_tf = now
            stamp = self._middleware.stamp(now)
            if made is not None:
                self._middleware.send_transform(transform(self._odom_frame, self._base_frame, stamp, made))
            self._middleware.send_transform(transform(self._map_frame, self._odom_frame, stamp, pose))

    def _tell_queue(self) -> None:
        self._queue_size.publish(Int64(data=len(self.live.inbox)))

    def _tell_health(self) -> None:
        waiting, since = self.live.inbox.waiting()
        missing = self._transforms.missing(self._sensor_frame)
        if waiting and since > _HEALTH_PERIOD:
            self._say_waiting(f"{missing}; {waiting} scans waiting")
        imu_trouble = self._transforms.imu_trouble()
        if imu_trouble:
            self._say_imu(f"odometry's own turns are used: {imu_trouble}")
        health = look_over(self.live, self._scans.topic, missing, imu_trouble)
        stamp = self._middleware.stamp(self._middleware.now())
        self._diagnostics.publish(diagnostic_array(health, self._middleware.name, stamp))

    # ---- the graph, for people to look at ----

    def _tell_graph(self) -> None:
        if self._graph.is_wanted():
            self._show_graph(self._graph.publish)

    def _show_graph(self, publish: Callable[[Any], None]) -> None:
        drawing = self.live.gallery.drawing
        if drawing is not None:
            places = [(space, id, pose) for (space, id), pose in self.live.snapshot.places.items()]
            stamp = self._middleware.stamp(self._middleware.now())
            publish(graph_markers(drawing.map, places, self._map_frame, stamp))
