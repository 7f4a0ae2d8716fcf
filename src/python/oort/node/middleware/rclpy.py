# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A node over ROS 2's rclpy: one thread for callbacks, and others for services, so that scans go on meanwhile."""

import sys
import threading
from array import array
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid as GridMessage
from rcl_interfaces.msg import SetParametersResult
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from tf2_msgs.msg import TFMessage

from oort._core import OccupancyGrid
from oort.node.logs import Forward, Seldom, log
from oort.node.middleware.base import Fields, Middleware, Publisher, Quality, Subscription
from oort.node.middleware.rclpy_services import Services

_QUEUE = 10  # messages to a subscriber that is slow
_SENSOR_QUEUE = 100  # scans or an IMU's messages, while Python is busy otherwise
_TRANSFORM_QUEUE = 100
_REMEMBERED = 200  # transforms that this node has sent: 10 s

_QUALITIES = {
    Quality.STREAM: QoSProfile(depth=_QUEUE),
    Quality.SENSOR: QoSProfile(depth=_SENSOR_QUEUE, reliability=ReliabilityPolicy.BEST_EFFORT),
    Quality.LATCHED: QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
}
_MOVING = QoSProfile(depth=_TRANSFORM_QUEUE)
_FIXED = QoSProfile(depth=_TRANSFORM_QUEUE, durability=DurabilityPolicy.TRANSIENT_LOCAL)

_OF_RCLPY = ("use_sim_time", "start_type_description_service")
_OF_RCLPY_GROUP = "qos_overrides."


class Rclpy(Middleware):
    """One node in rclpy's default context."""

    ros = 2

    def __init__(self, name: str) -> None:
        """Joins the ROS graph under this name, unless the command line gives another."""
        rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
        self.node = self._make_node(name)
        _forward_log(self.node)
        self._made: list[Callable[[], object]] = []  # what ends each thing that the node has made
        self._sent: deque[tuple[int, float, float, float]] = deque(maxlen=_REMEMBERED)
        self._broadcaster = self.node.create_publisher(TFMessage, "/tf", _MOVING)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self._services = Services(self.node, self._executor)
        self._spinning = threading.Thread(target=self._spin, name="rclpy", daemon=True)
        self._spinning.start()

    def _make_node(self, name: str) -> Node:
        return Node(name, automatically_declare_parameters_from_overrides=True)

    def _spin(self) -> None:
        with suppress(ExternalShutdownException):  # the node ends
            self._executor.spin()

    @property
    def name(self) -> str:
        """The node's full name."""
        return str(self.node.get_fully_qualified_name())

    def is_running(self) -> bool:
        """False from the moment at which the node is to end."""
        return bool(rclpy.ok()) and self._spinning.is_alive()

    def drop(self) -> None:
        """Ends all topics and services."""
        while self._made:
            self._made.pop()()

    def close(self) -> None:
        """Leaves the ROS graph."""
        self._services.close()
        rclpy.try_shutdown()
        self._spinning.join()  # a thread in rclpy's C++ when the process ends would abort it

    def resolve(self, topic: str) -> str:
        """A topic's full name after remapping."""
        return str(self.node.resolve_topic_name(_name(topic)))

    # ---- parameters ----

    def parameters(self) -> dict[str, Any]:
        """What the node was given."""
        given = self.node.get_parameters_by_prefix("")
        return {name: one.value for name, one in given.items() if not _is_of_rclpy(name)}

    def parameter_name(self, name: str) -> str:
        """As it stands in a params_file."""
        return name

    def show_parameters(self, values: Mapping[str, Any]) -> None:
        """Lets others read these, and refuses to change them as long as this lasts."""
        for name, value in values.items():
            if not self.node.has_parameter(name):
                self.node.declare_parameter(name, value)
        self.node.add_on_set_parameters_callback(_refuse)
        self._made.append(lambda: self.node.remove_on_set_parameters_callback(_refuse))

    # ---- time ----

    def now(self) -> int:
        """[ns]; 0 as long as a simulated clock is not known."""
        return int(self.node.get_clock().now().nanoseconds)

    def stamp(self, nanoseconds: int) -> Time:
        """A time as messages carry it."""
        seconds, rest = divmod(nanoseconds, 1_000_000_000)
        return Time(sec=seconds, nanosec=rest)

    # ---- topics and services ----

    def publisher(
        self,
        topic: str,
        kind: Any,
        quality: Quality,
        on_subscriber: Callable[[Callable[[Any], None]], None] | None = None,
    ) -> Publisher:
        """``on_subscriber`` is given, whenever somebody begins to listen, what sends a message.

        All get it then: ROS 2 cannot send to one alone, and latches it until that one is ready to hear.
        """
        if on_subscriber is None:
            return self._published(self.node.create_publisher(kind, _name(topic), _QUALITIES[quality]))
        tell = _shielded(on_subscriber)

        def matched(change: Any) -> None:
            if change.current_count_change > 0:
                tell(made.publish)

        events = PublisherEventCallbacks(matched=matched)
        made: Any = self.node.create_publisher(kind, _name(topic), _QUALITIES[Quality.LATCHED], event_callbacks=events)
        return self._published(made)

    def _published(self, made: Any) -> Publisher:
        self._made.append(lambda: self.node.destroy_publisher(made))
        return _Publisher(made)

    def subscribe(self, topic: str, kind: Any, quality: Quality, take: Callable[[Any], None]) -> Subscription:
        """Each message to ``take``, in the order in which they come."""
        made = self.node.create_subscription(kind, _name(topic), _shielded(take), _QUALITIES[quality])
        self._made.append(lambda: self.node.destroy_subscription(made))
        return _Subscription(self.node, made)

    def subscribe_transforms(self, moving: Callable[[Any, str], None], fixed: Callable[[Any, str], None]) -> None:
        """Each TransformStamped of tf; ROS 2 does not tell who sent it, so that only this node's own are known."""

        def each(take: Callable[[Any, str], None]) -> Callable[[TFMessage], None]:
            def take_each(message: TFMessage) -> None:
                for transform in message.transforms:
                    take(transform, self.name if _print(transform) in self._sent else "")

            return _shielded(take_each)

        for topic, take, quality in (("/tf", moving, _MOVING), ("/tf_static", fixed, _FIXED)):
            made = self.node.create_subscription(TFMessage, topic, each(take), quality)
            self._made.append(partial(self.node.destroy_subscription, made))

    def send_transform(self, transform: Any) -> None:
        """To tf."""
        self._sent.append(_print(transform))
        self._broadcaster.publish(TFMessage(transforms=[transform]))

    def serve(self, name: str, kind: str, handle: Callable[[Any], Fields | None]) -> None:
        """Offers a service of oort_msgs, or std_srvs/Trigger for Empty: ROS 2's services cannot fail otherwise."""
        self._made.append(self._services.offer(_name(name), kind, handle))

    def grid(self, grid: OccupancyGrid) -> GridMessage:
        """A nav_msgs/OccupancyGrid with the cells of a map and nothing else; any other sequence takes a hundred ms."""
        return GridMessage(data=array("b", grid.cells.tobytes()))


class _Publisher:
    def __init__(self, publisher: Any) -> None:
        self.publish: Callable[[Any], None] = publisher.publish
        self._subscribers: Callable[[], int] = publisher.get_subscription_count

    def is_wanted(self) -> bool:
        return self._subscribers() > 0


class _Subscription:
    def __init__(self, node: Node, subscription: Any) -> None:
        self._node = node
        self._subscription = subscription
        self.topic = str(subscription.topic_name)

    def close(self) -> None:
        self._node.destroy_subscription(self._subscription)


def _name(name: str) -> str:
    """Private names begin with ~/ in ROS 2."""
    return f"~/{name[1:]}" if name.startswith("~") else name


def _is_of_rclpy(name: str) -> bool:
    return name in _OF_RCLPY or name.startswith(_OF_RCLPY_GROUP)


def _refuse(changes: list[Parameter]) -> SetParametersResult:
    ours = [change.name for change in changes if not _is_of_rclpy(change.name)]
    reason = f"{', '.join(ours)}: Oort reads its parameters when it starts; set it there and start the node again"
    return SetParametersResult(successful=not ours, reason=reason if ours else "")


def _print(transform: TransformStamped) -> tuple[int, float, float, float]:
    """By which a transform is known again when it comes back."""
    stamp, to = transform.header.stamp, transform.transform
    return stamp.sec * 1_000_000_000 + stamp.nanosec, to.translation.x, to.translation.y, to.rotation.z


def _shielded(take: Callable[[Any], None]) -> Callable[[Any], None]:
    """Whatever is wrong with one message, the others go on: rclpy would end the node."""
    complain = Seldom(say=log.error)

    def shielded(message: Any) -> None:
        try:
            take(message)
        except Exception as error:
            complain(f"a message was left out: {error!r}")

    return shielded


def _forward_log(node: Node) -> None:
    """rclpy knows a place in the source by its first severity, so that each has a line of its own."""
    logger = node.get_logger()

    def info(text: str) -> None:
        logger.info(text)

    def warning(text: str) -> None:
        logger.warning(text)

    def error(text: str) -> None:
        logger.error(text)

    def fatal(text: str) -> None:
        logger.fatal(text)

    Forward({"INFO": info, "WARNING": warning, "ERROR": error, "CRITICAL": fatal}).install()
