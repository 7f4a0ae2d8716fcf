# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a node asks of its middleware.

Messages are those of the middleware: both name their fields alike, except in a stamp, and `oort.node.messages` sets
them one by one with values of the right type, because ROS 2's classes take no positional arguments and check nothing.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from enum import Enum, auto
from typing import Any, Protocol

from oort._core import OccupancyGrid
from oort.errors import OortError

Fields = Mapping[str, Any]
"""Of a service's response, by name; those that the middleware's definition lacks are left out."""


class Quality(Enum):
    """How a topic is carried."""

    STREAM = auto()
    """reliably, and not to those who come late"""
    SENSOR = auto()
    """as it comes, to or from a sensor that may lose messages"""
    LATCHED = auto()
    """the last message also to those who come late"""


class Publisher(Protocol):
    """Of one topic."""

    def publish(self, message: Any) -> None:
        """Sends a message."""

    def is_wanted(self) -> bool:
        """Whether anybody listens."""


class Subscription(Protocol):
    """Of one topic."""

    @property
    def topic(self) -> str:
        """Its name after remapping."""

    def close(self) -> None:
        """Listens no more."""


class Closable(Protocol):
    """A node of Oort's that is running."""

    def close(self) -> None:
        """Saves what is to be saved and ends."""


class Managed(Closable, Protocol):
    """One that a manager of lifecycles may put to sleep."""

    def set_active(self, active: bool) -> None:
        """Whether it works."""


class Middleware(ABC):
    """A node in ROS. Callbacks come in threads of the middleware's; all methods may be called from any thread."""

    ros: int
    """1 or 2: in ROS 2 people expect some names besides"""

    @abstractmethod
    def __init__(self, name: str) -> None:
        """Joins the ROS graph under this name, unless the command line gives another."""

    @property
    @abstractmethod
    def name(self) -> str:
        """The node's full name."""

    @abstractmethod
    def is_running(self) -> bool:
        """False from the moment at which the node is to end."""

    def hold(self, begin: "Callable[[Middleware], Closable]") -> Closable:
        """Begins: at once, unless the node has a lifecycle, of which others say when."""
        return begin(self)

    @abstractmethod
    def close(self) -> None:
        """Leaves the ROS graph."""

    @abstractmethod
    def resolve(self, topic: str) -> str:
        """A topic's full name after remapping."""

    # ---- parameters ----

    @abstractmethod
    def parameters(self) -> dict[str, Any]:
        """What the node was given, by dotted names; nothing of the middleware's own."""

    @abstractmethod
    def parameter_name(self, name: str) -> str:
        """A parameter of the node by the name under which its owner has given it."""

    @abstractmethod
    def show_parameters(self, values: Mapping[str, Any]) -> None:
        """Lets others read these, where the middleware asks the node for its parameters."""

    # ---- time ----

    @abstractmethod
    def now(self) -> int:
        """[ns]; 0 as long as a simulated clock is not known."""

    @abstractmethod
    def stamp(self, nanoseconds: int) -> Any:
        """A time as messages carry it."""

    # ---- topics and services ----

    @abstractmethod
    def publisher(
        self,
        topic: str,
        kind: Any,
        quality: Quality,
        on_subscriber: Callable[[Callable[[Any], None]], None] | None = None,
    ) -> Publisher:
        """``on_subscriber`` is given, whenever somebody begins to listen, what sends that one a message."""

    @abstractmethod
    def subscribe(self, topic: str, kind: Any, quality: Quality, take: Callable[[Any], None]) -> Subscription:
        """Each message to ``take``, in the order in which they come."""

    @abstractmethod
    def subscribe_transforms(self, moving: Callable[[Any, str], None], fixed: Callable[[Any, str], None]) -> None:
        """Each TransformStamped of tf with the name of the node that sent it: "" for a node that is not known."""

    @abstractmethod
    def send_transform(self, transform: Any) -> None:
        """To tf."""

    def offer(self, name: str, kind: str, handle: Callable[[Any], Fields | None]) -> None:
        """Offers ~name as serve() does; what fails, fails with a sentence that names the service."""

        def answer(request: Any) -> Fields | None:
            try:
                return handle(request)
            except OortError as error:
                if str(error).startswith(name):
                    raise
                raise OortError(f"{name}: {error}") from error

        self.serve(f"~{name}", kind, answer)

    @abstractmethod
    def serve(self, name: str, kind: str, handle: Callable[[Any], Fields | None]) -> None:
        """Offers a service of oort_msgs, or Empty; an OortError of ``handle`` is what the caller is told.

        In ROS 2 also nav_msgs/GetMap as GetOccupancyGrid, and std_srvs/Empty as ClassicEmpty.
        """

    @abstractmethod
    def grid(self, grid: OccupancyGrid) -> Any:
        """A nav_msgs/OccupancyGrid with the cells of a map and nothing else, made without a loop over them."""
