# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A small picture of histograms."""

import io
import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from PIL import Image, ImageDraw, ImageFont

from oort.errors import InputError
from oort.export.files import write_atomically

_WIDTH, _HEIGHT, _MARGIN = 380, 190, 16  # [px] of a panel
_COLUMNS = 2
_TOP, _BOTTOM = 44, 22  # [px] for the title and for the limits of the bins
_FONT_SIZE, _SMALL = 14, 11
_BAR, _INK, _PAPER = (40, 90, 200), (30, 30, 30), (255, 255, 255)
_LABELS = 7  # limits of bins that are written, at most


class Panel(NamedTuple):
    """One histogram."""

    title: str
    edges: Sequence[float]
    """the lower limit of each bin; the last holds all from there on"""
    counts: Sequence[float]


def write_chart(path: str | os.PathLike[str], panels: Sequence[Panel]) -> None:
    """Writes a PNG with the panels, two in a row; the same panels give the same bytes.

    Raises InputError if there is none, or one has not as many counts as limits; OortError if the file cannot be
    written.
    """
    if not panels:
        raise InputError("a chart needs at least one histogram")
    columns, rows = min(_COLUMNS, len(panels)), math.ceil(len(panels) / _COLUMNS)
    image = Image.new("RGB", (columns * _WIDTH, rows * _HEIGHT), _PAPER)
    draw = ImageDraw.Draw(image)
    for k, panel in enumerate(panels):
        if not panel.edges or len(panel.edges) != len(panel.counts):
            raise InputError(f"{panel.title}: {len(panel.counts)} counts do not fit {len(panel.edges)} bins")
        _draw_panel(draw, panel, k % _COLUMNS * _WIDTH + _MARGIN, k // _COLUMNS * _HEIGHT)
    buffer = io.BytesIO()
    image.save(buffer, format="PNG")
    write_atomically(Path(path), buffer.getvalue())


def _draw_panel(draw: ImageDraw.ImageDraw, panel: Panel, left: int, top: int) -> None:
    font, small = ImageFont.load_default(_FONT_SIZE), ImageFont.load_default(_SMALL)
    total, most = sum(panel.counts), max(max(panel.counts), 1)
    draw.text((left, top + 8), panel.title, fill=_INK, font=font)
    draw.text((left, top + 27), f"{total:g}, at most {most:g} in a bin", fill=_INK, font=small)
    base, height = top + _HEIGHT - _BOTTOM, _HEIGHT - _TOP - _BOTTOM
    step = (_WIDTH - 2 * _MARGIN) / len(panel.edges)
    every = math.ceil(len(panel.edges) / _LABELS)
    for k, (edge, count) in enumerate(zip(panel.edges, panel.counts, strict=True)):
        x = left + k * step
        if count:  # at least one pixel: a single outlier must be seen
            tall = max(1.0, height * count / most)
            begin = round(x) + 1
            end = max(begin, round(x + step) - 1)  # many bins are narrower than a pixel
            draw.rectangle((begin, round(base - tall), end, base), fill=_BAR)
        if k % every == 0:
            draw.text((x, base + 4), f"{edge:g}", fill=_INK, font=small)
    draw.line((left, base, left + _WIDTH - 2 * _MARGIN, base), fill=_INK)
