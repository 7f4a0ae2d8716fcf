# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a node begins and ends."""

import signal
import threading
from collections.abc import Callable
from typing import Protocol

import rospy

from oort.errors import OortError


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
