# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Floor plans as SVG and DXF: walls as lines, rooms with their areas, no-go areas, named places, in metres."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from oort.areas import Area
from oort.errors import OortError
from oort.export.files import write_atomically
from oort.export.named_rooms import NamedRoom
from oort.recording.types import Pose

Places = Sequence[tuple[str, Pose]]
"""names with T_map_place"""


@dataclass(frozen=True)
class FloorPlan:
    """What a floor plan shows."""

    walls: NDArray[np.float64]
    """(k, 4) x0, y0, x1, y1 [m]"""
    places: Places = ()
    rooms: Sequence[NamedRoom] = ()
    areas: Sequence[Area] = ()

    def extent(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower left and upper right corner with a margin."""
        points = [self.walls.reshape(-1, 2), np.array([pose[:2] for _, pose in self.places]).reshape(-1, 2)]
        points += [named.room.outline for named in self.rooms] + [np.array(area.points) for area in self.areas]
        ends = np.concatenate(points)
        return (ends.min(axis=0) - _MARGIN, ends.max(axis=0) + _MARGIN) if len(ends) else (np.zeros(2), np.ones(2))


_MARGIN = 0.5  # [m]
_PIXELS = 100.0  # per metre, of an SVG that nobody scales


def write_svg(path: Path, plan: FloorPlan) -> None:
    """Writes a plan to an SVG of one unit per metre, y up in the map and down here.

    Raises OortError if the file cannot be written.
    """
    low, high = plan.extent()
    width, height = (high - low).tolist()
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_PIXELS * width:.0f}" height="{_PIXELS * height:.0f}" '
        f'viewBox="{low[0]:.3f} {-high[1]:.3f} {width:.3f} {height:.3f}">',
        '<g id="rooms" fill="#dbe7f5" stroke="none" font-family="sans-serif" font-size="0.25">',
        *(_svg_room(named) for named in plan.rooms),
        "</g>",
        '<g id="no-go" fill="#dc262640" stroke="#dc2626" stroke-width="0.04">',
        *(_svg_area(area) for area in plan.areas),
        "</g>",
        '<g id="walls" fill="none" stroke="#111" stroke-width="0.03" stroke-linecap="round">',
        *(f'<line x1="{a:.3f}" y1="{-b:.3f}" x2="{c:.3f}" y2="{-d:.3f}"/>' for a, b, c, d in plan.walls.tolist()),
        "</g>",
        '<g id="places" fill="#b45309" font-family="sans-serif" font-size="0.2">',
        *(_svg_place(name, pose) for name, pose in plan.places),
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


def _svg_room(named: NamedRoom) -> str:
    x, y = named.room.centre
    points = " ".join(f"{x:.3f},{-y:.3f}" for x, y in named.room.outline.tolist())
    text = f'<text x="{x:.3f}" y="{-y:.3f}" fill="#33507a" text-anchor="middle">{escape(named.label)}</text>'
    return f'<polygon points="{points}"/>{text}'


def _svg_area(area: Area) -> str:
    points = " ".join(f"{x:.3f},{-y:.3f}" for x, y in area.points)
    shape, fill = ("polygon", "") if area.kind == "no_go_area" else ("polyline", ' fill="none"')
    return f'<{shape} points="{points}"{fill}><title>{escape(area.name)}</title></{shape}>'


def write_dxf(path: Path, plan: FloorPlan) -> None:
    """Writes a plan to a DXF (R2010, metres) with the layers WALLS, ROOMS, NO_GO and PLACES.

    Raises OortError if ezdxf is not installed or the file cannot be written.
    """
    try:
        from ezdxf import units
        from ezdxf.filemanagement import new
    except ImportError:
        raise OortError("DXF needs the package ezdxf: pip install 'oort[export]'") from None
    document = new("R2010")
    document.units = units.M
    for layer, colour in (("WALLS", 7), ("ROOMS", 5), ("NO_GO", 1), ("PLACES", 30)):
        document.layers.add(layer, color=colour)
    space = document.modelspace()
    for x0, y0, x1, y1 in plan.walls.tolist():
        space.add_line((x0, y0), (x1, y1), dxfattribs={"layer": "WALLS"})
    for named in plan.rooms:
        space.add_lwpolyline(named.room.outline.tolist(), close=True, dxfattribs={"layer": "ROOMS"})
        space.add_text(named.label, height=0.2, dxfattribs={"layer": "ROOMS"}).set_placement(named.room.centre)
    for area in plan.areas:
        space.add_lwpolyline(area.points, close=area.kind == "no_go_area", dxfattribs={"layer": "NO_GO"})
    for name, (x, y, theta) in plan.places:
        space.add_circle((x, y), 0.06, dxfattribs={"layer": "PLACES"})
        text = space.add_text(name, height=0.15, rotation=float(np.degrees(theta)), dxfattribs={"layer": "PLACES"})
        text.set_placement((x + 0.1, y))
    stream = io.StringIO()
    document.write(stream)
    write_atomically(path, stream.getvalue().encode())
