# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a node begins and ends."""

import signal
import threading
import time
import traceback
from collections.abc import Callable

from oort.errors import OortError
from oort.node.logs import Seldom, log
from oort.node.middleware import Closable, Middleware


def run_node(middleware: Middleware, begin: Callable[[Middleware], Closable]) -> int:
    """Runs a node until it is told to end, then closes it; exit code 2 if it cannot begin or be closed."""
    # The middleware's own handlers may wait for this thread, or for a master that this thread talks to: for ever.
    told_to_end = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: told_to_end.set())
    try:
        node = middleware.hold(begin)
        try:
            while not told_to_end.wait(0.1) and middleware.is_running():
                pass
        finally:
            node.close()
    except OortError as error:
        log.critical("%s", error)
        return 2
    finally:
        middleware.close()
    return 0


def repeat(is_running: Callable[[], bool], period: float, work: Callable[[], None]) -> None:
    """Does something every so many seconds as long as the node runs.

    By the wall's clock: a timer of ROS stands still without /clock and dies when it is set back.
    """
    complain = Seldom(say=log.error)
    while is_running():
        started = time.monotonic()
        try:
            work()
        except Exception:
            if is_running():  # then the topics are closed
                complain(traceback.format_exc())
        time.sleep(max(0.0, period - (time.monotonic() - started)))
