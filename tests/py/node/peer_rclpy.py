# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A peer over ROS 2."""

import os
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import rclpy
from builtin_interfaces.msg import Time
from oort_msgs import srv
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import Trigger

from node.peer import Peer, Reply, until

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_STREAM = QoSProfile(depth=10_000)


class RclpyPeer(Peer):
    """Its process is the node /oort_tests, in a domain of this process's own."""

    def __init__(self, folder: Path, domain: int) -> None:
        """``folder`` takes the logs of all programs."""
        own = {
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_LOG_DIR": str(folder),
            "ROS_PYTHON_CHECK_FIELDS": "1",
            "PYTHONUNBUFFERED": "1",
            "AMENT_PREFIX_PATH": os.environ.get("AMENT_PREFIX_PATH", sys.prefix),  # where ROS 2 comes from wheels
        }
        os.environ.update(own)
        self.environment = dict(os.environ)
        self._opened: list[Any] = []
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        self.node = rclpy.create_node("oort_tests")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return

    def close(self) -> None:
        """Leaves."""
        rclpy.try_shutdown()
        self._thread.join()

    def now(self) -> Any:
        """A stamp for messages."""
        return self.node.get_clock().now().to_msg()

    def stamp(self, seconds: float) -> Any:
        """The same of any time."""
        whole, nanoseconds = divmod(round(seconds * 1e9), 1_000_000_000)
        return Time(sec=whole, nanosec=nanoseconds)

    def seconds(self, stamp: Any) -> float:
        """Back."""
        return float(stamp.sec + stamp.nanosec / 1e9)

    def publisher(
        self, topic: str, kind: Any, *, latched: bool = False, reliable: bool = False
    ) -> Callable[[Any], None]:
        """Publishes on a topic, once somebody listens; a scan as sensors do, unless it must not be lost."""
        as_sensors = kind in (Imu, LaserScan) and not reliable
        quality = _LATCHED if latched else qos_profile_sensor_data if as_sensors else _STREAM
        publisher = self.node.create_publisher(kind, topic, quality)
        self._opened.append((self.node.destroy_publisher, publisher))
        until(lambda: latched or publisher.get_subscription_count() > 0, f"somebody listens to {topic}")
        publish: Callable[[Any], None] = publisher.publish
        return publish

    def hear(self, topic: str, kind: Any, *, latched: bool = False) -> list[Any]:
        """All that is said on a topic from here on."""
        heard: list[Any] = []
        subscription = self.node.create_subscription(kind, topic, heard.append, _LATCHED if latched else _STREAM)
        self._opened.append((self.node.destroy_subscription, subscription))
        until(lambda: self.node.count_publishers(topic) > 0, f"somebody publishes {topic}")
        time.sleep(0.1)  # discovery is not done on both sides at once
        return heard

    def forget(self) -> None:
        """Ends all publishers and subscribers."""
        for destroy, one in self._opened:
            destroy(one)
        self._opened.clear()

    def call(self, service: str, kind: str, **fields: Any) -> Reply:
        """Calls a service of oort_msgs, or one that takes nothing."""
        type_ = Trigger if kind == "Empty" else getattr(srv, kind)
        response = self.call_type(service, type_, **fields)
        return Reply(response.success, response.message, response)

    def call_type(self, service: str, type_: Any, **fields: Any) -> Any:
        """Calls any service."""
        client = self.node.create_client(type_, service)
        try:
            assert client.wait_for_service(15.0), f"no service {service}"
            future = client.call_async(type_.Request(**fields))
            until(future.done, f"{service} answers", 60.0)
            return future.result()
        finally:
            self.node.destroy_client(client)

    def arguments(self, name: str, parameters: Mapping[str, Any], remappings: Mapping[str, str]) -> list[str]:
        """As `ros2 run` takes them."""
        given = [word for key, value in parameters.items() for word in ("-p", f"{key}:={_yaml(value)}")]
        renamed = [word for old, new in remappings.items() for word in ("-r", f"{old}:={new}")]
        return ["--ros-args", "-r", f"__node:={name}", *given, *renamed]


def _yaml(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
