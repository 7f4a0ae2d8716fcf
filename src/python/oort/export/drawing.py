# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Floor plans as SVG and DXF: walls as lines, places with their names, in metres."""

import io
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from oort.errors import OortError
from oort.export.files import write_atomically
from oort.recording.types import Pose

Places = Sequence[tuple[str, Pose]]
"""names with T_map_place"""

_MARGIN = 0.5  # [m]
_PIXELS = 100.0  # per metre, of an SVG that nobody scales


def write_svg(path: Path, walls: NDArray[np.float64], places: Places) -> None:
    """Writes walls (k, 4) x0, y0, x1, y1 [m] and places to an SVG of one unit per metre, y up in the map and down here.

    Raises OortError if the file cannot be written.
    """
    ends = np.concatenate([walls.reshape(-1, 2), np.array([pose[:2] for _, pose in places]).reshape(-1, 2)])
    low, high = (ends.min(axis=0) - _MARGIN, ends.max(axis=0) + _MARGIN) if len(ends) else (np.zeros(2), np.ones(2))
    width, height = (high - low).tolist()
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_PIXELS * width:.0f}" height="{_PIXELS * height:.0f}" '
        f'viewBox="{low[0]:.3f} {-high[1]:.3f} {width:.3f} {height:.3f}">',
        '<g id="walls" fill="none" stroke="#111" stroke-width="0.03" stroke-linecap="round">',
        *(f'<line x1="{a:.3f}" y1="{-b:.3f}" x2="{c:.3f}" y2="{-d:.3f}"/>' for a, b, c, d in walls.tolist()),
        "</g>",
        '<g id="places" fill="#b45309" font-family="sans-serif" font-size="0.2">',
        *(_svg_place(name, pose) for name, pose in places),
        "</g>",
        "</svg>",
        "",
    ]
    write_atomically(path, "\n".join(lines).encode())


def _svg_place(name: str, pose: Pose) -> str:
    x, y = pose[0], -pose[1]
    return (
        f'<circle cx="{x:.3f}" cy="{y:.3f}" r="0.06"/><text x="{x + 0.1:.3f}" y="{y + 0.06:.3f}">{escape(name)}</text>'
    )


def write_dxf(path: Path, walls: NDArray[np.float64], places: Places) -> None:
    """Writes walls (k, 4) x0, y0, x1, y1 [m] and places to a DXF (R2010, metres) with the layers WALLS and PLACES.

    Raises OortError if ezdxf is not installed or the file cannot be written.
    """
    try:
        from ezdxf import units
        from ezdxf.filemanagement import new
    except ImportError:
        raise OortError("DXF needs the package ezdxf: pip install 'oort[export]'") from None
    document = new("R2010")
    document.units = units.M
    for layer, colour in (("WALLS", 7), ("PLACES", 30)):
        document.layers.add(layer, color=colour)
    space = document.modelspace()
    for x0, y0, x1, y1 in walls.tolist():
        space.add_line((x0, y0), (x1, y1), dxfattribs={"layer": "WALLS"})
    for name, (x, y, theta) in places:
        space.add_circle((x, y), 0.06, dxfattribs={"layer": "PLACES"})
        text = space.add_text(name, height=0.15, rotation=float(np.degrees(theta)), dxfattribs={"layer": "PLACES"})
        text.set_placement((x + 0.1, y))
    stream = io.StringIO()
    document.write(stream)
    write_atomically(path, stream.getvalue().encode())
