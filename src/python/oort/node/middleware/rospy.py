# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A node over ROS 1's rospy."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import genpy
import rospy
from oort_msgs import srv
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from oort._core import OccupancyGrid
from oort.errors import OortError
from oort.node.logs import Forward, log
from oort.node.middleware.base import Fields, Middleware, Publisher, Quality, Subscription
from oort.node.middleware.rospy_messages import FastGrid, FastMapResponse

_QUEUE = 10  # messages to a subscriber that is slow
_TRANSFORM_QUEUE = 100


class Rospy(Middleware):
    """There is one node in a process, as rospy has it."""

    ros = 1

    def __init__(self, name: str) -> None:
        """Joins the ROS graph under this name, unless the command line gives another."""
        rospy.init_node(name, disable_signals=True)
        Forward(
            {"INFO": _info, "WARNING": _warning, "ERROR": _error, "CRITICAL": _fatal},
        ).install()
        self._broadcaster = rospy.Publisher("/tf", TFMessage, queue_size=_TRANSFORM_QUEUE)

    @property
    def name(self) -> str:
        """The node's full name."""
        return str(rospy.get_name())

    def is_running(self) -> bool:
        """False from the moment at which the node is to end."""
        return not rospy.core.is_shutdown_requested()  # topics are closed before rospy.is_shutdown() says so

    def close(self) -> None:
        """Leaves the ROS graph."""
        rospy.signal_shutdown("the node ends")

    def resolve(self, topic: str) -> str:
        """A topic's full name after remapping."""
        return str(rospy.resolve_name(topic))

    # ---- parameters ----

    def parameters(self) -> dict[str, Any]:
        """The private parameters."""
        return dict(_flatten(rospy.get_param("~", {})))

    def parameter_name(self, name: str) -> str:
        """A private name."""
        return "~" + name.replace(".", "/")

    def show_parameters(self, values: Mapping[str, Any]) -> None:
        """Nothing: the master keeps the parameters."""

    # ---- time ----

    def now(self) -> int:
        """[ns]."""
        return int(rospy.Time.now().to_nsec())

    def stamp(self, nanoseconds: int) -> genpy.Time:
        """A time as messages carry it."""
        return rospy.Time(*divmod(nanoseconds, 1_000_000_000))

    # ---- topics and services ----

    def publisher(
        self,
        topic: str,
        kind: Any,
        quality: Quality,
        on_subscriber: Callable[[Callable[[Any], None]], None] | None = None,
    ) -> Publisher:
        """``on_subscriber`` is given, whenever somebody begins to listen, what sends that one a message."""
        latched = quality is Quality.LATCHED
        listener = None
        if on_subscriber is not None:
            listener = rospy.SubscribeListener()
            listener.peer_subscribe = lambda _name, to_peer, _to_all: on_subscriber(to_peer)
        return _Publisher(rospy.Publisher(topic, kind, listener, latch=latched, queue_size=1 if latched else _QUEUE))

    def subscribe(self, topic: str, kind: Any, quality: Quality, take: Callable[[Any], None]) -> Subscription:
        """Each message to ``take``, in the order in which they come."""
        return _Subscription(rospy.Subscriber(topic, kind, take, tcp_nodelay=True))

    def subscribe_transforms(self, moving: Callable[[Any, str], None], fixed: Callable[[Any, str], None]) -> None:
        """Each TransformStamped of tf with the name of the node that sent it."""

        def each(message: TFMessage, take: Callable[[Any, str], None]) -> None:
            sender = message._connection_header.get("callerid", "")
            for transform in message.transforms:
                take(transform, sender)

        for topic, take in (("/tf", moving), ("/tf_static", fixed)):
            rospy.Subscriber(topic, TFMessage, each, take, tcp_nodelay=True)

    def send_transform(self, transform: Any) -> None:
        """To tf."""
        self._broadcaster.publish(TFMessage([transform]))

    def serve(self, name: str, kind: str, handle: Callable[[Any], Fields | None]) -> None:
        """Offers a service of oort_msgs, or Empty; an OortError of ``handle`` is what the caller is told."""
        service = Empty if kind == "Empty" else getattr(srv, kind)
        response = FastMapResponse if kind == "GetMap" else service._response_class
        known = response.__slots__

        def answer(request: Any) -> Any:
            try:
                fields = handle(request) or {}
            except OortError as error:
                log.warning("%s", error)
                raise rospy.ServiceException(str(error)) from error
            return response(**{field: value for field, value in fields.items() if field in known})

        rospy.Service(name, service, answer)

    def grid(self, grid: OccupancyGrid) -> FastGrid:
        """A nav_msgs/OccupancyGrid with the cells of a map and nothing else."""
        return FastGrid(data=grid.cells.reshape(-1))


class _Publisher:
    def __init__(self, publisher: rospy.Publisher) -> None:
        self.publish: Callable[[Any], None] = publisher.publish
        self._connections: Callable[[], int] = publisher.get_num_connections

    def is_wanted(self) -> bool:
        return self._connections() > 0


class _Subscription:
    def __init__(self, subscriber: rospy.Subscriber) -> None:
        self._subscriber = subscriber

    @property
    def topic(self) -> str:
        return str(self._subscriber.resolved_name)

    def close(self) -> None:
        self._subscriber.unregister()


def _flatten(tree: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in tree.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _info(text: str) -> None:
    rospy.loginfo("%s", text)


def _warning(text: str) -> None:
    rospy.logwarn("%s", text)


def _error(text: str) -> None:
    rospy.logerr("%s", text)


def _fatal(text: str) -> None:
    rospy.logfatal("%s", text)
