# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""oort rooms and oort areas: names and no-go areas that stay with the map."""

import json

import pytest

import oort
from helpers.saved_room import save_room
from oort.areas import Area, areas_of, areas_of_map, make_area
from oort.cli import areas, rooms


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> str:
    return save_room(tmp_path_factory.mktemp("room") / "map")


def test_a_room_is_found_and_named(saved: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert rooms.main([saved, "--json"]) == 0
    (room,) = json.loads(capsys.readouterr().out)
    assert (room["number"], room["name"], room["area"]) == (1, "", pytest.approx(20.0, rel=0.01))
    assert rooms.main([saved, "--name", "1", "den"]) == 0
    assert capsys.readouterr().out.split()[:2] == ["1", "den"]
    assert rooms.main([saved, "--name", "1", "study"]) == 0
    assert [id_ for space, id_, *_ in oort.load_map(saved).locations if space == "rooms"] == ["study"]
    assert rooms.main([saved, "--name", "7", "attic"]) == 2
    assert "there is no room 7; there are 1 to 1" in capsys.readouterr().err


def test_areas_are_added_listed_and_removed(saved: str, capsys: pytest.CaptureFixture[str]) -> None:
    triangle = ["--points", "0", "0", "1", "0", "0", "-1e-1"]
    assert areas.main([saved, "--add", "no_go_area", "carpet", *triangle]) == 0
    assert areas.main([saved, "--add", "no_go_line", "stairs", "--points", "0", "0", "1", "1"]) == 0
    capsys.readouterr()
    assert areas.main([saved]) == 0
    assert "-0.00" not in (said := capsys.readouterr().out)
    assert "0.00 -0.10)" in said
    assert areas.main([saved, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [(each["kind"], each["name"], len(each["points"])) for each in told] == [
        ("no_go_area", "carpet", 3),
        ("no_go_line", "stairs", 2),
    ]
    assert told[0]["points"][2] == pytest.approx([0.0, -0.1])
    assert areas.main([saved, "--add", "no_go_line", "carpet", "--points", "0", "0", "1", "1"]) == 0
    assert areas.main([saved, "--add", "no_go_line", "stairs", "--points", "2", "0", "1", "1", "0", "0"]) == 0
    assert [len(area.points) for area in areas_of_map(oort.load_map(saved))] == [3, 2, 3]
    for kind, name in (("no_go_area", "carpet"), ("no_go_line", "stairs"), ("no_go_line", "carpet")):
        assert areas.main([saved, "--remove", kind, name]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"{saved}: no areas"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--add", "zone", "a", "--points", "0", "0"], "'zone' is no kind of area"),
        (["--add", "no_go_area", "a", "--points", "0", "0", "1", "1"], "a no_go_area has at least 3 points, not 2"),
        (["--add", "no_go_area", "a", "--points", "0", "0", "1"], "3 numbers are no pairs"),
        (["--add", "no_go_line", "", "--points", "0", "0", "1", "1"], "a no_go_line needs a name"),
        (["--add", "no_go_line", "a", "--points", "0", "0", "nan", "1"], "a: a point of it is not finite"),
        (["--remove", "no_go_line", "a"], "there is no no_go_line 'a'"),
    ],
)
def test_areas_that_cannot_be(saved: str, arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert areas.main([saved, *arguments]) == 2
    assert told in capsys.readouterr().err
    assert areas_of_map(oort.load_map(saved)) == []


def test_an_area_moves_with_the_map_as_one() -> None:
    area = make_area("no_go_area", "carpet", [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])
    with oort.LiveMapper() as live:
        for k in range(30):
            live.push_odometry(0.1 * k, (0.02 * k, 0.0, 0.0))
            live.push_scan(oort.LaserScan([2.0] * 180, -1.57, 0.0175, 0.05, 6.0, time=0.1 * k))
        live.create_area(make_area("no_go_area", "carpet", [(9.0, 9.0), (8.0, 9.0), (9.0, 8.0), (7.0, 7.0)]))
        live.create_area(area)
        map_ = live.map()
    (found,) = areas_of_map(map_)
    for point, given in zip(found.points, area.points, strict=True):
        assert point == pytest.approx(given, abs=0.05)
    assert len({node for _, _, node, _ in map_.locations}) == 1  # so it keeps its shape, however nodes move


def test_what_is_no_area() -> None:
    pose = (1.0, 2.0, 0.0)
    assert areas_of([("no_go_area/x", "0", pose), ("no_go_line/y", "a", pose), ("dock", "0", pose)]) == []
    named = [("no_go_line/a/b", str(k), (float(k), 0.0, 0.0)) for k in (10, 9, 2)]
    assert areas_of(named) == [Area("no_go_line", "a/b", ((2.0, 0.0), (9.0, 0.0), (10.0, 0.0)))]
