# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a map shows itself in a notebook."""

import base64

import numpy as np

from oort._core import SWITCH_ON, Map, Parameters, render_map
from oort.areas import areas_of_map, is_area
from oort.export.picture import draw_picture


def map_png(map_: Map) -> bytes | None:
    """A PNG of the map with the sensor's trajectory, closures and places; None if it shows nothing."""
    grid = render_map(map_, Parameters())[1]
    if not grid.cells.size:
        return None
    edges, poses = map_.switchable_edges, map_.node_poses
    ends = np.stack([poses[edges["i"], :2], poses[edges["j"], :2]], axis=1)
    on = edges["switch"] >= SWITCH_ON
    places = ((f"{space}/{id}", map_.locate(space, id)) for space, id, *_ in map_.locations if not is_area(space))
    return draw_picture(
        grid.cells,
        grid.resolution,
        (*grid.origin, 0.0),
        trajectory=poses,
        accepted=ends[on],
        undone=ends[~on],
        locations=[(name, pose) for name, pose in places if pose is not None],
        areas=areas_of_map(map_),
    )


def map_html(map_: Map) -> str:
    """The picture, and what the map holds."""
    closures = len(map_.switchable_edges["id"])
    what = f"{len(map_)} nodes, {closures} closures, {len(map_.locations)} places"
    png = map_png(map_)
    if png is None:
        return f"<p>an Oort map: {what}; there is nothing to draw</p>"
    picture = base64.b64encode(png).decode("ascii")
    return f'<p>an Oort map: {what}</p><img alt="the map" src="data:image/png;base64,{picture}">'
