# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The solved drive for Rerun, read back by its own reader; skipped without it, for it is large."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import oort
from helpers.scenes import room_scan
from oort import Map, Parameters
from oort.errors import InputError, OortError
from oort.offline.export import export

_TIMES = [100.0, 101.5, 103.25]
_SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (0.0, 0.5)]


def _map(times: list[float]) -> Map:
    session = oort.Session(Parameters())
    session.start()
    for k, time in enumerate(times):
        session.add_scan(room_scan(0.0, 0.0, 0.6 * k, time))
    return session.map


@pytest.fixture
def map_() -> Map:
    made = _map(_TIMES)
    made.locations = [
        ("dock", "home & <b>", 0, (0.1, 0.0, 0.5)),
        *(("no_go_area/carpet", str(k), 1, (x, y, 0.0)) for k, (x, y) in enumerate(_SQUARE)),
        ("no_go_line/stairs", "0", 1, (0.0, 1.0, 0.0)),
        ("no_go_line/stairs", "1", 1, (1.0, 1.0, 0.0)),
    ]
    return made


def _read(path: Path) -> dict[str, dict[str, list[Any]]]:
    """The columns of each entity, by the names of their components."""
    chunk = pytest.importorskip("rerun.chunk", reason="rerun-sdk is not installed")
    found: dict[str, dict[str, list[Any]]] = {}
    for each in chunk.RrdReader(path).stream():
        entity = found.setdefault(each.entity_path, {})
        for name, cells in each.to_record_batch().to_pydict().items():
            kept = name in ("node", "stamp") and name in entity  # each chunk of an entity has them
            entity.setdefault(name.split(":")[-1], []).extend([] if kept else cells)
    return found


def test_rerun_reads_the_solved_drive(tmp_path: Path, map_: Map) -> None:
    pytest.importorskip("rerun", reason="rerun-sdk is not installed")
    path = tmp_path / "drive.rrd"
    export(map_, Parameters(), "rerun", str(path))
    assert list(tmp_path.iterdir()) == [path]
    found = _read(path)
    drawn = {entity for entity in found if entity.startswith("/map")}
    assert drawn == {"/map/grid", "/map/trajectory", "/map/places", "/map/no_go", "/map/laser", "/map/scan"}

    grid = map_.render(Parameters()).map_cleaned
    told = found["/map/grid"]
    cells = np.array(told["data"][0][0], dtype=np.uint8).astype(np.int8)
    np.testing.assert_array_equal(cells.reshape(grid.cells.shape), grid.cells)
    assert told["cell_size"][0] == pytest.approx([grid.resolution])
    np.testing.assert_allclose(told["translation"][0][0], [*grid.origin, -0.1], rtol=1e-6)  # under the rest

    laser, scan, poses = found["/map/laser"], found["/map/scan"], map_.node_poses
    assert laser["node"] == scan["node"] == [0, 1, 2]
    stamps = [stamp.timestamp() for stamp in scan["stamp"]]
    assert stamps == pytest.approx(_TIMES)
    np.testing.assert_allclose(np.array(laser["translation"])[:, 0, :2], poses[:, :2], atol=1e-6)
    np.testing.assert_allclose([turned[0]["angle"] for turned in laser["rotation_axis_angle"]], poses[:, 2], atol=1e-6)
    x, y, theta = poses[2]
    cloud = map_.cloud(2)
    hits = cloud[cloud[:, 2] == 1.0, :2]
    turned = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    np.testing.assert_allclose(np.array(scan["positions"][2])[:, :2], hits @ turned.T + (x, y), atol=1e-5)

    assert found["/map/places"]["labels"] == [["dock/home & <b>"]]  # corners of areas are none
    np.testing.assert_allclose(found["/map/trajectory"]["strips"][0][0], np.c_[poses[:, :2], np.zeros(3)], atol=1e-6)
    carpet, stairs = found["/map/no_go"]["strips"][0]
    assert (len(carpet), carpet[0] == carpet[-1], len(stairs)) == (5, True, 2)


def test_stamps_that_rerun_does_not_have(tmp_path: Path) -> None:
    pytest.importorskip("rerun", reason="rerun-sdk is not installed")
    with pytest.raises(InputError, match="none that Rerun can have"):
        export(_map([1e10, 1e10 + 1.0]), Parameters(), "rerun", str(tmp_path / "x.rrd"))
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written(tmp_path: Path, map_: Map) -> None:
    pytest.importorskip("rerun", reason="rerun-sdk is not installed")
    with pytest.raises(OortError, match="cannot be written: No such file"):
        export(map_, Parameters(), "rerun", str(tmp_path / "none" / "x.rrd"))


def test_without_the_package_it_is_asked_for(tmp_path: Path, map_: Map, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(OortError, match=r"need the package rerun-sdk: pip install 'oort\[rerun\]'"):
        export(map_, Parameters(), "rerun", str(tmp_path / "x.rrd"))
    assert not list(tmp_path.iterdir())
