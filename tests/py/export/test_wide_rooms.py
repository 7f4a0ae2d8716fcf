# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms of maps that are far wider than a home: one strange node in a small file is enough for that."""

import tracemalloc
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from oort.errors import InputError
from oort.export.rooms import find_rooms

DIAGONAL = np.array([[0.0, 0.0, 5.0, 5.0], [0.0, 0.0, -4.0, 4.0]])
"""Walls that turn the frame by as much as can be."""


def _grid(cells: np.ndarray) -> Any:
    height, width = cells.shape
    return SimpleNamespace(resolution=0.05, origin=(-5.0, -5.0), width=width, height=height, cells=cells)


def test_memory_goes_with_the_cells() -> None:
    """The widest map that is drawn has 34 times as many; numbers of all cells at once took nine gigabytes."""
    cells = np.full((1400, 1400), -1, dtype=np.int8)
    cells[200:300, 200:300] = 0
    tracemalloc.start()
    try:
        assert len(find_rooms(DIAGONAL, _grid(cells))) == 1
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak / cells.size < 60


def test_wider_than_can_be_is_said() -> None:
    with pytest.raises(InputError, match=r"not looked for in a map of 70\d{3} m x 70\d{3} m"):
        find_rooms(DIAGONAL, _grid(np.zeros((20, 2_000_000), dtype=np.int8)))
