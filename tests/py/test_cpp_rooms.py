# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms of the C++ engine: each rests only on those before it (docs/architecture.md)."""

import re
from pathlib import Path

import pytest

ENGINE = Path(__file__).resolve().parents[2] / "src" / "cpp" / "oort"

ORDER = [
    "geometry",
    "parameters",
    "grid",
    "matching",
    "graph",
    "map",
    "odometry",
    "sensor",
    "local_slam",
    "loop_closure",
    "maintenance",
    "localization",
    "mapper",
    "merging",
    "render",
    "storage",
]

LARGEST_SHARE = 0.15
"""of the engine's lines in one room"""

FILES = sorted(path for path in ENGINE.rglob("*.[ch]pp") if path.parent != ENGINE)


def _room(path: Path) -> str:
    return path.relative_to(ENGINE).parts[0]


def test_every_room_has_its_place_in_the_order() -> None:
    assert sorted({_room(path) for path in FILES}) == sorted(ORDER)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ENGINE)))
def test_includes_follow_the_order(path: Path) -> None:
    here = ORDER.index(_room(path))
    included = re.findall(r'#include [<"]oort/(\w+)/', path.read_text())
    assert [room for room in included if ORDER.index(room) > here] == []


HEADERS = sorted(path for path in ENGINE.rglob("*.hpp") if "internal" not in path.parts)


@pytest.mark.parametrize("path", HEADERS, ids=lambda path: str(path.relative_to(ENGINE)))
def test_what_is_installed_includes_nothing_internal(path: Path) -> None:
    assert re.findall(r'#include [<"].*internal/.*', path.read_text()) == []


def test_internal_headers_stay_in_their_room() -> None:
    """But for the graph's, which refinement shares."""
    for path in FILES:
        for room in re.findall(r'#include "oort/(\w+)/internal/', path.read_text()):
            assert room in (_room(path), "graph"), path


def test_no_room_is_too_large() -> None:
    lines = {room: 0 for room in ORDER}
    for path in FILES:
        lines[_room(path)] += len(path.read_text().splitlines())
    largest = max(lines, key=lambda room: lines[room])
    assert lines[largest] <= LARGEST_SHARE * sum(lines.values()), lines
