# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A node of ROS 2 with a lifecycle, as nav2's manager wants it; it activates itself unless autostart is false."""

from collections.abc import Callable
from typing import Any, cast

from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.node import Node

from oort.errors import OortError, StateError
from oort.node.logs import log
from oort.node.middleware.base import Closable, Managed, Middleware
from oort.node.middleware.rclpy import Rclpy
from oort.node.middleware.rclpy_bond import Bond

_AUTOSTART = "autostart"


class ManagedRclpy(Rclpy):
    """Configured, the node has its map, topics and services; active, it works."""

    def _make_node(self, name: str) -> Node:
        self._begin: Callable[[Middleware], Managed] | None = None
        self._held: Managed | None = None
        self._failed: OortError | None = None
        self._autostarts = True
        return _Lifecycle(self, name)

    def parameters(self) -> dict[str, Any]:
        """What the node was given."""
        return {name: value for name, value in super().parameters().items() if name != _AUTOSTART}

    def hold(self, begin: Callable[[Middleware], Closable]) -> Closable:
        """Begins at once, or when a manager says so; ``begin`` makes a Managed."""
        self._begin = cast(Callable[[Middleware], Managed], begin)
        if not self.node.has_parameter(_AUTOSTART):
            self.node.declare_parameter(_AUTOSTART, True)
        if self.node.get_parameter(_AUTOSTART).value:
            self.node.trigger_configure()
            if self._failed is not None:
                raise self._failed
            self.node.trigger_activate()
        else:
            self._autostarts = False
            log.info("%s waits to be configured", self.name)
        return _Holder(self)

    # ---- transitions ----

    def configure(self) -> bool:
        """Makes the node; whether that worked."""
        try:
            if self._begin is None:
                raise StateError("the node is not yet ready to be configured")
            self._held, self._failed = self._begin(self), None
        except OortError as error:
            self._failed = error
            if not self._autostarts:
                log.error("%s", error)
            self.drop()
            return False
        self._held.set_active(False)
        return True

    def set_active(self, active: bool) -> None:
        """Puts it to work or to sleep."""
        if self._held is not None:
            self._held.set_active(active)

    def clean_up(self) -> None:
        """Ends the node; another can be configured."""
        held, self._held = self._held, None
        if held is not None:
            held.close()
        self.drop()


class _Holder:
    """What run_node() closes: the node of that moment, if there is one."""

    def __init__(self, middleware: ManagedRclpy) -> None:
        self.close = middleware.clean_up


class _Lifecycle(LifecycleNode):  # type: ignore[misc]
    def __init__(self, middleware: ManagedRclpy, name: str) -> None:
        self._oort = middleware
        super().__init__(name, automatically_declare_parameters_from_overrides=True)
        self._bond = Bond(self)

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS if self._oort.configure() else TransitionCallbackReturn.FAILURE

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._oort.set_active(True)
        self._bond.hold()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._bond.release()
        self._oort.set_active(False)
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._oort.clean_up()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._bond.release()
        self._oort.clean_up()
        return TransitionCallbackReturn.SUCCESS
