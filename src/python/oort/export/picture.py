# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A picture of a map for people: the grid, the way, loop closures, named places and a scale bar."""

import io
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFont

from oort.areas import Area
from oort.export.files import write_atomically
from oort.export.map_server import grey_picture
from oort.recording.types import Pose

_LONG_SIDE = 1600  # [px] at most; at least half of it
_STRIP = 44  # [px] height of the legend below the map
_FONT_SIZE = 15
_ROW = 24  # [px] height of each further row of the legend
_ENTRIES_IN_A_ROW = 3  # at least, of the narrowest picture
_WAY, _START = (40, 90, 200), (20, 130, 220)
_ACCEPTED, _UNDONE = (0, 150, 60), (220, 40, 40)
_VERDICTS = {"contradicted": _UNDONE, "accepted": _ACCEPTED}
_REFUSED = (  # told apart from one another and from the two above
    (150, 150, 230),
    (230, 160, 60),
    (120, 200, 220),
    (200, 130, 200),
    (170, 140, 100),
    (240, 130, 160),
    (150, 170, 60),
    (110, 110, 110),
    (240, 210, 60),
    (90, 90, 180),
    (60, 140, 140),
    (190, 190, 190),
)
_UNKNOWN, _NO_GO = (205, 205, 205), (190, 40, 160)
_PLACE, _INK, _PAPER = (200, 90, 0), (30, 30, 30), (255, 255, 255)


def write_picture(
    path: str | os.PathLike[str],
    cells: ArrayLike,
    resolution: float,
    origin: Pose,
    *,
    trajectory: ArrayLike = (),
    accepted: ArrayLike = (),
    undone: ArrayLike = (),
    locations: Sequence[tuple[str, Pose]] = (),
    areas: Sequence[Area] = (),
    captions: Sequence[tuple[str, tuple[float, float]]] = (),
) -> None:
    """Writes a PNG, see draw_picture. Raises OortError too, if the file cannot be written."""
    png = draw_picture(
        cells,
        resolution,
        origin,
        trajectory=trajectory,
        accepted=accepted,
        undone=undone,
        locations=locations,
        areas=areas,
        captions=captions,
    )
    write_atomically(Path(path), png)


def draw_picture(
    cells: ArrayLike,
    resolution: float,
    origin: Pose,
    *,
    trajectory: ArrayLike = (),
    accepted: ArrayLike = (),
    undone: ArrayLike = (),
    locations: Sequence[tuple[str, Pose]] = (),
    areas: Sequence[Area] = (),
    captions: Sequence[tuple[str, tuple[float, float]]] = (),
) -> bytes:
    """Draws a PNG; the same arguments give the same bytes.

    `cells` (height, width), `resolution` [m] and `origin` are as in GridMap. `trajectory` is (n, 2 or more) with x, y
    [m] first, and a row of NaN where it is interrupted; `accepted` and `undone` are the ends of the loop closures that
    the solution keeps and of those that it switched off, (k, 2, 2) x, y [m]; `locations` are names with their poses,
    `areas` where the robot shall not go; `captions` are texts and where they begin. All are in the map's frame. Raises
    InputError for an unusable grid.
    """
    grid, scale = _scaled(grey_picture(cells))
    canvas = _Canvas(grid, resolution / scale, origin)
    for ends, colour in ((undone, _UNDONE), (accepted, _ACCEPTED)):
        for line in np.asarray(ends, dtype=np.float64).reshape(-1, 2, 2):
            canvas.line(line, colour, 2)
    way = np.asarray(trajectory, dtype=np.float64)
    if way.size:
        pieces = _pieces(way[:, :2])
        for piece in pieces:
            canvas.line(piece, _WAY, 2)
        if pieces:
            canvas.dot(pieces[0][0], _START, 5)
    for area in areas:
        canvas.area(area)
    for name, pose in locations:
        canvas.place(name, pose)
    for text, corner in captions:
        canvas.text(text, corner)
    canvas.legend(
        [
            ("trajectory", _WAY, way.size),
            ("start", _START, way.size),
            ("closures accepted", _ACCEPTED, np.asarray(accepted).size),
            ("closures undone", _UNDONE, np.asarray(undone).size),
            ("places", _PLACE, len(locations)),
            ("no-go areas", _NO_GO, len(areas)),
        ]
    )
    return _png(canvas)


def _pieces(way: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """What lies between rows that are not finite."""
    breaks = np.flatnonzero(~np.isfinite(way).all(axis=1))
    pieces = np.split(way, breaks)
    return [rows for piece in pieces if len(rows := piece[np.isfinite(piece).all(axis=1)])]


def write_closures_picture(
    path: str | os.PathLike[str],
    cells: ArrayLike,
    resolution: float,
    origin: Pose,
    closures: Mapping[str, ArrayLike],
) -> None:
    """Writes a PNG of the attempts to close loops, each verdict in a colour of its own; deterministic.

    `cells`, `resolution` and `origin` are as in GridMap. `closures` are the ends of the attempts by verdict, (k, 2, 2)
    x, y [m] in the map's frame: "accepted", "contradicted" (by the solution), and any reasons of refusals. Raises
    InputError for an unusable grid, OortError if the file cannot be written.
    """
    refused = sorted(set(closures) - set(_VERDICTS))
    colours = {reason: _REFUSED[k % len(_REFUSED)] for k, reason in enumerate(refused)} | _VERDICTS
    names = [name for name in colours if name in closures]
    grid, scale = _scaled(grey_picture(cells))
    canvas = _Canvas(grid, resolution / scale, origin, len(names))
    for name in names:  # what was accepted above what was refused
        for line in np.asarray(closures[name], dtype=np.float64).reshape(-1, 2, 2):
            canvas.line(line, colours[name], 2 if name in _VERDICTS else 1)
            canvas.dot(line[1], colours[name], 2)
    counts = {name: np.asarray(closures[name]).size // 4 for name in names}
    canvas.legend([(f"{name} {counts[name]}", colours[name], counts[name]) for name in reversed(names)])
    write_atomically(Path(path), _png(canvas))


def _png(canvas: "_Canvas") -> bytes:
    buffer = io.BytesIO()
    canvas.image.save(buffer, format="PNG")
    return buffer.getvalue()


def _scaled(grey: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], float]:
    """The grid at a legible size, and pixels per cell.

    Small grids are magnified; in large ones the darkest cell of a block stays, so that thin walls do not vanish.
    """
    long_side = max(grey.shape)
    if long_side <= _LONG_SIDE:
        factor = _LONG_SIDE // long_side
        return np.repeat(np.repeat(grey, factor, axis=0), factor, axis=1), float(factor)
    block = math.ceil(long_side / _LONG_SIDE)
    height, width = (math.ceil(side / block) for side in grey.shape)
    # The bottom row stays the bottom row: the map's origin is there.
    padding = ((height * block - grey.shape[0], 0), (0, width * block - grey.shape[1]))
    blocks = np.pad(grey, padding, constant_values=255).reshape(height, block, width, block)
    return blocks.min(axis=(1, 3)), 1.0 / block


class _Canvas:
    """Draws map coordinates onto the picture."""

    def __init__(self, grid: NDArray[np.uint8], metres_per_pixel: float, origin: Pose, legend_entries: int = 0) -> None:
        """With room below for so many entries of a legend, beyond those of one row."""
        height, width = grid.shape
        self._height = height
        self._metres_per_pixel = metres_per_pixel
        self._origin = origin
        self._font = ImageFont.load_default(_FONT_SIZE)
        rows = legend_entries // _ENTRIES_IN_A_ROW
        self.image = Image.new("RGB", (max(width, _LONG_SIDE // 2), height + _STRIP + rows * _ROW), _PAPER)
        self.image.paste(_UNKNOWN, (0, 0, self.image.width, height))  # a narrow map has nothing known beside it
        self.image.paste(Image.fromarray(grid).convert("RGB"), (0, 0))
        self._draw = ImageDraw.Draw(self.image)

    def _pixels(self, points: NDArray[np.float64]) -> list[tuple[float, float]]:
        """Columns and rows of points (n, 2) [m]."""
        x, y, theta = self._origin
        c, s = math.cos(theta), math.sin(theta)
        dx, dy = points[:, 0] - x, points[:, 1] - y
        columns = (c * dx + s * dy) / self._metres_per_pixel
        rows = self._height - (c * dy - s * dx) / self._metres_per_pixel
        return list(zip(columns.tolist(), rows.tolist(), strict=True))

    def line(self, points: NDArray[np.float64], colour: tuple[int, int, int], width: int) -> None:
        self._draw.line(self._pixels(points), fill=colour, width=width)

    def dot(self, point: NDArray[np.float64], colour: tuple[int, int, int], radius: float) -> None:
        ((x, y),) = self._pixels(point.reshape(1, 2))
        self._draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=colour, outline=_PAPER)

    def place(self, name: str, pose: Pose) -> None:
        """A dot with a tick that shows the heading, and the name on paper colour."""
        centre = np.array(pose[:2])
        tick = 14.0 * self._metres_per_pixel * np.array([math.cos(pose[2]), math.sin(pose[2])])
        self.line(np.stack([centre, centre + tick]), _PLACE, 3)
        self.dot(centre, _PLACE, 5)
        ((x, y),) = self._pixels(centre.reshape(1, 2))
        self._draw.text((x + 8, y - 20), name, fill=_INK, font=self._font, stroke_width=3, stroke_fill=_PAPER)

    def area(self, area: Area) -> None:
        """Its outline, or its line, and its name at the first corner."""
        corners = np.array([*area.points, area.points[0]] if area.kind == "no_go_area" else area.points)
        self.line(corners, _NO_GO, 3)
        self.text(area.name, area.points[0])

    def text(self, text: str, corner: tuple[float, float]) -> None:
        """Its lower left corner is there."""
        ((x, y),) = self._pixels(np.array([corner]))
        self._draw.text((x, y - 20), text, fill=_INK, font=self._font, stroke_width=3, stroke_fill=_PAPER)

    def legend(self, entries: Sequence[tuple[str, tuple[int, int, int], int]]) -> None:
        """The scale bar and, for what the picture holds, its colours, in the strip below the map."""
        metres = _round_length(0.2 * self.image.width * self._metres_per_pixel)
        end, baseline = 12 + metres / self._metres_per_pixel, self._height + _STRIP - 12
        self._draw.line((12, baseline, end, baseline), fill=_INK, width=3)
        for x in (12.0, end):
            self._draw.line((x, baseline - 6, x, baseline + 6), fill=_INK, width=3)
        self._draw.text((18, baseline - 24), f"{metres:g} m", fill=_INK, font=self._font)
        x = end + 32
        for name, colour, present in entries:
            if present:
                length = 36 + self._draw.textlength(name, font=self._font)
                if x + length > self.image.width:
                    x, baseline = 12.0, baseline + _ROW
                self._draw.rectangle((x, baseline - 10, x + 14, baseline + 4), fill=colour)
                self._draw.text((x + 20, baseline - 12), name, fill=_INK, font=self._font)
                x += length


def _round_length(metres: float) -> float:
    """The largest 1, 2 or 5 times a power of ten that is at most `metres`."""
    power = 10.0 ** math.floor(math.log10(metres))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= metres)
