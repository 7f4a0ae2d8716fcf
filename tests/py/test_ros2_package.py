# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 package, as far as it can be seen without ROS 2: its services are ROS 1's, its parameters exist."""

import re
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from conftest import ROOT
from oort import Parameters

ROS_1, ROS_2 = ROOT / "ros/oort_msgs/srv", ROOT / "ros2/oort_msgs/srv"
OWN = {"load", "events_log", "min_range", "max_range", "mask", "start"}
"""Parameters of the nodes that are none of params.json."""


def fields(part: str) -> list[str]:
    return [line.strip() for line in part.splitlines() if line.strip() and not line.startswith("#")]


@pytest.mark.parametrize("path", sorted(ROS_1.glob("*.srv")), ids=lambda path: path.name)
def test_a_service_is_that_of_ros_1_and_says_whether_it_worked(path: Path) -> None:
    request, response = map(fields, path.read_text().split("---\n"))
    request_2, response_2 = map(fields, (ROS_2 / path.name).read_text().split("---\n"))
    assert request_2 == request
    assert response_2[:2] == ["bool success", "string message"]
    assert response_2[2:] == [field for field in response if field != "bool success"]


def test_every_response_says_whether_it_worked() -> None:
    for path in ROS_2.glob("*.srv"):
        assert fields(path.read_text().split("---\n")[1])[:2] == ["bool success", "string message"], path


@pytest.mark.parametrize("name", ["mapping.yaml", "localization.yaml"])
def test_the_parameters_of_a_file_exist(name: str) -> None:
    """Also those that stand there as comments."""
    text = (ROOT / "ros2/oort/config" / name).read_text()
    full = re.sub(r"^(    )# ( *[a-z])", r"\1\2", text, flags=re.MULTILINE)
    given = YAML(typ="safe").load(full)["/**"]["ros__parameters"]
    known = Parameters().to_dict()
    assert [path for path in flat(given) if path not in known and path not in OWN] == []


def flat(tree: dict[str, Any], prefix: str = "") -> list[str]:
    return [
        path
        for key, value in tree.items()
        for path in (flat(value, f"{prefix}{key}.") if isinstance(value, dict) else [prefix + key])
    ]


@pytest.mark.parametrize("path", sorted((ROOT / "ros2/oort/launch").glob("*.py")), ids=lambda path: path.name)
def test_a_launch_file_starts_a_program_that_is_installed(path: Path) -> None:
    text = path.read_text()
    compile(text, path, "exec")
    programs = re.findall(r"(\w+)=oort\.", (ROOT / "ros2/oort/CMakeLists.txt").read_text())
    (started,) = re.findall(r'executable="(\w+)"', text)
    assert started in programs


def test_the_versions_agree() -> None:
    (version,) = re.findall(r"project\(oort VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    for package in ("oort", "oort_msgs"):
        assert f"<version>{version}</version>" in (ROOT / "ros2" / package / "package.xml").read_text()
