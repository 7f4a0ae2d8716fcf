# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms of the Python package: each imports only those before it (docs/architecture.md)."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import ROOT

PACKAGE = ROOT / "src" / "python" / "oort"

ORDER = [
    "interrupts",
    "_core",
    "errors",
    "inputs",
    "poses",
    "parameters",
    "config",
    "recording",
    "saved_maps",
    "history",
    "events",
    "mapper",
    "diagnosis",
    "naming",
    "locations",
    "areas",
    "session",
    "localization",
    "live",
    "export",
    "image_maps",
    "simulate",
    "evaluation",
    "report",
    "view",
    "offline",
    "oort",  # what `import oort` offers
    "node",
    "cli",
    "commands",
]
"""``commands`` are the modules that ``python -m`` runs: they only call a tool of the room ``cli``."""

COMMANDS = {"replay", "check", "localize", "render", "merge", "evaluate", "graph", "migrate"}
LONGEST_COMMAND = 10  # lines

MIDDLEWARE = {"rospy", "rclpy", "tf2_ros", "oort_msgs", "rosgraph", "genpy"}
"""What only one of ROS 1 and ROS 2 has, or has otherwise."""
MESSAGES = {"geometry_msgs", "nav_msgs", "sensor_msgs", "std_msgs", "diagnostic_msgs", "visualization_msgs"}
ONLY_IN = {"argparse": {"cli"}, **{module: {"node"} for module in MIDDLEWARE | MESSAGES}}

FILES = sorted(path for path in PACKAGE.rglob("*.py*") if path.suffix in (".py", ".pyi"))


def _room(path: Path) -> str:
    first = path.relative_to(PACKAGE).parts[0]
    if first == "__init__.py":
        return "oort"
    if first.removesuffix(".py") in COMMANDS or (path.name == "__main__.py" and first != "node"):
        return "commands"
    return first.removesuffix(".pyi").removesuffix(".py")


def _imports(path: Path) -> Iterator[str]:
    """The full name of each module or thing that a file imports, also within functions."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            yield from (f"{node.module}.{name.name}" for name in node.names)


def _room_of_import(name: str) -> str | None:
    package, *inner = name.split(".")
    if package != "oort":
        return None
    if not inner:
        return "oort"
    if inner[0] in COMMANDS:
        return "commands"
    return inner[0] if inner[0] in ORDER else "oort"


def test_every_room_has_its_place_in_the_order() -> None:
    assert {_room(path) for path in FILES} == set(ORDER)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_follow_the_order(path: Path) -> None:
    here = ORDER.index(_room(path))
    rooms = {name: room for name in _imports(path) if (room := _room_of_import(name)) is not None}
    assert [name for name, room in rooms.items() if ORDER.index(room) > here] == []


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_what_only_one_room_may_import(path: Path) -> None:
    imported = {name.split(".")[0] for name in _imports(path)}
    assert [name for name in imported if _room(path) not in ONLY_IN.get(name, {_room(path)})] == []


@pytest.mark.parametrize("path", sorted((PACKAGE / "node").glob("*.py")), ids=lambda path: path.name)
def test_the_nodes_know_no_middleware(path: Path) -> None:
    assert not {name.split(".")[0] for name in _imports(path)} & MIDDLEWARE


def test_a_command_only_calls_its_tool() -> None:
    for name in COMMANDS:
        path = PACKAGE / f"{name}.py"
        assert list(_imports(path)) == ["sys", f"oort.cli.{name}.main"]
        assert len(path.read_text(encoding="utf-8").splitlines()) <= LONGEST_COMMAND
