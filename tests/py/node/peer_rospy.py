# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A peer over ROS 1."""

from collections.abc import Callable, Mapping
from typing import Any

import rospy
from oort_msgs import srv
from std_srvs.srv import Empty

from node.peer import Peer, Reply, until
from node.running import Core


class RospyPeer(Peer):
    """Its process is the ROS node /oort_tests."""

    def __init__(self, core: Core) -> None:
        """In a core that runs, which rospy is in."""
        self.environment = core.environment
        self._core = core
        self._opened: list[Any] = []

    def now(self) -> Any:
        """A stamp for messages."""
        return rospy.Time.now()

    def stamp(self, seconds: float) -> Any:
        """The same of any time."""
        return rospy.Time.from_sec(seconds)

    def seconds(self, stamp: Any) -> float:
        """Back."""
        return float(stamp.to_sec())

    def publisher(self, topic: str, kind: Any, *, latched: bool = False) -> Callable[[Any], None]:
        """Publishes on a topic, once somebody listens."""
        publisher = rospy.Publisher(topic, kind, queue_size=10_000, latch=latched, tcp_nodelay=True)
        self._opened.append(publisher)
        until(lambda: latched or publisher.get_num_connections() > 0, f"somebody listens to {topic}")
        publish: Callable[[Any], None] = publisher.publish
        return publish

    def hear(self, topic: str, kind: Any, *, latched: bool = False) -> list[Any]:
        """All that is said on a topic from here on."""
        heard: list[Any] = []
        subscriber = rospy.Subscriber(topic, kind, heard.append, tcp_nodelay=True)
        self._opened.append(subscriber)
        until(lambda: subscriber.get_num_connections() > 0, f"somebody publishes {topic}")
        return heard

    def forget(self) -> None:
        """Ends all publishers and subscribers, and what was set."""
        self._core.forget_parameters()
        for one in self._opened:
            one.unregister()
        self._opened.clear()

    def call(self, service: str, kind: str, **fields: Any) -> Reply:
        """Calls a service of oort_msgs, or one that takes nothing."""
        type_ = Empty if kind == "Empty" else getattr(srv, kind)
        rospy.wait_for_service(service, 15.0)
        try:
            response = rospy.ServiceProxy(service, type_)(**fields)
        except rospy.ServiceException as error:
            return Reply(False, str(error), None)
        return Reply(getattr(response, "success", True), "", response)

    def arguments(self, name: str, parameters: Mapping[str, Any], remappings: Mapping[str, str]) -> list[str]:
        """As rosrun takes them."""
        private = [f"_{key.replace('.', '/')}:={value}" for key, value in parameters.items()]
        return [f"__name:={name}", *private, *(f"{old}:={new}" for old, new in remappings.items())]
