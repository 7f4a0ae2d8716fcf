# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The localiser's node: tells where the robot is on a saved map while nothing is being mapped."""

import threading
import time
from concurrent.futures import Future
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from numpy.typing import NDArray
from sensor_msgs.msg import Imu, LaserScan
from std_msgs.msg import String

from oort._core import LocalizationState, Map, Parameters, normalise_map_path, render_map
from oort.errors import InputError, StateError
from oort.image_maps import open_reference_map
from oort.live.figures import Figures
from oort.live.inbox import UNUSABLE, Answer, CallItem, Inbox, ScanItem
from oort.live.snapshot import odom_pose_of
from oort.localization import Localizer, ReferenceMap, start_covariance, start_pose
from oort.node.diagnostics import diagnostic_array, health_of_input
from oort.node.laser import Laser
from oort.node.last_pose import LastPose
from oort.node.localizer_health import LocalizerHealth, Sighting
from oort.node.logs import log
from oort.node.messages import nanoseconds, place_grid, pose_with_covariance, transform, yaw
from oort.node.middleware import Middleware, Quality
from oort.node.running import repeat
from oort.node.transforms import Transforms, frame
from oort.poses import between, compose
from oort.recording import Pose, Scan
from oort.recording.limits import NO_LIMITS, ScanLimits

_TF_PERIOD = 0.05  # [s]
_HEALTH_PERIOD = 1.0  # [s]
_IDLE = 0.2  # [s] between looks at whether the node is to end
_SAVE_PERIOD = 10.0  # [s] between savings of the pose
STARTS = ("auto", "global", "dock", "last")
"""How it may be told to begin."""


class LocalizerNode:
    """Scans, odometry and starting poses in; map -> odom, the pose and the map out.

    One thread works through scans and calls in the order in which they came. map -> odom is left to others as long as
    another program, such as Oort's mapping, publishes it.
    """

    def __init__(
        self,
        middleware: Middleware,
        parameters: Parameters,
        base: str,
        start: str,
        limits: ScanLimits = NO_LIMITS,
    ) -> None:
        """Loads the map, advertises and subscribes. Raises OortError if the map or the start cannot be used."""
        self._middleware = middleware
        self._parameters = parameters
        self._map_frame, self._odom_frame = frame(parameters, "map"), frame(parameters, "odom")
        self._sensor_frame = frame(parameters, "sensor")
        self._last_tf = 0  # [ns]
        self._tf_lock = threading.Lock()
        self._closing, self._active = False, True
        self._saved = time.monotonic()
        self._mount: Pose | None = None
        self._seed: tuple[Pose, NDArray[np.float64]] | None = None  # T_map_sensor, until the laser's mount is known
        self._localizer: Localizer | None = None
        self._last = Sighting()
        self._figures = Figures()
        self._load(base)

        self._maps = [middleware.publisher(topic, OccupancyGrid, Quality.LATCHED) for topic in _MAPS]
        self._poses = [middleware.publisher("~pose", PoseWithCovarianceStamped, Quality.STREAM)]
        self._state = middleware.publisher("~state", String, Quality.LATCHED)
        self._diagnostics = middleware.publisher("/diagnostics", DiagnosticArray, Quality.STREAM)
        self._inbox = Inbox()
        self._transforms = Transforms(parameters, self._inbox.poke, middleware)
        compensates = bool(parameters.get("motion_compensation"))
        self._laser = Laser(self._transforms, compensates, self._laser_found, limits)
        middleware.subscribe_transforms(self._transforms.set_transform, self._transforms.set_transform_static)
        self._begin(start)
        self._show_map()
        self._scans = middleware.subscribe("scan", LaserScan, Quality.SENSOR, self._on_scan)
        if parameters.get("use_imu"):
            middleware.subscribe("imu", Imu, Quality.SENSOR, self._transforms.add_imu)
        middleware.subscribe("initialpose", PoseWithCovarianceStamped, Quality.STREAM, self._on_initial_pose)
        self._worker = threading.Thread(target=self._work, name="oort-localize", daemon=True)
        self._worker.start()
        for period, work in ((_TF_PERIOD, self._tell_tf), (_HEALTH_PERIOD, self._tell_health)):
            threading.Thread(target=repeat, args=(self._is_running, period, work), daemon=True).start()
        middleware.serve("~map/load", "SetString", lambda request: self._call("load", request.data))
        middleware.serve("~relocalize", "Empty", lambda _: self._call("relocalize"))
        middleware.serve("~is_localized", "GetBool", lambda _: {"data": self._last.state == LocalizationState.TRACKING})
        if middleware.ros == 2:
            self._offer_conventions()

    def _offer_conventions(self) -> None:
        """What users of amcl and of nav2's map_server know."""
        serve = self._middleware.serve
        self._poses.append(self._middleware.publisher("amcl_pose", PoseWithCovarianceStamped, Quality.LATCHED))
        serve("~load_map", "SetString", lambda request: self._call("load", request.data))
        serve("reinitialize_global_localization", "ClassicEmpty", lambda _: self._call("relocalize"))
        serve("set_initial_pose", "SetPose", lambda request: self._set_pose(request.pose))

    def close(self) -> None:
        """Saves the pose and ends the thread."""
        self._scans.close()
        self._closing = True
        self._inbox.wake()
        self._worker.join()
        self._inbox.close(StateError("the localiser is being shut down"))
        self._save_pose()

    def set_active(self, active: bool) -> None:
        """While it is not active it hears no scans and tells no pose."""
        self._active = active

    # ---- the map and the start ----

    def _load(self, base: str) -> None:
        map_ = open_reference_map(base)
        self._reference = ReferenceMap(map_, self._parameters)
        self._map: Map = map_
        self._base = normalise_map_path(base)
        self._last_pose = LastPose(self._base)
        self._localizer = None
        self._last = Sighting()

    def _show_map(self) -> None:
        stamp = self._middleware.stamp(self._middleware.now())
        for publisher, grid in zip(self._maps, render_map(self._map, self._parameters), strict=True):
            if grid.cells.size:
                publisher.publish(place_grid(self._middleware.grid(grid), grid, self._map_frame, stamp))

    def _begin(self, start: str) -> None:
        """Seeds the localiser. ``auto`` takes the last pose if there is one; what does not fit is searched for."""
        self._seed = None
        if start == "dock":
            self._seed = start_pose(self._map, self._parameters, "dock"), start_covariance()
        elif start in ("auto", "last"):
            pose = self._last_pose.read()
            if pose is None and start == "last":
                raise InputError(f"{self._last_pose.path}: there is no last pose; start another way")
            self._seed = None if pose is None else (pose, start_covariance())

    def _save_pose(self) -> None:
        """Keeps the pose for the next start, if it can be relied on."""
        if self._last.state == LocalizationState.TRACKING and self._last.T_map_sensor is not None:
            self._last_pose.write(self._last.T_map_sensor)

    # ---- what comes in ----

    def _on_scan(self, message: LaserScan) -> None:
        if not self._active:
            return
        sensor_frame = message.header.frame_id.lstrip("/") or self._sensor_frame
        self._sensor_frame = self._laser.awaited(sensor_frame, self._sensor_frame)
        self._figures.arrived()
        self._inbox.add_scan(*self._laser.resolve_later(message, sensor_frame, time.monotonic()))

    def _laser_found(self, frame: str, mount: Pose) -> None:
        self._mount, self._sensor_frame = mount, frame

    def _on_initial_pose(self, message: PoseWithCovarianceStamped) -> None:
        """T_map_base from a person: RViz's "2D Pose Estimate"."""
        try:
            self._start_at(message)
        except InputError as error:
            log.warning("initialpose: %s; left out", error)

    def _set_pose(self, message: PoseWithCovarianceStamped) -> None:
        self._start_at(message).result()

    def _start_at(self, message: PoseWithCovarianceStamped) -> "Future[Answer]":
        """Follows the robot from there, when the working thread comes to it. Raises InputError for a wrong frame."""
        told = message.header.frame_id.lstrip("/")
        if told and told != self._map_frame:
            raise InputError(f"it is in frame {told}, not in {self._map_frame}")
        position, full = message.pose.pose.position, np.reshape(message.pose.covariance, (6, 6))
        pose = position.x, position.y, yaw(message.pose.pose.orientation)
        covariance = full[np.ix_([0, 1, 5], [0, 1, 5])]
        if not np.isfinite(covariance).all() or np.linalg.eigvalsh(covariance)[0] <= 0.0:
            covariance = start_covariance(0.5, 0.3)
        return self._inbox.add_call("start_at", [pose, covariance])

    def _call(self, name: str, *args: Any) -> None:
        """Returns when the working thread has done it."""
        self._inbox.add_call(name, args).result()

    # ---- the working thread ----

    def _is_running(self) -> bool:
        return not self._closing and self._middleware.is_running()

    def _work(self) -> None:
        while not self._closing:
            item = self._inbox.head(True, _IDLE)
            if item is None:
                continue
            try:
                self._take(item) if isinstance(item, ScanItem) else self._make(item)
            except Exception as error:  # whatever is wrong with one, the others go on
                self._leave_out(UNUSABLE, str(error) or repr(error))
            self._inbox.pop()
            if time.monotonic() > self._saved + _SAVE_PERIOD:
                self._saved = time.monotonic()
                self._save_pose()

    def _take(self, item: ScanItem) -> None:
        if item.scan is None:
            self._leave_out(item.refused, item.why)
            return
        started = time.monotonic()
        scan, mount = item.scan, self._mount
        assert mount is not None  # what resolved the scan has set it
        localizer = self._localizer_at(mount)
        if scan.mount is not None:
            localizer.add_scan_of_other(scan, scan.odometry, scan.mount)
            return
        localizer.add_scan(scan, scan.odometry)
        self._see(Sighting.of(localizer, scan.reported_frame))
        self._figures.mapped(None, time.monotonic() - started)
        self._tell(scan, mount)
        self._figures.delays.add(1e3 * (time.monotonic() - item.arrived))

    def _localizer_at(self, mount: Pose) -> Localizer:
        """The localiser, begun where it is to begin; ``mount`` is T_base_sensor."""
        if self._localizer is None:
            self._localizer = Localizer(self._reference, self._parameters, mount)
        if self._seed is not None:
            seed, self._seed = self._seed, None
            self._localizer.start_at(*seed)
        return self._localizer

    def _see(self, sighting: Sighting) -> None:
        """From here on this is told; what was told before is no more on its way out."""
        with self._tf_lock:
            before, self._last = self._last.state, sighting
        if sighting.state != before:
            log.info("%s (support %.2f)", sighting.state, sighting.support)
            self._state.publish(String(data=sighting.state))

    def _leave_out(self, reason: str, why: str) -> None:
        told = self._figures.drops.add(reason, why)
        if told:
            log.warning("%s", told)

    def _make(self, item: CallItem) -> None:
        try:
            if item.name == "load":
                self._load(item.args[0])
                self._begin("auto")
                self._show_map()
            elif item.name == "relocalize":
                self._seed = None
                if self._localizer is not None:
                    self._localizer.start_searching()
            else:
                base, covariance = item.args
                self._seed = self._sensor_at(base), covariance
            if self._mount is not None:
                self._see(Sighting.of(self._localizer_at(self._mount)))  # the pose of before holds no more
        except Exception as error:  # the caller's
            if item.name == "start_at":
                log.warning("%s", error)  # a topic has no caller who hears of it
            item.result.set_exception(error)
            return
        item.result.set_result(None)  # type: ignore[arg-type]

    def _sensor_at(self, T_map_base: Pose) -> Pose:  # noqa: N803
        if self._mount is None:
            raise StateError("initialpose: no scan has come yet, so the sensor's place on the base is not known")
        x, y, theta = compose(T_map_base, self._mount).tolist()
        return x, y, theta

    # ---- what goes out ----

    def _tell(self, scan: Scan, mount: Pose) -> None:
        last = self._last
        if last.T_map_odom is None or last.covariance is None:
            return
        self._tell_tf()
        x, y, theta = compose(last.T_map_odom, scan.odometry).tolist()
        covariance = _of_base(last.covariance, theta, mount)
        stamp = self._middleware.stamp(nanoseconds(scan.stamp))
        message = pose_with_covariance((x, y, theta), covariance, self._map_frame, stamp)
        for publisher in self._poses:
            publisher.publish(message)

    def _tell_tf(self) -> None:
        """map -> odom, dated one period ahead; nothing while lost, or while another program tells it."""
        with self._tf_lock:
            last = self._last
            pose = None if last.state == LocalizationState.LOST else last.T_map_odom
            stamp = self._middleware.now() + round(1e9 * _TF_PERIOD)
            silent = not self._active or self._transforms.is_localised()
            if pose is None or stamp == self._last_tf or silent:
                return
            self._last_tf = stamp
            pose = odom_pose_of(pose, last.reported_frame)
            stamped = transform(self._map_frame, self._odom_frame, self._middleware.stamp(stamp), pose)
            self._middleware.send_transform(stamped)

    def _tell_health(self) -> None:
        health = LocalizerHealth(
            **health_of_input(self._figures, self._inbox),
            scan_topic=self._scans.topic,
            waiting_for=self._transforms.missing(self._sensor_frame),
            imu_trouble=self._transforms.imu_trouble(),
            map_path=self._base,
            last=self._last,
            told_by_other=self._transforms.is_localised(),
        )
        stamp = self._middleware.stamp(self._middleware.now())
        self._diagnostics.publish(diagnostic_array(health, self._middleware.name, stamp))


_MAPS = ("map", "map_cleaned")


def _of_base(covariance: NDArray[np.float64], theta: float, mount: Pose) -> NDArray[np.float64]:
    """The base's covariance from the sensor's, both along the map's axes; ``theta`` is the base's heading."""
    to_base = between(mount, np.zeros(3))  # T_sensor_base
    offset = compose([0.0, 0.0, theta + mount[2]], to_base)[:2]  # from the sensor to the base, along the map's axes
    jacobian = np.eye(3)
    jacobian[:2, 2] = -offset[1], offset[0]
    return np.asarray(jacobian @ covariance @ jacobian.T)
