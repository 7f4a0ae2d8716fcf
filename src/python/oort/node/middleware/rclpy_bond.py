# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The bond that nav2's lifecycle manager wants to see: a heartbeat as long as a node is active."""

import uuid
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

try:
    from bond.msg import Status
except ImportError:  # without nav2 there is nobody who asks for it
    Status = None

_PERIOD = 0.1  # [s], as nav2's own nodes
_TIMEOUT = 4.0  # [s], as nav2's manager waits by default


class Bond:
    """On the topic `bond`, under the node's name."""

    def __init__(self, node: Node) -> None:
        """Silent so far."""
        self._node = node
        self._instance = str(uuid.uuid4())
        self._publisher: Any = None if Status is None else node.create_publisher(Status, "bond", 10)
        self._timer: Any = None

    def hold(self) -> None:
        """The node is active."""
        if self._publisher is not None and self._timer is None:
            steady = Clock(clock_type=ClockType.STEADY_TIME)  # simulated time may stand still
            self._timer = self._node.create_timer(_PERIOD, lambda: self._say(True), clock=steady)

    def release(self) -> None:
        """It is so no more, as it was told to."""
        if self._timer is not None:
            self._node.destroy_timer(self._timer)
            self._timer = None
            self._say(False)

    def _say(self, active: bool) -> None:
        message = Status(id=self._node.get_name(), instance_id=self._instance, active=active)
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.heartbeat_timeout, message.heartbeat_period = _TIMEOUT, _PERIOD
        self._publisher.publish(message)
