# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Services in ROS 2 that may take their time while the executor's one thread goes on with scans."""

import traceback
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from nav_msgs.srv import GetMap
from oort_msgs import srv
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Empty, Trigger

from oort.errors import OortError
from oort.node.logs import log
from oort.node.middleware.base import Fields

_STANDARD = {"Empty": Trigger, "ClassicEmpty": Empty, "GetOccupancyGrid": GetMap}
"""Those that are not of oort_msgs. The last two cannot say that they failed; the log does."""
_AT_ONCE = 16  # calls that wait for their turn in the mapping's queue, say


class Services:
    """Each call is handled in a thread of a pool; the executor sends its response when that is done."""

    def __init__(self, node: Node, executor: Executor) -> None:
        """None so far."""
        self._node = node
        self._executor = executor
        self._group = ReentrantCallbackGroup()
        self._pool = ThreadPoolExecutor(_AT_ONCE, "oort-service")

    def offer(self, name: str, kind: str, handle: Callable[[Any], Fields | None]) -> Callable[[], object]:
        """Offers a service; what ``handle`` raises goes into the response. What ends the service."""

        async def answer(request: Any, response: Any) -> Any:
            done = Future(executor=self._executor)

            def work() -> None:
                _fill(response, handle, request)
                done.set_result(None)
                self._executor.wake()

            self._pool.submit(work)
            await done
            return response

        type_ = _STANDARD.get(kind) or getattr(srv, kind)
        service = self._node.create_service(type_, name, answer, callback_group=self._group)
        return partial(self._node.destroy_service, service)

    def close(self) -> None:
        """Ends the threads when their work is done."""
        self._pool.shutdown(cancel_futures=True)


def _fill(response: Any, handle: Callable[[Any], Fields | None], request: Any) -> None:
    """Handles a request; an exception that got away would end the node, and leave the caller waiting for ever."""
    try:
        fields = handle(request) or {}
    except OortError as error:
        log.warning("%s", error)
        _say(response, False, str(error))
        return
    except Exception as error:
        log.error("%s", traceback.format_exc())
        _say(response, False, f"{error!r}; the node's log says more")
        return
    _say(response, True, "")
    for name, value in fields.items():
        setattr(response, name, value)


def _say(response: Any, success: bool, message: str) -> None:
    if hasattr(response, "success"):
        response.success, response.message = success, message
