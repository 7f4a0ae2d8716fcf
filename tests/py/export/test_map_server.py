# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Grid maps as map_server has them."""

from pathlib import Path

import numpy as np
import pytest

from oort.errors import InputError
from oort.export import read_map_server, write_map_server

# Without any symmetry, and not square: the bottom row comes first.
CELLS = np.array([[0, 0, 100], [-1, 100, 0], [-1, -1, -1], [0, 100, 100]], dtype=np.int8)
ORIGIN = (-3.965497, 0.1 + 0.2, -0.5)


def test_round_trip(tmp_path: Path) -> None:
    write_map_server(tmp_path / "home.v2", CELLS, 0.05, ORIGIN)
    grid = read_map_server(tmp_path / "home.v2.yaml")
    np.testing.assert_array_equal(grid.cells, CELLS)
    assert grid.cells.dtype == np.int8
    assert (grid.resolution, grid.origin) == (0.05, ORIGIN)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["home.v2.pgm", "home.v2.yaml"]


def test_bytes(tmp_path: Path) -> None:
    write_map_server(tmp_path / "map", CELLS, 0.05, (-1.0, 1e-7, 0.0))
    expected = bytes([254, 0, 0, 205, 205, 205, 205, 0, 254, 254, 254, 0])  # the top row comes first
    assert (tmp_path / "map.pgm").read_bytes() == b"P5\n3 4\n255\n" + expected
    assert (tmp_path / "map.yaml").read_text() == (
        "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1.0, 0.0000001, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


@pytest.mark.parametrize("name", ["2026", "living room: #1", 'the "den"', "küche"])
def test_awkward_names(tmp_path: Path, name: str) -> None:
    write_map_server(tmp_path / name, CELLS, 0.05, ORIGIN)
    np.testing.assert_array_equal(read_map_server(tmp_path / f"{name}.yaml").cells, CELLS)


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        (np.array([[0, 50]]), "a cell holds 50; only 0 "),
        (np.zeros(3), r"not the shape \(3,\)"),
        (np.zeros((0, 3)), r"not the shape \(0, 3\)"),
    ],
)
def test_other_cells_are_refused(tmp_path: Path, cells: np.ndarray, message: str) -> None:
    with pytest.raises(InputError, match=message):
        write_map_server(tmp_path / "map", cells, 0.05, ORIGIN)
    assert not list(tmp_path.iterdir())


def test_negated_pictures(tmp_path: Path) -> None:
    write_map_server(tmp_path / "map", np.where(CELLS < 0, 0, CELLS), 0.05, ORIGIN)
    path = tmp_path / "map.yaml"
    path.write_text(path.read_text().replace("negate: 0", "negate: 1"))
    np.testing.assert_array_equal(read_map_server(path).cells, np.where(CELLS == 100, 0, 100))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("image: map.pgm\n", "", "no map description"),
        ("origin: [", "origin: [[", "no map description"),
        ("resolution: 0.05", "resolution: fine", "expected finite numbers"),
        ("origin: [-3.965497, ", "origin: [", "no map description"),
        ("mode: trinary", "mode: scale", "only maps of the mode trinary"),
        ("image: map.pgm", "image: other.pgm", "other.pgm, the picture of .*, cannot be read: No such file"),
    ],
)
def test_damaged_descriptions_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    write_map_server(tmp_path / "map", CELLS, 0.05, ORIGIN)
    path = tmp_path / "map.yaml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=message):
        read_map_server(path)


def test_a_cut_picture_is_refused(tmp_path: Path) -> None:
    write_map_server(tmp_path / "map", CELLS, 0.05, ORIGIN)
    picture = tmp_path / "map.pgm"
    for size in (0, 5, len(picture.read_bytes()) - 1):
        picture.write_bytes(picture.read_bytes()[:size])
        with pytest.raises(InputError, match=r"map\.pgm, the picture of .* cannot be read"):
            read_map_server(tmp_path / "map.yaml")


def test_a_map_of_map_saver(datasets: Path) -> None:
    grid = read_map_server(datasets / "kuri_oort_map/map.yaml")
    assert grid.cells.shape == (155, 186)
    assert grid.origin == (-3.965497, -2.201025, 0.0)
    assert [int(np.count_nonzero(grid.cells == value)) for value in (-1, 0, 100)] == [19654, 8827, 349]
