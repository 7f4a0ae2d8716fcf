# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Services in ROS 2 that may take their time while the executor's one thread goes on with scans."""

import traceback
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from oort_msgs import srv
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

from oort.errors import OortError
from oort.node.logs import log
from oort.node.middleware.base import Fields

_AT_ONCE = 16  # calls that wait for their turn in the mapping's queue, say


class Services:
    """Each call is handled in a thread of a pool; the executor sends its response when that is done."""

    def __init__(self, node: Node, executor: Executor) -> None:
        """None so far."""
        self._node = node
        self._executor = executor
        self._group = ReentrantCallbackGroup()
        self._pool = ThreadPoolExecutor(_AT_ONCE, "oort-service")

    def offer(self, name: str, kind: str, handle: Callable[[Any], Fields | None]) -> None:
        """Offers a service of oort_msgs, or Trigger for Empty; what it raises goes into the response."""

        async def answer(request: Any, response: Any) -> Any:
            done = Future(executor=self._executor)

            def work() -> None:
                _fill(response, handle, request)
                done.set_result(None)
                self._executor.wake()

            self._pool.submit(work)
            await done
            return response

        service = Trigger if kind == "Empty" else getattr(srv, kind)
        self._node.create_service(service, name, answer, callback_group=self._group)

    def close(self) -> None:
        """Ends the threads when their work is done."""
        self._pool.shutdown(cancel_futures=True)


def _fill(response: Any, handle: Callable[[Any], Fields | None], request: Any) -> None:
    """Handles a request; an exception that got away would end the node, and leave the caller waiting for ever."""
    try:
        fields = handle(request) or {}
    except OortError as error:
        log.warning("%s", error)
        response.success, response.message = False, str(error)
        return
    except Exception as error:
        log.error("%s", traceback.format_exc())
        response.success, response.message = False, f"{error!r}; the node's log says more"
        return
    response.success = True
    for name, value in fields.items():
        setattr(response, name, value)
