# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 1 node: topics and transforms around a live session."""

import threading
import time
from collections.abc import Callable

import rospy
import tf2_ros
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
from oort.node.diagnostics import diagnostic_array
from oort.node.health import look_over
from oort.node.laser import Laser
from oort.node.markers import graph_markers
from oort.node.messages import grid_message, transform
from oort.node.running import COMPLAIN, repeat
from oort.node.services import Services
from oort.node.transforms import Transforms, frame
from oort.recording import Pose
from oort.recording.limits import NO_LIMITS, ScanLimits

_TF_PERIOD = 0.05  # [s]
_QUEUE_PERIOD = 0.1  # [s]
_HEALTH_PERIOD = 1.0  # [s]


class Node(Listener):
    """Topics in, topics out. The callbacks of subscribers only put things into the session's queue."""

    def __init__(self, parameters: Parameters, event_log: EventLog | None, limits: ScanLimits = NO_LIMITS) -> None:
        """Advertises, subscribes, and offers the services; mapping begins with map/start."""
        self._map_frame, self._odom_frame = frame(parameters, "map"), frame(parameters, "odom")
        self._sensor_frame = frame(parameters, "sensor")
        self._last_tf = rospy.Time()
        self._tf_lock = threading.Lock()

        self._map = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        self._map_cleaned = rospy.Publisher("map_cleaned", OccupancyGrid, queue_size=1, latch=True)
        self._queue_size = rospy.Publisher("~queue_size", Int64, queue_size=10)
        self._file_changed = rospy.Publisher("~file_changed", String, queue_size=10)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self._broadcaster = tf2_ros.TransformBroadcaster()

        self._transforms = Transforms(parameters, self._poke)
        self._laser = Laser(self._transforms, bool(parameters.get("motion_compensation")), self._laser_found, limits)
        self.live = LiveSession(
            parameters, self, clock=rospy.get_time, localiser=self._sensor_on_map, event_log=event_log
        )
        self._graph = rospy.Publisher("~graph", MarkerArray, self._graph_wanted(), queue_size=1)
        self._services = Services(self.live, self._map_frame)
        self._listener = tf2_ros.TransformListener(self._transforms, tcp_nodelay=True)
        self._scans = rospy.Subscriber("scan", LaserScan, self._on_scan, tcp_nodelay=True)
        if parameters.get("use_imu"):
            rospy.Subscriber("imu", Imu, self._transforms.add_imu, tcp_nodelay=True)
        for period, work in (
            (_TF_PERIOD, self._tell_pose),
            (_QUEUE_PERIOD, self._tell_queue),
            (_HEALTH_PERIOD, self._tell_health),
        ):
            threading.Thread(target=repeat, args=(period, work), daemon=True).start()

    def close(self) -> None:
        """Saves the map."""
        self._scans.unregister()
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
        stamp = rospy.Time.now()
        self._map.publish(grid_message(drawing.grid, self._map_frame, stamp))
        self._map_cleaned.publish(grid_message(drawing.cleaned, self._map_frame, stamp))
        self._tell_graph()

    def saved(self, what: Saved) -> None:
        """Files were written."""
        self._file_changed.publish(NAMES[what])

    def note(self, text: str) -> None:
        """Something that its owner should know."""
        rospy.loginfo("%s", text)

    def trouble(self, text: str) -> None:
        """Something went wrong that no caller waits to hear of."""
        rospy.logwarn("%s", text)

    # ---- what goes out by itself ----

    def _tell_pose(self) -> None:
        """map -> odom, dated one period ahead, so that a look-up for now finds it until the next one."""
        with self._tf_lock:
            pose = self.live.snapshot.odom_pose
            stamp = rospy.Time.now() + rospy.Duration(_TF_PERIOD)
            if pose is None or stamp == self._last_tf:
                return  # where the clock stands, listeners complain of repeated data
            self._last_tf = stamp
            self._broadcaster.sendTransform(transform(self._map_frame, self._odom_frame, stamp, pose))

    def _tell_queue(self) -> None:
        self._queue_size.publish(len(self.live.inbox))

    def _tell_health(self) -> None:
        waiting, since = self.live.inbox.waiting()
        missing = self._transforms.missing(self._sensor_frame)
        if waiting and since > _HEALTH_PERIOD:
            rospy.logwarn_throttle(COMPLAIN, f"{missing}; {waiting} scans waiting")
        imu_trouble = self._transforms.imu_trouble()
        if imu_trouble:
            rospy.logwarn_throttle(COMPLAIN, f"odometry's own turns are used: {imu_trouble}")
        health = look_over(self.live, self._scans.resolved_name, missing, imu_trouble)
        self._diagnostics.publish(diagnostic_array(health, rospy.get_name(), rospy.Time.now()))

    # ---- the graph, for people to look at ----

    def _graph_wanted(self) -> rospy.SubscribeListener:
        """Only who looks at the graph costs its drawing, so that a late one is served when it comes."""
        listener = rospy.SubscribeListener()
        listener.peer_subscribe = self._on_graph_subscriber
        return listener

    def _on_graph_subscriber(
        self, _name: str, publish_to_peer: Callable[[MarkerArray], None], _publish: Callable[[MarkerArray], None]
    ) -> None:
        self._show_graph(publish_to_peer)

    def _tell_graph(self) -> None:
        if self._graph.get_num_connections() > 0:
            self._show_graph(self._graph.publish)

    def _show_graph(self, publish: Callable[[MarkerArray], None]) -> None:
        drawing = self.live.gallery.drawing
        if drawing is not None:
            places = [(space, id, pose) for (space, id), pose in self.live.snapshot.places.items()]
            publish(graph_markers(drawing.map, places, self._map_frame, rospy.Time.now()))
