# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a test needs of ROS: a node of its own process, and Oort's nodes in processes of theirs."""

import os
import signal
import subprocess
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Reply:
    """Of a service."""

    success: bool
    message: str
    response: Any
    """None if rospy raised an error in its place"""


class Peer(ABC):
    """A node of the test's own process."""

    environment: Mapping[str, str]
    """for processes in the same ROS graph"""

    @abstractmethod
    def now(self) -> Any:
        """A stamp for messages."""

    @abstractmethod
    def stamp(self, seconds: float) -> Any:
        """The same of any time."""

    @abstractmethod
    def seconds(self, stamp: Any) -> float:
        """Back."""

    @abstractmethod
    def publisher(self, topic: str, kind: Any, *, latched: bool = False) -> Callable[[Any], None]:
        """Publishes on a topic, once somebody listens; a scan as sensors do."""

    @abstractmethod
    def hear(self, topic: str, kind: Any, *, latched: bool = False) -> list[Any]:
        """All that is said on a topic from here on."""

    @abstractmethod
    def forget(self) -> None:
        """Ends all publishers and subscribers."""

    @abstractmethod
    def call(self, service: str, kind: str, **fields: Any) -> Reply:
        """Calls a service of oort_msgs, or one that takes nothing."""

    @abstractmethod
    def arguments(self, name: str, parameters: Mapping[str, Any], remappings: Mapping[str, str]) -> list[str]:
        """The same for a program of either ROS."""


class Program:
    """A node in a process, with its output in a file."""

    def __init__(self, command: list[str], environment: Mapping[str, str], log: Path) -> None:
        self._log = log
        with log.open("w") as stream:
            self.process = subprocess.Popen(
                command, env=environment, cwd=log.parent, stdout=stream, stderr=stream, start_new_session=True
            )

    @property
    def output(self) -> str:
        """What it has printed so far."""
        return self._log.read_text(errors="replace")

    def end(self, with_signal: signal.Signals = signal.SIGINT) -> int:
        """Its exit code."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, with_signal)
        try:
            return self.process.wait(20.0)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            raise


@contextmanager
def running(
    peer: Peer,
    folder: Path,
    module: str = "oort.node",
    *,
    name: str = "oort_slam",
    ready: str = "is ready",
    extra: tuple[str, ...] = (),
    remappings: Mapping[str, str] | None = None,
    **parameters: Any,
) -> Iterator[Program]:
    """One of Oort's nodes; ``ready`` is what it prints when a test may go on, empty for a test that waits itself."""
    arguments = [*peer.arguments(name, parameters, remappings or {}), *extra]
    log = folder / f"{name}.{len(list(folder.glob(f'{name}.*')))}.log"
    program = Program([sys.executable, "-P", "-m", module, *arguments], peer.environment, log)
    try:
        if ready:
            until(lambda: ready in program.output or program.process.poll() is not None, f"{name} is ready", 30.0)
            assert ready in program.output, program.output
        yield program
    finally:
        code = program.end()
        print(f"---- {log.name} ended with {code}\n{program.output}")


def until(condition: Callable[[], object], what: str, timeout: float = 15.0) -> None:
    """Waits for a condition; fails saying `what` did not come about."""
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, f"not within {timeout:g} s: {what}"
        time.sleep(0.01)
