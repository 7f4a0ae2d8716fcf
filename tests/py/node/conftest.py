# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A roscore of the test session's own, and Oort's node started in it as a user would start it.

Without ROS, every test that asks for one of these fixtures is skipped.
"""

import importlib.util
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from node.peer import Peer
from node.running import Core, Node, start_core

NodeFactory = Callable[..., Node]


@pytest.fixture(scope="session")
def ros(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Core]:
    """The roscore, on the loopback and a free port; os.environ points at it as long as it runs."""
    pytest.importorskip("rospy", reason="ROS is not installed (scripts/setup.sh --ros)")
    with start_core(tmp_path_factory.mktemp("ros")) as core:
        before = dict(os.environ)
        os.environ.pop("ROS_HOSTNAME", None)  # it would win over ROS_IP
        os.environ.update(core.variables)
        yield core
        os.environ.clear()
        os.environ.update(before)


@pytest.fixture(scope="session")
def rospy(ros: Core) -> Iterator[Any]:
    """The module rospy, with this process as the ROS node /oort_tests, on wall time for the whole session.

    A test of use_sim_time needs a client process of its own: rospy asks for the clock only once.
    """
    import rospy

    rospy.init_node("oort_tests", disable_signals=True)
    yield rospy
    rospy.signal_shutdown("the tests are over")


@pytest.fixture(scope="session")
def graph(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Peer]:
    """The ROS graph of the test session's own, of the ROS that is there: for tests of nodes in either."""
    if importlib.util.find_spec("rclpy") is None:
        core = request.getfixturevalue("ros")
        request.getfixturevalue("rospy")
        from node.peer_rospy import RospyPeer

        yield RospyPeer(core)
        return
    from node.peer_rclpy import RclpyPeer

    peer = RclpyPeer(tmp_path_factory.mktemp("ros"), 1 + os.getpid() % 100)
    yield peer
    peer.close()


@pytest.fixture
def peer(graph: Peer) -> Iterator[Peer]:
    """It; what a test has opened is closed at its end."""
    yield graph
    graph.forget()


@pytest.fixture
def node(ros: Core, tmp_path: Path) -> Iterator[NodeFactory]:
    """Starts the node: node(*args, name="oort_slam", ready="map/stop", timeout=20.0) -> Node.

    `args` are those of `rosrun oort oort_ros`: remappings and private parameters (``scan:=/s``, ``_load:=/x``).
    Returns when the service `ready` of the node answers and the node says that it is ready; with ready=None at once.
    At the end of the test each node gets SIGINT, its output is printed (pytest shows it if the test failed), and its
    parameters are forgotten.
    """
    started: list[Node] = []

    def start(*args: str, name: str = "oort_slam", ready: str | None = "map/stop", timeout: float = 20.0) -> Node:
        log = tmp_path / f"{name}.{len(started)}.log"
        started.append(Node(ros, name, ["rosrun", "oort", "oort_ros", f"__name:={name}", *args], log, tmp_path))
        if ready is not None:
            started[-1].wait_for_service(ready, timeout)
            # Before that a signal can meet rospy in the midst of a call to the master, and then it hangs.
            started[-1].wait_until(lambda: "is ready" in started[-1].output, "it did not say 'is ready'", timeout)
        return started[-1]

    yield start
    for running in started:
        running.stop()
        print(f"---- {running.log.name}, ended with {running.process.returncode}\n{running.output}")
    ros.forget_parameters()
