# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of a map: what is where, in pixels."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from oort.areas import make_area
from oort.errors import InputError
from oort.export import write_closures_picture, write_picture

CELLS = np.full((20, 40), -1, dtype=np.int8)
CELLS[2:18, 2:38] = 0
CELLS[2, 2:38] = 100  # the southern wall
ORIGIN = (-1.0, -0.5, 0.0)
SCALE = 40  # 1600 / 40 cells


def picture(path: Path, **things: object) -> np.ndarray:
    write_picture(path, CELLS, 0.05, ORIGIN, **things)  # type: ignore[arg-type]
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def pixel(x: float, y: float) -> tuple[int, int]:
    """Row and column of a point [m]."""
    return int(20 * SCALE - (y - ORIGIN[1]) / 0.05 * SCALE), int((x - ORIGIN[0]) / 0.05 * SCALE)


def test_the_grid_is_magnified_with_the_top_row_first(tmp_path: Path) -> None:
    image = picture(tmp_path / "map.png")
    assert image.shape[1] == 1600
    assert image.shape[0] > 800  # the legend lies below
    for (row, column), grey in {(0, 0): 205, (2, 20): 0, (3, 20): 254}.items():
        block = image[(19 - row) * SCALE : (20 - row) * SCALE, column * SCALE : (column + 1) * SCALE]
        assert np.unique(block).tolist() == [grey]


def test_what_is_drawn_lies_where_it_belongs(tmp_path: Path) -> None:
    image = picture(
        tmp_path / "map.png",
        trajectory=[[-0.5, 0.0, 1.0], [0.5, 0.0, 2.0]],
        accepted=[[[-0.5, 0.2], [0.5, 0.2]]],
        undone=[[[-0.5, -0.2], [0.5, -0.2]]],
        locations=[("dock/dock", (0.0, 0.3, 0.0))],
    )
    red, green, blue = (tuple(int(v) for v in image[pixel(0.0, y)]) for y in (-0.2, 0.2, 0.0))
    assert red[0] > 200 and red[1] < 100
    assert green[1] > 120 and green[0] < 50
    assert blue[2] > 180 and blue[0] < 100
    assert tuple(image[pixel(0.0, 0.3)]) == (200, 90, 0)
    row, column = pixel(0.0, 0.3)
    assert image[row - 25 : row, column + 5 : column + 90].min() < 60  # the name, dark, right above


def test_areas_are_outlines_and_lines(tmp_path: Path) -> None:
    square = make_area("no_go_area", "carpet", [(-0.6, -0.2), (-0.2, -0.2), (-0.2, 0.2), (-0.6, 0.2)])
    line = make_area("no_go_line", "stairs", [(0.2, 0.0), (0.6, 0.0), (0.6, 0.2)])
    image = picture(tmp_path / "map.png", areas=[square, line])
    for x, y, drawn in ((-0.6, 0.0, True), (-0.4, 0.0, False), (0.4, 0.0, True), (0.4, 0.1, False)):
        assert (tuple(image[pixel(x, y)]) == (190, 40, 160)) == drawn, (x, y)


def test_a_narrow_map_has_nothing_known_beside_it(tmp_path: Path) -> None:
    write_picture(tmp_path / "map.png", np.zeros((40, 10), dtype=np.int8), 0.05, ORIGIN)
    with Image.open(tmp_path / "map.png") as seen:
        assert seen.getpixel((seen.width - 1, 0)) == (205, 205, 205)


def test_same_input_same_bytes(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        picture(tmp_path / name, trajectory=[[0, 0], [0.3, 0.1]], locations=[("a", (0, 0, 0))])
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_turned_origin_turns_the_points(tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    write_picture(path, CELLS, 0.05, (0.0, 0.0, np.pi / 2), locations=[("", (-0.5, 1.0, 0.0))])
    with Image.open(path) as image:
        # 1 m along the map's y is 20 columns to the right; 0.5 m against its x is 10 rows up.
        assert image.getpixel((20 * SCALE, 10 * SCALE)) == (200, 90, 0)


def test_large_maps_shrink_but_keep_thin_walls(tmp_path: Path) -> None:
    cells = np.zeros((3300, 5), dtype=np.int8)
    cells[1000] = 100
    path = tmp_path / "map.png"
    write_picture(path, cells, 0.05, ORIGIN)
    with Image.open(path) as image:
        column = np.asarray(image.convert("L"))[:1100, 0]
    assert np.flatnonzero(column == 0).tolist() == [1100 - 1 - 1000 // 3]


def test_unusable_grids_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a cell holds 7"):
        write_picture(tmp_path / "map.png", np.full((2, 2), 7), 0.05, ORIGIN)


def test_each_verdict_on_a_closure_has_a_colour_of_its_own(tmp_path: Path) -> None:
    lines = {
        name: [[[-0.8, y], [0.8, y]]] for name, y in (("accepted", 0.2), ("contradicted", 0.1), ("ambiguous", 0.0))
    }
    lines |= {f"reason_{k}": [[[-0.8, -0.05 * k], [0.8, -0.05 * k]]] for k in range(1, 6)}
    for name in ("a.png", "b.png"):
        write_closures_picture(tmp_path / name, CELLS, 0.05, ORIGIN, lines)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    with Image.open(tmp_path / "a.png") as image:
        seen = np.asarray(image.convert("RGB"))
    colours = {name: tuple(seen[pixel(0.0, line[0][0][1])].tolist()) for name, line in lines.items()}
    assert len(set(colours.values())) == len(lines)
    assert colours["accepted"] == (0, 150, 60)
    assert colours["contradicted"] == (220, 40, 40)
    legend = seen[20 * SCALE :]
    for name, colour in colours.items():
        assert (legend == colour).all(axis=2).any(), name


def test_a_narrow_picture_has_room_for_a_long_legend(tmp_path: Path) -> None:
    lines = {f"a_reason_with_a_long_name_{k}": [[[0.0, 0.0], [0.1, 0.1]]] for k in range(12)}
    write_closures_picture(tmp_path / "map.png", np.zeros((400, 100), np.int8), 0.05, ORIGIN, lines)
    with Image.open(tmp_path / "map.png") as image:
        seen = np.asarray(image.convert("RGB"))
    bottom = seen[-6:]
    assert (bottom == 255).all()  # nothing is cut off
