# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Other drives through the same simulated home, and furniture that was moved between them."""

import numpy as np
import pytest

from oort.simulate import Drive, SimulationConfig, simulate_drive


def drive(way: int, moved: int = 0) -> Drive:
    return simulate_drive(2, SimulationConfig(minutes=0.0, way=way, moved=moved))


def test_another_way_through_the_same_home() -> None:
    first, second = drive(0), drive(1)
    np.testing.assert_allclose(first.home.segments, second.home.segments, atol=1e-9)
    np.testing.assert_allclose(first.home.dock, second.home.dock, atol=1e-9)
    np.testing.assert_allclose(first.T_map_base[0], second.T_map_base[0], atol=1e-9)
    n = min(len(first.T_map_base), len(second.T_map_base))
    assert np.hypot(*(first.T_map_base[:n] - second.T_map_base[:n])[:, :2].T).max() > 1.0
    assert not np.array_equal(first.ranges[:20], second.ranges[:20])


def test_furniture_is_moved_within_the_home() -> None:
    before, after = drive(1), drive(1, moved=3)
    assert len(before.home.pieces) == len(after.home.pieces)
    there = {piece.footprint.round(6).tobytes() for piece in before.home.pieces}
    elsewhere = [piece for piece in after.home.pieces if piece.footprint.round(6).tobytes() not in there]
    assert 1 <= len(elsewhere) <= 3
    assert all(piece.name not in ("dock", "door leaf", "corner wall") for piece in elsewhere)
    np.testing.assert_allclose(before.home.dock, after.home.dock, atol=1e-9)


@pytest.mark.parametrize(
    "wrong",
    [
        {"way": -1},
        {"moved": -1},
        {"arrangement": -1},
        {"scene": "alike", "moved": 1},
        {"scene": "alike", "doors": True},
    ],
)
def test_what_cannot_be_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"way|moved|arrangement"):
        SimulationConfig(**wrong)  # type: ignore[arg-type]


def test_an_arrangement_is_the_same_on_every_way() -> None:
    config = {"minutes": 0.0, "moved": 3, "doors": True, "arrangement": 1}
    one, other = (simulate_drive(2, SimulationConfig(way=way, **config)) for way in (1, 2))  # type: ignore[arg-type]
    np.testing.assert_allclose(one.home.segments, other.home.segments, atol=1e-9)
    assert not np.array_equal(one.T_map_base[:100], other.T_map_base[:100])
    assert one.home.segments.shape == drive(1).home.segments.shape
    assert not np.allclose(one.home.segments, drive(1).home.segments)


def test_doors_stand_open_at_other_angles() -> None:
    before, after = (simulate_drive(3, SimulationConfig(minutes=0.0, way=1, doors=doors)) for doors in (False, True))
    leaves = [
        {tuple(piece.footprint.round(6).ravel()) for piece in d.home.pieces if piece.name == "door leaf"}
        for d in (before, after)
    ]
    assert leaves[0] and len(leaves[0]) == len(leaves[1])
    assert leaves[0] != leaves[1]
