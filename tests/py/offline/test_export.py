# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A saved map in the formats of other programs, read back."""

import json
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.filemanagement import readfile
from mcap.reader import make_reader
from rosbags.typesys import Stores, get_typestore
from ruamel.yaml import YAML
from shapely.geometry import Polygon, shape

import oort
from helpers.scenes import room_scan
from oort import Map, Parameters
from oort.cli.export import main
from oort.errors import InputError
from oort.export import read_g2o, read_map_server, read_tum
from oort.offline.export import FORMATS, export
from oort.offline.replay import replay
from oort.recording import open_recording
from oort.simulate import Drive
from oort.simulate.writers import write_carmen

_NAME = "sofa & <b>"
_SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (0.0, 0.5)]


@pytest.fixture(scope="module")
def map_(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Map:
    path = tmp_path_factory.mktemp("export") / "home.clf"
    write_carmen(drive, path)
    made = replay(open_recording(path)).map
    made.locations = [
        ("dock", "dock", 0, (0.1, 0.0, 0.5)),
        ("places", _NAME, 20, (0.0, 0.0, 0.0)),
        *((f"no_go_area/{_NAME}", str(k), 5, (x, y, 0.0)) for k, (x, y) in enumerate(_SQUARE)),
        ("no_go_line/stairs", "0", 5, (0.0, 1.0, 0.0)),
        ("no_go_line/stairs", "1", 5, (1.0, 1.0, 0.0)),
    ]
    return made


@pytest.fixture(scope="module")
def base(map_: Map, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("saved") / "home"
    map_.save(str(path))
    return path


def _export(base: Path, format_: str, name: str) -> Path:
    assert main([str(base), format_, str(base.parent / name)]) == 0
    return base.parent / name


@pytest.mark.parametrize("format_", [format_ for format_ in FORMATS if format_ != "rerun"])  # each has its own ids
def test_the_same_map_gives_the_same_bytes(base: Path, format_: str) -> None:
    first = _export(base, format_, "a.x")
    files = sorted(base.parent.glob("a*"))
    before = [path.read_bytes() for path in files]
    _export(base, format_, "a.x")
    if format_ != "dxf":  # a DXF tells when it was written
        assert [path.read_bytes() for path in files] == before
    assert files
    for path in files:
        path.unlink()
    assert first.parent.is_dir()


def test_map_server_reads_the_picture(base: Path) -> None:
    assert read_map_server(_export(base, "pgm", "grid.pgm").with_suffix(".yaml")).resolution == 0.05
    assert _export(base, "pgm", "grid.png").is_file()


def test_walls_of_the_dxf_lie_on_the_true_walls(base: Path, drive: Drive) -> None:
    document = readfile(_export(base, "dxf", "home.dxf"))
    space = document.modelspace()
    lines = np.array(
        [
            [p.x, p.y, q.x, q.y]
            for line in space.query("LINE[layer=='WALLS']")
            for p, q in [(line.dxf.start, line.dxf.end)]
        ]
    )
    assert _NAME in [text.dxf.text for text in space.query("TEXT[layer=='PLACES']")][1]
    square, line = (each for each in space.query("LWPOLYLINE[layer=='NO_GO']") if isinstance(each, LWPolyline))
    assert (len(square), square.closed, len(line), line.closed) == (4, True, 2, False)
    long = lines[np.hypot(*(lines[:, 2:] - lines[:, :2]).T) > 1.0]
    assert len(long) > 5
    middles = long.reshape(-1, 2, 2).mean(axis=1)
    a, b = drive.home.segments[:, :2], drive.home.segments[:, 2:]
    t = np.clip(((middles[:, None] - a) * (b - a)).sum(2) / np.maximum(((b - a) ** 2).sum(1), 1e-12), 0.0, 1.0)
    off = np.linalg.norm(a + t[..., None] * (b - a) - middles[:, None], axis=2).min(axis=1)
    assert np.median(off) < 0.02
    assert off.max() < 0.1


def test_the_svg_is_xml_with_walls_and_places(base: Path) -> None:
    root = ElementTree.parse(_export(base, "svg", "home.svg")).getroot()
    names = [text.text for text in root.iter("{http://www.w3.org/2000/svg}text")]
    assert names[-2:] == ["dock/dock", f"places/{_NAME}"]
    assert [name for name in names[:-2] if name and name.endswith(" m²")] == names[:-2]
    titles = [title.text for title in root.iter("{http://www.w3.org/2000/svg}title")]
    assert titles == [_NAME, "stairs"]
    assert len(list(root.iter("{http://www.w3.org/2000/svg}line"))) > 10


def test_geojson_has_walls_and_places(base: Path, map_: Map) -> None:
    features = json.loads(_export(base, "geojson", "home.geojson").read_text())["features"]
    places = {f["properties"]["name"]: f for f in features if f["properties"]["kind"] == "place"}
    assert places[_NAME]["geometry"]["coordinates"] == pytest.approx(
        list(map_.locate("places", _NAME) or ())[:2], abs=1e-4
    )
    assert len(places) == 2  # corners of areas are none
    (area,) = [f for f in features if f["properties"]["kind"] == "no_go_area"]
    ring = shape(area["geometry"])
    assert (ring.is_valid, ring.area) == (True, pytest.approx(0.5, abs=1e-3))


def test_rooms_of_the_dxf_have_the_true_areas(base: Path, drive: Drive) -> None:
    space = readfile(_export(base, "dxf", "home.dxf")).modelspace()
    lines = [line for line in space.query("LWPOLYLINE[layer=='ROOMS']") if isinstance(line, LWPolyline)]
    found = [Polygon([(x, y) for x, y, *_ in line]) for line in lines]
    assert len(found) == len(drive.home.rooms)
    for room in drive.home.rooms:
        true = Polygon(room.corners)
        overlaps = [other.intersection(true).area / other.union(true).area for other in found]
        assert max(overlaps) > 0.95, room.kind
        assert found[overlaps.index(max(overlaps))].area == pytest.approx(true.area, rel=0.04), room.kind


def test_the_keepout_mask_is_as_large_as_the_map(base: Path) -> None:
    grid = read_map_server(_export(base, "pgm", "grid.pgm").with_suffix(".yaml"))
    mask = read_map_server(_export(base, "nav2-keepout", "keepout.pgm").with_suffix(".yaml"))
    assert (mask.cells.shape, mask.origin) == (grid.cells.shape, grid.origin)
    assert (mask.cells == 100).sum() * 0.05**2 == pytest.approx(0.55, abs=0.1)  # the square, and a line a cell wide


def test_nav2_gets_the_dock_and_a_connected_route(base: Path, map_: Map) -> None:
    docks = YAML(typ="safe").load(_export(base, "nav2-docks", "docks.yaml").read_text())["docks"]
    assert docks["dock"]["frame"] == "map"
    assert docks["dock"]["pose"] == pytest.approx(list(map_.locate("dock", "dock") or ()), abs=1e-6)
    features = json.loads(_export(base, "nav2-route", "route.geojson").read_text())["features"]
    nodes = {f["properties"]["id"] for f in features if f["geometry"]["type"] == "Point"}
    ways = [(f["properties"]["startid"], f["properties"]["endid"]) for f in features if "startid" in f["properties"]]
    assert len({f["properties"]["id"] for f in features}) == len(features)
    reached: set[int] = {0}
    seen: set[int] = set()
    while reached - seen:
        node = min(reached - seen)
        seen.add(node)
        reached |= {end for start, end in ways if start == node}
    assert reached == nodes


def test_valetudo_gets_every_known_cell_once(base: Path, map_: Map) -> None:
    document = json.loads(_export(base, "valetudo", "map.json").read_text())
    grid = map_.render(Parameters()).map_cleaned
    floor = np.zeros(grid.cells.shape, dtype=np.int64)
    for layer in document["layers"]:
        runs = np.reshape(layer["compressedPixels"], (-1, 3))
        drawn = np.zeros(grid.cells.shape, dtype=np.bool_)
        for x, y, count in runs.tolist():
            assert not drawn[y, x : x + count].any()
            drawn[y, x : x + count] = True
        assert layer["dimensions"]["pixelCount"] == drawn.sum()
        if layer["type"] == "wall":
            np.testing.assert_array_equal(drawn, grid.cells[::-1] == 100)
        else:
            floor += drawn
    np.testing.assert_array_equal(floor, grid.cells[::-1] == 0)  # of no room, or of one
    names = [layer["metaData"]["name"] for layer in document["layers"] if layer["type"] == "segment"]
    assert names[:2] == ["Room 1", "Room 2"]
    kinds = [entity["type"] for entity in document["entities"]]
    assert kinds == ["charger_location", "no_go_area", "virtual_wall"]
    (square,) = [entity["points"] for entity in document["entities"] if entity["type"] == "no_go_area"]
    assert abs(Polygon(np.reshape(square, (4, 2))).area - 5000) < 150  # cm^2


def test_trajectories_and_graph_have_the_nodes(base: Path, map_: Map) -> None:
    np.testing.assert_allclose(read_tum(_export(base, "tum", "t.tum")).poses, map_.node_poses, atol=1e-9)
    assert len(read_g2o(_export(base, "g2o", "g.g2o")).ids) == len(map_)
    kitti = np.loadtxt(_export(base, "kitti", "k.txt"))
    np.testing.assert_allclose(kitti[:, [3, 7]], map_.node_poses[:, :2])
    np.testing.assert_allclose(np.arctan2(kitti[:, 4], kitti[:, 0]), map_.node_poses[:, 2])


def test_the_mcap_holds_the_solved_drive(base: Path, map_: Map) -> None:
    store = get_typestore(Stores.ROS2_HUMBLE)
    found: dict[str, list[Any]] = {}
    with _export(base, "mcap", "drive.mcap").open("rb") as stream:
        for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            assert schema is not None
            told = store.deserialize_cdr(message.data, schema.name)
            found.setdefault(channel.topic, []).append(told)
    assert {topic: len(told) for topic, told in found.items()} == {
        "/map": 1,
        "/trajectory": 1,
        "/tf": len(map_),
        "/points": len(map_),
    }
    grid = map_.render(Parameters()).map_cleaned
    np.testing.assert_array_equal(np.reshape(found["/map"][0].data, grid.cells.shape), grid.cells)
    last = found["/tf"][-1].transforms[0].transform.translation
    assert (last.x, last.y) == pytest.approx(map_.node_poses[-1, :2].tolist())
    points = np.frombuffer(found["/points"][3].data, dtype="<f4").reshape(-1, 3)
    cloud = map_.cloud(3)
    np.testing.assert_allclose(points[:, :2], cloud[cloud[:, 2] == 1.0, :2], rtol=1e-6)


def test_what_is_not_there_is_told(tmp_path: Path, map_: Map) -> None:
    with pytest.raises(InputError, match="the map is empty"):
        export(Map(), Parameters(), "svg", str(tmp_path / "x.svg"))
    places, map_.locations = map_.locations, []
    with pytest.raises(InputError, match="no dock"):
        export(map_, Parameters(), "nav2-docks", str(tmp_path / "x.yaml"))
    with pytest.raises(InputError, match="no no-go areas"):
        export(map_, Parameters(), "nav2-keepout", str(tmp_path / "x.pgm"))
    map_.locations = places


@pytest.mark.parametrize("time", [-5.0, 1e10, 1e300])
def test_stamps_that_ros_does_not_have(tmp_path: Path, time: float) -> None:
    session = oort.Session(Parameters())
    session.start()
    for k in range(3):
        session.add_scan(room_scan(0.0, 0.0, 0.3 * k, time + k))
    with pytest.raises(InputError, match="none that a message of ROS can have"):
        export(session.map, Parameters(), "mcap", str(tmp_path / "x.mcap"))
    assert not list(tmp_path.iterdir())


def test_without_the_packages_rooms_are_left_out(
    tmp_path: Path, map_: Map, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "shapely", None)
    export(map_, Parameters(), "svg", str(tmp_path / "x.svg"))
    assert "rooms are left out: rooms need the package shapely: pip install 'oort[export]'" in caplog.text
