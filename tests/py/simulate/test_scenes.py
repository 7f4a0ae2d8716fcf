# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes beside the usual homes: rooms that are all alike, and a corridor that tells no place from another."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from oort.cli.simulate import main
from oort.poses import Array, compose
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.alike import make_alike_home
from oort.simulate.free_space import NEAREST, flood
from oort.simulate.home import DOCK_FRONT
from oort.simulate.planar import transform

CORRIDOR = SimulationConfig(scene="corridor", odometry_error=0.0)


def rng(seed: int) -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(seed))


def ends(drive: Drive) -> tuple[Array, Array]:
    """Where beams ended, in the map frame by the truth (n, beams, 2), and which ones did (n, beams)."""
    returned = np.isfinite(drive.ranges)
    angles = drive.angle_min + drive.angle_increment * np.arange(drive.ranges.shape[1])
    beams = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points = np.where(returned, drive.ranges, 0.0)[:, :, None] * beams
    poses = compose(drive.T_map_base, drive.T_base_sensor)
    return np.array([transform(pose, p) for pose, p in zip(poses, points, strict=True)]), returned


@pytest.mark.parametrize("seed", range(8))
def test_rooms_of_an_alike_home_are_alike(seed: int) -> None:
    home, plan, grid = make_alike_home(rng(seed))
    assert [room.kind for room in plan.rooms].count("corridor") == 1
    assert len({room.kind for room in plan.rooms[1:]}) == 1
    assert len(plan.rooms) in (7, 9)
    seen = []
    for room, doorway in zip(plan.rooms[1:], plan.doorways, strict=True):
        # Seen from the door's middle, looking into the room.
        heading = 0.5 * np.pi if room.rect.y0 > 0.0 else -0.5 * np.pi
        x, y = doorway.gap.centre
        own = [p for p in home.pieces if np.all(transform_inverse((x, y, heading), p.footprint)[:, 0] > 0.0)]
        own = [p for p in own if room.rect.x0 < p.footprint[:, 0].mean() < room.rect.x1]
        points = [transform_inverse((x, y, heading), np.vstack([*p.solids, p.discs[:, :2]])) for p in own]
        seen.append(np.vstack([transform_inverse((x, y, heading), room.rect.polygon())[[0, 2]], *points]))
    order = [np.array(sorted(np.round(room_points, 6).tolist())) for room_points in seen]
    assert len(order[0]) > 6
    for other in order[1:]:
        np.testing.assert_allclose(other, order[0], atol=2e-6)
    front = transform(home.dock, [DOCK_FRONT, 0.0])
    reached = flood(grid.clearance >= NEAREST, grid.cell(float(front[0]), float(front[1])))
    assert all(np.count_nonzero(reached & grid.inside(room.rect)) > 50 for room in plan.rooms)


def transform_inverse(pose: tuple[float, float, float], points: Array) -> Array:
    x, y, heading = pose
    return np.asarray(transform([0.0, 0.0, -heading], points - np.array([x, y])))


def test_a_drive_through_an_alike_home_comes_back_to_its_dock() -> None:
    drive = simulate_drive(4, SimulationConfig(scene="alike"))
    assert np.hypot(*(drive.T_map_base[-1] - drive.T_map_base[0])[:2]) < 0.02
    assert [event.call for event in drive.events] == ["graph_loc/create", "map/notify_docked"]
    for room in drive.home.rooms:
        low, high = room.corners.min(axis=0), room.corners.max(axis=0)
        assert np.any(np.all((drive.T_map_base[:, :2] > low + 0.2) & (drive.T_map_base[:, :2] < high - 0.2), axis=1))


def test_a_corridor_shows_two_walls_and_in_the_end_a_third() -> None:
    drive = simulate_drive(1, CORRIDOR)
    assert drive.length == pytest.approx(30.0, abs=0.3)
    assert drive.T_map_base[-1, 0] - drive.T_map_base[0, 0] == pytest.approx(30.0, abs=0.1)
    points, returned = ends(drive)
    early = drive.T_map_base[:, 0] < 27.0
    assert np.all(np.abs(np.abs(points[early][returned[early]][:, 1]) - 0.75) < 0.1)
    assert not np.any(returned[early][:, 85:95])
    assert np.all(returned[-1, 85:95])
    assert drive.events == ()
    assert np.isnan(drive.legs).all()


def test_a_return_through_the_corridor_ends_where_it_began() -> None:
    drive = simulate_drive(2, replace(CORRIDOR, scene="corridor-return"))
    np.testing.assert_allclose(drive.T_map_base[-1], drive.T_map_base[0], atol=0.05)
    assert drive.length == pytest.approx(60.0, abs=0.6)
    np.testing.assert_array_equal(drive.T_map_base[: len(drive.T_map_base) // 4, 2].round(0), 0.0)
    # With the back wall out of reach, the first look and the last hold nothing but the walls at the sides.
    points, returned = ends(drive)
    last = points[-20:][returned[-20:]]
    assert np.all(np.abs(np.abs(last[:, 1]) - 0.75) < 0.1)


def test_the_same_seed_gives_the_same_bytes_and_another_another_way() -> None:
    first, again, other = (simulate_drive(seed, CORRIDOR) for seed in (3, 3, 4))
    assert first.ranges.tobytes() == again.ranges.tobytes()
    assert first.T_odom_base.tobytes() == again.T_odom_base.tobytes()
    assert first.T_map_base[:700].tobytes() != other.T_map_base[:700].tobytes()


def test_a_scene_can_be_chosen_at_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--seed", "1", "--scene", "corridor", "--fault", "bump", "--out", str(tmp_path)]) == 0
    assert "1 room (corridor)" in capsys.readouterr().out
    assert {path.suffix for path in tmp_path.iterdir()} == {".bag", ".clf", ".tum", ".json", ".png"}
    assert (tmp_path / "corridor_1.clf").is_file()


def test_unknown_scenes_and_faults_are_told() -> None:
    with pytest.raises(ValueError, match="scene 'office'"):
        SimulationConfig(scene="office")
    with pytest.raises(ValueError, match="fault 'fire'"):
        SimulationConfig(fault="fire")
    with pytest.raises(ValueError, match="nobody carries"):
        SimulationConfig(scene="corridor", fault="carried")
