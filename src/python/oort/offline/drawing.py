# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Draws any map: one that is too wide for a grid is cropped to where things are, or drawn coarser, and that is told."""

import numpy as np
from numpy.typing import NDArray

from oort._core import Map, OccupancyGrid, Parameters, render_map
from oort.errors import InputError
from oort.poses import compose

_RESOLUTION = "output_map.probability_grid.resolution"
_COARSEST = 1.0  # [m]
_FEW = 1e-3  # of the points: so many on each side may be strays
_MARGIN = 0.2  # of a side of the box around the others: what lies so near is no stray
_STRAY = 4.0  # a map that is so many times as large with its strays as without them is cropped

Box = tuple[float, float, float, float]
"""x_min, y_min, x_max, y_max [m]."""


def draw_map(map_: Map, parameters: Parameters) -> tuple[tuple[OccupancyGrid, OccupancyGrid], list[str]]:
    """As render_map(), but for a map that does not fit into a grid; and notes of what was done about that.

    Raises ParameterError, and InputError where nothing at all can be drawn.
    """
    try:
        return render_map(map_, parameters), []
    except InputError as error:
        refusal = error
    wanted = float(parameters.get(_RESOLUTION))
    within, notes = _crop(map_)
    resolution = wanted
    while resolution <= _COARSEST:
        try:
            grids = render_map(map_, _with_resolution(parameters, resolution), within)
        except InputError:
            resolution = min(2.0 * resolution, _COARSEST) if resolution < _COARSEST else np.inf
            continue
        if resolution != wanted:
            notes.append(f"the map is too large for cells of {wanted:g} m: drawn with cells of {resolution:g} m")
        return grids, notes
    raise refusal


def _crop(map_: Map) -> tuple[Box | None, list[str]]:
    """Where things are, if a few strays lie far from there, and a note of these."""
    poses = map_.node_poses
    clouds = [_returns(map_, k) for k in range(len(map_))]
    points = np.concatenate([poses[:, :2], *clouds])
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return None, []
    low, high = np.quantile(points, [_FEW, 1.0 - _FEW], axis=0)
    margin = _MARGIN * (high - low) + 1.0
    low, high = low - margin, high + margin
    whole = np.prod(points.max(axis=0) - points.min(axis=0))
    if np.isfinite(poses).all() and whole <= _STRAY * np.prod(high - low):
        return None, []
    inside = ((points >= low) & (points <= high)).all(axis=1)
    nodes = int((~((poses[:, :2] >= low) & (poses[:, :2] <= high)).all(axis=1)).sum())
    note = (
        f"the picture is cropped to {high[0] - low[0]:.0f} x {high[1] - low[1]:.0f} m, where things are: "
        f"{int((~inside).sum())} points, {nodes} of them places of the robot, lie up to "
        f"{np.abs(points - (low + high) / 2.0).max():.0f} m off"
    )
    return (float(low[0]), float(low[1]), float(high[0]), float(high[1])), [note]


def _returns(map_: Map, k: int) -> NDArray[np.float64]:
    """(m, 2) where the beams of a node ended on the map."""
    cloud = map_.cloud(k)
    returns = cloud[cloud[:, 2] == 1.0]
    returns[:, 2] = 0.0
    return compose(map_.node_poses[k], returns)[:, :2] if len(returns) else returns[:, :2]


def _with_resolution(parameters: Parameters, resolution: float) -> Parameters:
    copy = Parameters()
    for path, value in parameters.to_dict().items():
        copy.set(path, value)
    copy.set(_RESOLUTION, resolution)
    return copy
