# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a node begins and ends."""

import signal
import threading
import time
import traceback
from collections.abc import Callable
from typing import Protocol

import rospy

from oort.errors import OortError

COMPLAIN = 10.0
"""[s] between two warnings about the same"""


class Closable(Protocol):
    """A node that is running."""

    def close(self) -> None:
        """Saves what is to be saved and ends."""


def run_node(name: str, begin: Callable[[], Closable]) -> int:
    """Runs a node until it is told to end, then closes it; exit code 2 if it cannot begin or be closed."""
    rospy.init_node(name, disable_signals=True)
    # rospy's own handler talks to the master, which hangs for ever where this thread is just doing so.
    told_to_end = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: told_to_end.set())
    try:
        node = begin()
        try:
            while not told_to_end.wait(0.1) and not rospy.is_shutdown():
                pass
        finally:
            node.close()
    except OortError as error:
        rospy.logfatal("%s", error)
        return 2
    finally:
        rospy.signal_shutdown("the node ends")
    return 0


def repeat(period: float, work: Callable[[], None]) -> None:
    """Does something every so many seconds as long as the node runs.

    By the wall's clock: a timer of ROS stands still without /clock and dies when it is set back.
    """
    while not rospy.is_shutdown():
        started = time.monotonic()
        try:
            work()
        except Exception:
            if not rospy.is_shutdown():  # then the topics are closed
                rospy.logerr_throttle(COMPLAIN, traceback.format_exc())
        time.sleep(max(0.0, period - (time.monotonic() - started)))
