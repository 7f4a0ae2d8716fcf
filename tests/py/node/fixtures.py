# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""One node and one robot for all tests of a module, which begin with an empty map: a plugin for such modules.

They say ``pytest_plugins = ["node.fixtures"]`` and ``pytestmark = pytest.mark.usefixtures("cleared")``.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from node.client import Client, running_node
from node.robot import COURSE, SHORT, Course, Robot
from node.running import Core


@pytest.fixture(scope="module")
def client(ros: Core, rospy: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """Of a node that runs as long as the module's tests do."""
    with running_node(ros, tmp_path_factory.mktemp("node")) as client:
        yield client


@pytest.fixture(scope="module")
def robot(client: Client) -> Iterator[Robot]:
    """Stands in the room, and the node hears it."""
    with Robot(COURSE) as robot:
        robot.wait_for_node(client.name)
        yield robot


@pytest.fixture
def cleared(client: Client, robot: Robot) -> None:
    """The node has no map, and the robot stands with its laser off."""
    robot.base_on, robot.laser_on = True, False
    client.call("map/clear")


@pytest.fixture
def path(tmp_path: Path) -> str:
    """For a map, as clients give it: in a folder that is to be made, without ending."""
    return str(tmp_path / "oort_maps" / "7" / "map")


@pytest.fixture
def mapped(client: Client, robot: Robot, cleared: None, path: str) -> Course:
    """The way that the node has mapped and saved at `path`, and is through with."""
    client.call("map/start", path)
    robot.drive(SHORT)
    client.call("map/stop")
    return SHORT
