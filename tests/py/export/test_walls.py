# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Straight walls from scans."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from oort.export.walls import join_segments, scan_segments
from oort.poses import compose


def _corner(step: float = 0.05) -> np.ndarray:
    """A scan of a corner: 2 m of a wall along y at x = 2, then 2 m along x at y = 1."""
    t = np.arange(0.0, 2.0, step)
    first = np.column_stack([np.full(len(t), 2.0), t - 1.0])
    second = np.column_stack([2.0 - t, np.full(len(t), 1.0)])
    return np.column_stack([np.concatenate([first, second]), np.ones(2 * len(t))])


def test_a_corner_is_two_walls() -> None:
    segments = scan_segments(_corner())
    assert len(segments) == 2
    for segment, wall in zip(segments, ([2.0, -1.0, 2.0, 1.0], [2.0, 1.0, 0.0, 1.0]), strict=True):
        ends, expected = segment.reshape(2, 2), np.reshape(wall, (2, 2))
        assert min(np.abs(ends - expected).max(), np.abs(ends[::-1] - expected).max()) < 0.06


def test_beams_without_a_return_are_no_wall() -> None:
    cloud = _corner()
    cloud[:, 2] = np.nan
    assert scan_segments(cloud).shape == (0, 4)


@given(st.floats(-np.pi, np.pi), st.floats(-5.0, 5.0), st.integers(0, 100))
def test_pieces_of_one_wall_become_one_whichever_way_it_runs(theta: float, offset: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.array([[0.0, 1.2], [1.0, 2.5], [2.4, 4.0], [0.5, 3.0]])
    ends = np.stack([t, rng.normal(0.0, 0.005, t.shape) + offset], axis=2).reshape(-1, 2)
    moved = compose([1.0, -2.0, theta], np.column_stack([ends, np.zeros(len(ends))]))[:, :2].reshape(-1, 4)
    walls = join_segments(moved, np.arange(4))
    assert len(walls) == 1
    assert abs(np.hypot(*(walls[0, 2:] - walls[0, :2])) - 4.0) < 0.03


def test_the_two_faces_of_a_wall_and_a_doorway_stay() -> None:
    faces = [[0.0, 0.0, 1.5, 0.0], [2.4, 0.0, 4.0, 0.0], [0.0, 0.12, 1.5, 0.12], [2.4, 0.12, 4.0, 0.12]]
    walls = join_segments(np.array(faces * 2), np.arange(8))
    assert sorted(np.round(walls, 6).tolist()) == sorted(faces)


def test_what_one_scan_alone_saw_is_no_wall() -> None:
    assert join_segments(np.array([[0.0, 0.0, 2.0, 0.0]]), np.array([0])).shape == (0, 4)
