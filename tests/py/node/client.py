# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A client of the node under test: its services called, its topics listened to."""

import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TransformStamped
from oort_msgs import srv
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from node.running import Core, Node
from oort.node.middleware.rospy import Rospy

SERVICES = {
    "map/start": srv.SetString,
    "map/load": srv.SetString,
    "map/resume": srv.MapResume,
    "map/resume_here": srv.SetString,
    "map/notify_docked": Empty,
    "map/pause": Empty,
    "map/resume_from_paused": Empty,
    "map/stop": Empty,
    "map/clear": Empty,
    "map/accept": Empty,
    "map/reject": Empty,
    "map/history": srv.GetStrings,
    "map/restore": srv.SetString,
    "map/state": srv.GetString,
    "map/map": srv.GetMap,
    "map/name": srv.GetString,
    "map/has_map": srv.GetBool,
    "map/republish_maps": Empty,
    "map/num_nodes": srv.GetUInt,
    "graph_loc/create": srv.LocCreate,
    "graph_loc/create_points": srv.LocCreatePoints,
    "graph_loc/is_ready": srv.GetBool,
    "graph_loc/list": srv.LocNamespace,
    "graph_loc/list_namespaces": srv.GetStrings,
    "graph_loc/delete": srv.LocDelete,
    "graph_loc/locate": srv.LocLocate,
    "graph_loc/clear": srv.LocNamespace,
}

_PREFIX = "service cannot process request: "  # rospy's


def until(condition: Callable[[], object], what: str, timeout: float = 10.0) -> None:
    """Waits for a condition; fails saying `what` did not come about."""
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, f"not within {timeout:g} s: {what}"
        time.sleep(0.01)


def this_process() -> Rospy:
    """The middleware of the test's own process, which the fixture `rospy` makes a node."""
    return object.__new__(Rospy)  # its constructor would make another


class Client:
    """The services of a node, by their names under it."""

    def __init__(self, node: Node) -> None:
        """Of a node that runs."""
        self.node = node
        self.name = f"/{node.name}"

    def call(self, service: str, *args: Any) -> Any:
        """Calls with the request's fields; returns the response's only field, or else the response."""
        response = rospy.ServiceProxy(f"{self.name}/{service}", SERVICES[service])(*args)
        return getattr(response, response.__slots__[0]) if len(response.__slots__) == 1 else response

    def refusal(self, service: str, *args: Any) -> str:
        """Calls what must fail; returns what the client is told."""
        try:
            answer = self.call(service, *args)
        except rospy.ServiceException as error:
            told = re.fullmatch(r"service \[(.*)\] responded with an error: b(['\"])(.*)\2", str(error), re.DOTALL)
            assert told is not None, error
            assert told[1] == f"{self.name}/{service}"
            assert told[3].startswith(_PREFIX), told[3]
            return told[3].removeprefix(_PREFIX)
        raise AssertionError(f"{service}{args} answered {answer!r}")

    @property
    def state(self) -> str:
        """not_mapping, mapping or paused."""
        state: str = self.call("map/state")
        return state

    def figures(self) -> dict[str, str]:
        """What the next diagnostics say."""
        with Heard("/diagnostics", DiagnosticArray, self.name) as heard:
            return figures(heard.wait())


class Heard:
    """What is said on a topic. Use as a context: on entering it is connected to the node."""

    def __init__(self, topic: str, kind: Any, node: str = "/oort_slam") -> None:
        """Listens to a topic of `node`."""
        self.messages: list[Any] = []
        self._node = node
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append, tcp_nodelay=True)

    def __enter__(self) -> Self:
        """Waits for the connection."""
        until(self._connected, f"{self._node} publishes {self._subscriber.resolved_name}")
        return self

    def __exit__(self, *_: object) -> None:
        """Listens no more."""
        self._subscriber.unregister()

    def wait(self, count: int = 1, timeout: float = 10.0) -> Any:
        """Waits until so many messages were heard; the last of these."""
        until(lambda: len(self.messages) >= count, f"{count} messages on {self._subscriber.resolved_name}", timeout)
        return self.messages[count - 1]

    def wait_for(self, wanted: Callable[[Any], object], what: str, timeout: float = 10.0) -> Any:
        """Waits for a message, also among those heard before; the first that is wanted."""
        until(lambda: any(map(wanted, tuple(self.messages))), what, timeout)
        return next(message for message in self.messages if wanted(message))

    def _connected(self) -> bool:
        try:
            address = rospy.get_master().lookupNode(self._node)[2]
        except rospy.MasterException:
            return False
        return any(address == connection.endpoint_id for connection in self._subscriber.impl.connections)


class HeardTransforms(Heard):
    """What the node itself says on /tf."""

    def __init__(self, node: str = "/oort_slam") -> None:
        """Listens to `node`, and what others say is left out."""
        super().__init__("/tf", TFMessage, node)

    @property
    def told(self) -> list[TransformStamped]:
        """The transforms so far."""
        messages = [one for one in tuple(self.messages) if one._connection_header["callerid"] == self._node]
        return [transform for message in messages for transform in message.transforms]


def figures(diagnostics: DiagnosticArray) -> dict[str, str]:
    """The values in a message of one status, by their keys."""
    (status,) = diagnostics.status
    return {item.key: item.value for item in status.values}


@contextmanager
def running_node(core: Core, folder: Path, *args: str, name: str = "oort_slam") -> Iterator[Client]:
    """The node for the tests of a module, as the fixture `node` starts it for one test."""
    command = ["rosrun", "oort", "oort_ros", f"__name:={name}", *args]
    node = Node(core, name, command, folder / f"{name}.log", folder)
    try:
        node.wait_for_service("map/stop")
        yield Client(node)
    finally:
        node.stop()
        print(node.output)
