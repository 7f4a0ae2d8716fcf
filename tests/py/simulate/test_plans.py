# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Homes from floor plans: what is read of a picture and of JSON is what was drawn, and a robot drives through it."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from helpers.plans import RESOLUTION, house, write_house, write_picture_of_plan
from oort import InputError, Parameters
from oort.cli.simulate import main
from oort.evaluation.trajectories import evaluate_ate
from oort.export import Trajectory, read_tum, write_map_server
from oort.offline.replay import replay
from oort.recording import open_recording
from oort.simulate import Drive, Plan, SimulationConfig, read_plan, simulate_drive
from oort.simulate.writers import write_drive

SHORT = SimulationConfig(minutes=0.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plans")
    write_picture_of_plan(folder / "flat.png")
    write_house(folder / "house.json")
    return folder


def plan_of(folder: Path, name: str) -> Plan:
    return read_plan(folder / name, RESOLUTION if name == "flat.png" else None)


def distance_to_walls(segments: np.ndarray[Any, Any], x: float, y: float) -> float:
    start, side = segments[:, :2] - [x, y], segments[:, 2:] - segments[:, :2]
    along = np.clip(-np.sum(start * side, axis=1) / np.sum(side * side, axis=1), 0.0, 1.0)
    return float(np.hypot(*(start + along[:, None] * side).T).min())


@pytest.mark.parametrize(("name", "wall", "shift"), [("flat.png", 0.05, 0.5), ("house.json", 0.0, 0.0)])
def test_walls_and_doors_are_where_they_were_drawn(folder: Path, name: str, wall: float, shift: float) -> None:
    plan = plan_of(folder, name)
    for (x, y), expected in {
        (2.0, 0.3): 0.3,  # before the wall at the bottom, whose door to the outside is shut
        (3.6, 3.3): 0.4 - wall,  # before the wall between the rooms
        (4.0, 1.5): 0.5,  # in a doorway
        (4.0, 4.5): 0.5,
        (5.0, 2.6): 0.4 - wall,
    }.items():
        assert distance_to_walls(plan.walls, x + shift, y + shift) == pytest.approx(expected, abs=1e-6), (x, y)
    total = sum(room.area for room in plan.rooms)
    assert total == pytest.approx(42.0, abs=2.5 if name == "flat.png" else 1e-6)  # the picture's walls are no floor


def test_rooms_and_furniture_of_a_house(folder: Path) -> None:
    plan = plan_of(folder, "house.json")
    assert [room.kind for room in plan.rooms] == ["living room", "kitchen", "bedroom"]
    assert [piece.name for piece in plan.pieces] == ["Sofa|1"]
    np.testing.assert_allclose(plan.pieces[0].footprint.min(axis=0), [0.0, 5.0])


def test_an_empty_wall_is_none(tmp_path: Path) -> None:
    content = house()
    content["doors"] = []
    content["walls"][0]["empty"] = True
    (tmp_path / "house.json").write_text(json.dumps(content))
    plan = read_plan(tmp_path / "house.json")
    assert distance_to_walls(plan.walls, 4.0, 1.5) == pytest.approx(1.5)
    assert distance_to_walls(plan.walls, 4.0, 4.5) == pytest.approx(0.0)


def test_a_door_of_the_first_files_is_where_its_offset_has_it(folder: Path, tmp_path: Path) -> None:
    content = house()
    for door in content["doors"]:
        begin, end = door.pop("holePolygon")
        door["boundingBox"] = {"min": begin | {"x": begin["x"] - 0.25}, "max": end | {"x": end["x"] - 0.25}}
        door["assetOffset"] = {"x": 0.25, "y": 0.0, "z": 0.0}
    (tmp_path / "house.json").write_text(json.dumps(content))
    np.testing.assert_allclose(read_plan(tmp_path / "house.json").walls, plan_of(folder, "house.json").walls)


def _sizes(**boxes: tuple[float, float, float]) -> dict[str, Any]:
    kinds = [{"assetId": name, "boundingBox": dict(zip("xyz", box, strict=True))} for name, box in boxes.items()]
    return {"Bed": kinds}


def test_objects_have_the_sizes_of_their_assets(tmp_path: Path) -> None:
    bed = {"assetId": "Bed_1", "position": {"x": 1.0, "y": 0.0, "z": 2.0}, "rotation": {"x": 0, "y": 30.0, "z": 0}}
    picture = {"assetId": "Picture_1", "position": {"x": 1.0, "y": 1.5, "z": 2.0}}
    (tmp_path / "house.json").write_text(json.dumps(changed(objects=[bed, picture, {"assetId": "Cup_1"}])))
    (tmp_path / "assets.json").write_text(json.dumps(_sizes(Bed_1=(1.0, 0.6, 2.0), Picture_1=(0.5, 0.4, 0.02))))
    assert "3 of 3 objects do not tell their size" in read_plan(tmp_path / "house.json").notes[0]
    plan = read_plan(tmp_path / "house.json", assets=tmp_path / "assets.json")
    assert "1 of 3 objects" in plan.notes[0]
    (piece,) = plan.pieces
    right = np.array([np.cos(np.pi / 6), -np.sin(np.pi / 6)])  # of the bed: clockwise seen from above
    ahead = np.array([np.sin(np.pi / 6), np.cos(np.pi / 6)])
    corners = [[1.0, 2.0] + a * right + b * ahead for a, b in ((-0.5, -1.0), (0.5, -1.0), (0.5, 1.0), (-0.5, 1.0))]
    np.testing.assert_allclose(piece.footprint, corners)


@pytest.mark.parametrize(
    "content", ["{", [1], {"Bed": [{"assetId": "Bed_1"}]}, _sizes(Bed_1=(float("nan"), 1.0, 1.0)), {"Bed": 3}]
)
def test_sizes_that_are_none_are_told(content: Any, folder: Path, tmp_path: Path) -> None:
    (tmp_path / "assets.json").write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises(InputError, match=r"assets\.json is no"):
        read_plan(folder / "house.json", assets=tmp_path / "assets.json")


def drive_through(plan: Plan, seed: int = 1) -> Drive:
    return simulate_drive(seed, SHORT, plan)


@pytest.mark.parametrize("name", ["flat.png", "house.json"])
def test_a_robot_sees_all_rooms_and_comes_back(folder: Path, name: str) -> None:
    drive = drive_through(plan_of(folder, name))
    again = drive_through(plan_of(folder, name))
    np.testing.assert_array_equal(drive.ranges, again.ranges)
    way = np.hypot(*(drive.T_map_base[:, :2] - drive.T_map_base[0, :2]).T)
    assert way[-1] < 0.03
    assert way.max() > 2.0
    # In the plan's frame all of the way is on the floor, and each of the three rooms was entered.
    corners = np.vstack([room.corners for room in drive.home.rooms])
    assert np.ptp(drive.T_map_base[:, :2], axis=0).max() < np.ptp(corners, axis=0).max()
    other = drive_through(plan_of(folder, name), seed=2)
    assert not np.array_equal(drive.home.dock, other.home.dock) or not np.array_equal(
        drive.ranges[50], other.ranges[50]
    )


def test_a_slanted_wall_is_straight(tmp_path: Path) -> None:
    rows, columns = np.mgrid[0:200, 0:200]
    inside = (rows > 10) & (columns > 10) & (rows + 2 * columns < 380)
    around = (rows > 4) & (columns > 4) & (rows + 2 * columns < 400)
    Image.fromarray(np.where(inside, 255, np.where(around, 0, 255)).astype(np.uint8)).save(tmp_path / "slanted.png")
    plan = read_plan(tmp_path / "slanted.png", 0.05)
    lengths = np.hypot(*(plan.edges[:, 2:] - plan.edges[:, :2]).T)
    assert len(lengths) < 10
    assert sorted(lengths)[-3] > 7.0


def test_a_map_of_map_server_is_a_plan(folder: Path, tmp_path: Path) -> None:
    with Image.open(folder / "flat.png") as picture:
        cells = np.where(np.asarray(picture)[::-1] == 0, 100, 0)
    cells[:3] = -1
    write_map_server(tmp_path / "map", cells, RESOLUTION, (-1.0, 2.0, 0.0))
    plan = read_plan(tmp_path / "map.yaml")
    drawn = plan_of(folder, "flat.png")
    np.testing.assert_allclose(np.sort(plan.edges[:, 0]), np.sort(drawn.edges[:, 0]) - 1.0, atol=1e-9)
    np.testing.assert_allclose(np.sort(plan.edges[:, 1]), np.sort(drawn.edges[:, 1]) + 2.0, atol=1e-9)


def test_the_dock_may_be_given(folder: Path) -> None:
    plan = read_plan(folder / "house.json", dock=(0.25, 2.0, 0.0))
    drive = drive_through(plan)
    room = drive.home.rooms[0].corners
    low = room.min(axis=0)
    np.testing.assert_allclose(drive.home.dock[:2] - low, [0.25, 2.0], atol=1e-9)
    with pytest.raises(InputError, match="no floor where the robot drives"):
        drive_through(read_plan(folder / "house.json", dock=(0.25, 5.5, 0.0)))


def test_every_kind_of_recording_gives_the_same_good_map(folder: Path, tmp_path: Path) -> None:
    drive = drive_through(plan_of(folder, "flat.png"))
    paths = write_drive(drive, tmp_path, "flat", picture=False, formats=("ros1", "ros2", "mcap", "carmen"))
    maps = []
    for path in paths[:4]:
        mapped = replay(open_recording(path), Parameters())
        trajectory = Trajectory(tuple(mapped.recorder.stamps), mapped.recorder.base_poses(mapped.map))
        error = evaluate_ate(trajectory, read_tum(tmp_path / "flat.truth.tum")).position_rmse
        assert error < 0.03, path
        maps.append(mapped.map.node_poses)
    np.testing.assert_array_equal(maps[0], maps[1])
    np.testing.assert_array_equal(maps[1], maps[2])


def changed(**entries: Any) -> dict[str, Any]:
    return house() | entries


HOLE = [{"x": 2.5, "y": 0.0}, {"x": 3.5, "y": 2.0}]  # beyond the wall's end


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("{", "no JSON"),
        ("[1]", "'rooms' must be a list"),
        (changed(rooms=[]), "has no rooms"),
        (changed(rooms={}), "'rooms' must be a list"),
        (changed(rooms=[{"floorPolygon": [{"x": 0}]}]), "floorPolygon of room 0"),
        (changed(rooms=[{"floorPolygon": [{"x": 0, "z": 1e9}]}]), "floorPolygon of room 0"),
        (changed(rooms=[{"floorPolygon": [{"x": 0, "z": 1}] * 5}]), "floorPolygon of room 0"),
        (changed(doors=[7]), "door 0 names no wall"),
        (changed(doors=[{"wall0": "wall|a", "room0": 1, "room1": 2}]), "holePolygon of door 0"),
        (changed(doors=[{"wall0": "wall|a", "room0": 1, "room1": 2, "holePolygon": HOLE}]), "does not lie within"),
        (changed(objects=[{"axisAlignedBoundingBox": 3}]), "center of object 0"),
        (changed(objects=[{"axisAlignedBoundingBox": {"center": {"x": "NaN", "y": 0, "z": 0}}}]), "center of object 0"),
    ],
)
def test_a_house_that_is_none_is_told(content: Any, told: str, tmp_path: Path) -> None:
    path = tmp_path / "house.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises(InputError, match=told):
        read_plan(path)


def test_a_floor_that_spans_too_much_is_told(tmp_path: Path) -> None:
    afar = [{"x": x, "z": z} for x, z in ((900, 900), (900, 904), (904, 904), (904, 900))]
    content = house()
    content["rooms"].append({"roomType": "Bedroom", "floorPolygon": afar})
    (tmp_path / "house.json").write_text(json.dumps(content))
    with pytest.raises(InputError, match="the floor spans 904 x 904 m; at most 300 m do"):
        simulate_drive(1, SHORT, read_plan(tmp_path / "house.json"))


def test_a_picture_that_is_no_plan_is_told(tmp_path: Path, folder: Path) -> None:
    dark = tmp_path / "dark.png"
    Image.new("L", (50, 50), 0).save(dark)
    (tmp_path / "text.png").write_text("no picture")
    for path, resolution, told in (
        (dark, 0.05, "no light area"),
        (folder / "flat.png", None, "--resolution"),
        (folder / "flat.png", 3.0, "choose 0.002 to 0.5"),
        (folder / "flat.png", 0.002, "no place for the dock|no light area"),
        (tmp_path / "text.png", 0.05, "cannot be read as a picture"),
        (tmp_path / "gone.png", 0.05, "cannot be read"),
        (folder / "house.json", 0.05, "leave out --resolution"),
    ):
        with pytest.raises(InputError, match=told):
            drive_through(read_plan(path, resolution))


def test_the_command_takes_a_plan(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--plan", str(folder / "flat.png"), "--resolution", "0.05", "--minutes", "0", "--out", str(tmp_path)]
    assert main([*words, "--format", "mcap", "ros2", "--sensor", "hokuyo"]) == 0
    assert "1 room (floor)" in capsys.readouterr().out
    names = ["flat_0", "flat_0.events.json", "flat_0.mcap", "flat_0.png", "flat_0.truth.tum"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert main([*words, "--doors"]) == 2
    assert "taken as it is" in capsys.readouterr().err
    assert main(["--resolution", "0.05"]) == 2
    assert "say which with --plan" in capsys.readouterr().err
