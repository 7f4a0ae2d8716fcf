# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Processes of ROS under test: the core and nodes in it."""

import io
import os
import shlex
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlparse

_CALLER = "/oort_tests_master_client"


class Core:
    """A running roscore."""

    def __init__(self, port: int, home: Path) -> None:
        self.variables = {
            "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
            "ROS_IP": "127.0.0.1",
            "ROS_HOME": str(home),
            "ROS_LOG_DIR": str(home / "log"),
            "ROS_PACKAGE_PATH": f"{sys.prefix}/share",
            "PYTHONUNBUFFERED": "1",
        }
        self._first_parameters: set[str] = set()

    @property
    def environment(self) -> dict[str, str]:
        """For processes that are to talk to this core."""
        others = {name: value for name, value in os.environ.items() if name != "ROS_HOSTNAME"}
        return others | self.variables

    def master(self, method: str, *args: Any) -> Any:
        """Calls the master over XML-RPC. Raises AssertionError if it says no, OSError if it is not there."""
        with xmlrpc.client.ServerProxy(self.variables["ROS_MASTER_URI"]) as proxy:
            code, message, value = getattr(proxy, method)(_CALLER, *args)
        assert code == 1, f"{method}{args}: {message}"
        return value

    def run(
        self, *command: str | Path, timeout: float = 60.0, cwd: Path | None = None
    ) -> subprocess.CompletedProcess[str]:
        """Runs a command of ROS to its end, whatever its exit code."""
        return subprocess.run(
            command, env=self.environment, cwd=cwd, capture_output=True, text=True, timeout=timeout, check=False
        )

    def set_parameter(self, name: str, value: Any) -> None:
        """Sets a ROS parameter until the end of the test (of one that uses `node`)."""
        self.master("setParam", name, value)

    def forget_parameters(self) -> None:
        """Deletes all parameters but the core's own."""
        for name in set(self.master("getParamNames")) - self._first_parameters:
            self.master("deleteParam", name)

    def service_answers(self, name: str) -> bool:
        """Whether a service is there. The name alone is not enough: a killed node's stays with the master."""
        from rosgraph.network import read_ros_handshake_header, write_ros_handshake_header  # only where ROS is

        try:
            address = urlparse(self.master("lookupService", name))
            with socket.create_connection((address.hostname, address.port), 1.0) as connection:
                probe = {"probe": "1", "md5sum": "*", "callerid": _CALLER, "service": name}
                write_ros_handshake_header(connection, probe)
                read_ros_handshake_header(connection, io.BytesIO(), 2048)
        except (AssertionError, OSError):
            return False
        return True

    def complete(self) -> bool:
        """Whether all of the core is up, its logger being the last."""
        try:
            subscribers = self.master("getSystemState")[1]
            self._first_parameters = set(self.master("getParamNames"))
        except OSError:
            return False
        return any(topic == "/rosout" for topic, _ in subscribers)


class Node:
    """A program that was started in a core, with its output in a file."""

    def __init__(self, core: Core, name: str, command: Sequence[str], log: Path, cwd: Path) -> None:
        self.core = core
        self.name = name
        self.log = log
        self._command = command
        with log.open("w") as stream:
            self.process = subprocess.Popen(
                command, env=core.environment, cwd=cwd, stdout=stream, stderr=stream, start_new_session=True
            )

    @property
    def output(self) -> str:
        """What it has printed so far."""
        return self.log.read_text(errors="replace")

    def wait_for_service(self, name: str, timeout: float = 20.0) -> None:
        """Waits for a service, whose name is relative to the node's own."""
        full = f"/{self.name}/{name}"
        self.wait_until(lambda: self.core.service_answers(full), f"no service {full}", timeout)

    def wait_until(self, condition: Callable[[], bool], failure: str, timeout: float = 20.0) -> None:
        """Waits for a condition; fails with the program's output if it ends or if the time is over [s]."""
        end = time.monotonic() + timeout
        while not condition():
            assert self.process.poll() is None, f"{failure}: {self._told()}"
            assert time.monotonic() < end, f"{failure} after {timeout} s: {self._told()}"
            time.sleep(0.05)

    def _told(self) -> str:
        how = "is running" if self.process.returncode is None else f"ended with {self.process.returncode}"
        return f"{shlex.join(self._command)} {how} and printed:\n{self.output}"

    def stop(self, with_signal: signal.Signals = signal.SIGINT, grace: float = 15.0) -> int:
        """Sends a signal to the process group, kills it if that does not help, and returns the exit code."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, with_signal)
        try:
            return self.process.wait(grace)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            return self.process.wait()


@contextmanager
def start_core(home: Path) -> Iterator[Core]:
    """A roscore on the loopback; `home` takes its logs."""
    for attempt in range(3):  # another process may take the port between the look and the bind
        core = Core(_free_port(), home)
        port = core.variables["ROS_MASTER_URI"].rpartition(":")[2]
        running = Node(core, "roscore", ["roscore", "-p", port], home / f"roscore.{attempt}.log", home)
        try:
            running.wait_until(core.complete, "roscore is not complete", 30.0)
        except AssertionError:
            running.stop()
            if attempt == 2:
                raise
            continue
        try:
            yield core
        finally:
            running.stop()
        return


def _free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port: int = listener.getsockname()[1]
        return port
