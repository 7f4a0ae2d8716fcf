# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Saved maps drawn for map_server."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from helpers.scenes import room_scan
from oort import Map, Parameters, Session, load_map, read_parameters, render_map, save_map
from oort.cli.main import main
from oort.export import read_map_server


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """A map of five nodes."""
    session = Session(Parameters())
    session.start(str(tmp_path / "room"))
    for step in range(5):
        session.add_scan(room_scan(-1.0 + 0.25 * step, 0.0, 0.0, 100.0 + step))
    session.stop()
    return tmp_path / "room"


def test_pictures_are_the_grids_cell_for_cell(saved: Path, tmp_path: Path) -> None:
    assert main(["render", f"{saved}.map_capnp", str(tmp_path / "flat")]) == 0
    grids = render_map(load_map(str(saved)), read_parameters())
    for grid, name in zip(grids, ("flat_map", "flat_map_cleaned"), strict=True):
        read = read_map_server(tmp_path / f"{name}.yaml")
        np.testing.assert_array_equal(read.cells, grid.cells)
        assert (read.resolution, read.origin) == (grid.resolution, (*grid.origin, 0.0))
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert (picture.format, picture.mode) == ("PNG", "L")
            assert set(np.unique(np.asarray(picture)).tolist()) == {0, 205, 254}


def test_parameters_count(saved: Path, tmp_path: Path) -> None:
    params = tmp_path / "params.json"
    params.write_text('{"output_map": {"probability_grid": {"resolution": 0.1}}}')
    assert main(["render", str(saved), str(tmp_path / "coarse"), str(params)]) == 0
    assert read_map_server(tmp_path / "coarse_map.yaml").resolution == 0.1


def test_what_cannot_be_drawn(saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = tmp_path / "empty"
    save_map(str(empty), Map())
    for map_, prefix, message in (
        (tmp_path / "none", tmp_path / "flat", "none"),
        (empty, tmp_path / "flat", "there is nothing to draw"),
        (saved, tmp_path / "empty.map_capnp/flat", "empty.map_capnp is no folder"),
    ):
        assert main(["render", str(map_), str(prefix)]) == 2
        error = capsys.readouterr().err
        assert error.startswith("oort render: ")
        assert message in error
    assert not list(tmp_path.glob("flat*"))
