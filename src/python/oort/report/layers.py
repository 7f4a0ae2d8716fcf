# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the page shows of a map, as plain data: nodes, edges, closures, scans, places."""

import base64
import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from oort._core import SWITCH_ON, Map, OccupancyGrid
from oort.areas import areas_of_map, is_area
from oort.errors import OortError
from oort.evaluation.attempts import FOLDED, Attempt
from oort.evaluation.truth import Judgement
from oort.export.beside import Beside
from oort.export.map_server import grey_picture
from oort.export.named_rooms import named_rooms
from oort.export.walls import fit_walls
from oort.poses import between, wrap_angle
from oort.report.arrays import pack

MOST_REJECTED = 3000
"""rejected attempts that the page shows: those with the best inlier ratios"""

MOST_NODES_OF_ROOMS = 1000
"""of a map that the page shows rooms of: they are found in homes, and fitting walls takes seconds beyond"""

MOST_RELATIONS = 1000
"""that the page shows: those that are farthest off"""

_STEP = 0.005  # [m] of the points of scans
_MOST_POINTS = 1_500_000  # of all scans together: some 6 MB
_CHAIN_KINDS = ("laser", "odometry")


def grid_layer(grid: OccupancyGrid, beside: Beside) -> dict[str, Any]:
    """The map with its loose parts as a PNG, with its place."""
    buffer = io.BytesIO()
    Image.fromarray(grey_picture(beside.cells)).save(buffer, format="PNG", optimize=True)
    height, width = beside.cells.shape
    return {
        "png": base64.b64encode(buffer.getvalue()).decode("ascii"),
        "resolution": grid.resolution,
        "origin": list(grid.origin),
        "size": [width, height],
    }


def beside_layer(beside: Beside) -> dict[str, Any]:
    """How far each node is drawn from its pose, NaN if it is not drawn, and the number of its part; the captions."""
    return {
        "shift": pack(beside.shift, "f4"),
        "part": pack(beside.part, "i4"),
        "captions": [{"text": text, "place": list(place)} for text, place in beside.captions],
    }


def node_layer(map_: Map) -> dict[str, Any]:
    """Poses of the nodes and their scans: points in steps of ``step`` metres in the frames of the sensor."""
    points, offsets = _scans(map_)
    return {
        "poses": pack(map_.node_poses, "f4"),
        "points": pack(np.round(points / _STEP), "i2"),
        "offsets": pack(offsets, "i4"),
        "step": _STEP,
    }


def edge_layer(map_: Map) -> dict[str, Any]:
    """The chain's edges with the deviation of their positions [m]."""
    edges = map_.edges
    covariances = edges["covariance"]
    sigma = np.sqrt(np.maximum(covariances[:, 0, 0] + covariances[:, 1, 1], 0.0)) if len(edges["i"]) else np.zeros(0)
    return {
        "ends": pack(np.stack([edges["i"], edges["j"]], axis=1), "i4"),
        "sigma": pack(sigma, "f4"),
        "kind": pack(edges["type"], "u1"),
        "kinds": list(_CHAIN_KINDS),
    }


def closure_layer(map_: Map, attempts: Sequence[Attempt]) -> dict[str, Any]:
    """Every closure of the map, and the most convincing of the attempts that were rejected.

    ``ends`` are the older node, in whose frame ``pose`` has the newer one, and that one; ``moved`` is how far [m] and
    by what angle [rad] the solution has it elsewhere.
    """
    edges = map_.switchable_edges
    count = len(edges["i"])
    known = {(a.query, a.candidate): a.inlier_ratio for a in attempts if a.switch is not None}
    ends = np.stack([edges["i"], edges["j"]], axis=1).astype(np.int64).reshape(-1, 2)
    ratios = [known.get((i, j), known.get((j, i), np.nan)) for i, j in ends.tolist()]
    rejected = [a for a in attempts if a.switch is None and a.verdict != FOLDED]
    shown = sorted(rejected, key=lambda a: -a.inlier_ratio)[:MOST_REJECTED]
    verdicts = ["accepted", "undone", *sorted({a.verdict for a in shown})]
    on = edges["switch"] >= SWITCH_ON
    codes = [*np.where(on, 0, 1).tolist(), *(verdicts.index(a.verdict) for a in shown)]
    base = [*ends.min(axis=1).tolist(), *(a.candidate for a in shown)]
    moving = [*ends.max(axis=1).tolist(), *(a.query for a in shown)]
    measured = edges["pose"].reshape(-1, 3)
    newer = ends[:, :1] > ends[:, 1:]  # its scan was matched with those around the older one
    measured = np.where(newer, between(measured, np.zeros(3)), measured)
    poses = np.concatenate([measured, np.array([a.T_candidate_query for a in shown]).reshape(-1, 3)])
    return {
        "ends": pack(np.stack([base, moving], axis=1).reshape(-1, 2), "i4"),
        "pose": pack(poses, "f4"),
        "moved": pack(_moved(map_, np.array(base, dtype=np.int64), np.array(moving, dtype=np.int64), poses), "f4"),
        "verdict": pack(codes, "u1"),
        "verdicts": verdicts,
        "inlier_ratio": pack([*ratios, *(a.inlier_ratio for a in shown)], "f4"),
        "switch": pack([*edges["switch"].tolist(), *[np.nan] * len(shown)], "f4"),
        "in_map": count,
        "rejected": len(rejected),
    }


def place_layer(map_: Map) -> list[dict[str, Any]]:
    """Named places, docks among them."""
    found = ((space, id_, map_.locate(space, id_)) for space, id_, *_ in map_.locations if not is_area(space))
    return [{"space": space, "id": id_, "pose": list(pose)} for space, id_, pose in found if pose is not None]


def area_layer(map_: Map) -> list[dict[str, Any]]:
    """Areas and lines where the robot shall not go."""
    return [{"kind": area.kind, "name": area.name, "points": area.points} for area in areas_of_map(map_)]


def room_layer(map_: Map, grid: OccupancyGrid | None) -> list[dict[str, Any]]:
    """The rooms of a map of a home's size; none without scipy and shapely."""
    if grid is None or len(map_) > MOST_NODES_OF_ROOMS:
        return []
    found = ((space, id_, map_.locate(space, id_)) for space, id_, *_ in map_.locations)
    places = [(space, id_, pose) for space, id_, pose in found if pose is not None]
    try:
        rooms = named_rooms(fit_walls(map_), grid, places)
    except OortError:
        return []
    return [{"label": named.label, "outline": np.round(named.room.outline, 3).tolist()} for named in rooms]


def truth_layer(judgement: Judgement, rows: NDArray[np.int64], base_poses: NDArray[np.float64]) -> dict[str, Any]:
    """How far each row of the timeline is off the truth, and the worst relations; ``rows`` are their first scans."""
    shown = np.argsort(-judgement.relation_off, kind="stable")[:MOST_RELATIONS]
    ends = base_poses[judgement.relation_ends[shown], :2]
    row_of = np.searchsorted(rows, judgement.relation_ends[:, 1], side="right") - 1
    worst = np.full(len(rows), np.nan)
    np.fmax.at(worst, row_of, judgement.relation_off)
    return {
        "true": None if judgement.true is None else pack(judgement.true[rows, :2], "f4"),
        "off": None if judgement.off is None else pack(judgement.off[rows], "f4"),
        "turned": None if judgement.turned is None else pack(judgement.turned[rows], "f4"),
        "relation_off_at": pack(worst, "f4") if len(judgement.relation_off) else None,
        "relation_ends": pack(ends.reshape(-1, 4), "f4"),
        "relation_off": pack(judgement.relation_off[shown], "f4"),
        "relations": len(judgement.relation_off),
    }


def _moved(
    map_: Map, base: NDArray[np.int64], moving: NDArray[np.int64], poses: NDArray[np.float64]
) -> NDArray[np.float64]:
    if not len(base):
        return np.zeros((0, 2))
    solved = between(map_.node_poses[base], map_.node_poses[moving])
    distance = np.linalg.norm(solved[:, :2] - poses[:, :2], axis=1)
    return np.stack([distance, np.abs(wrap_angle(solved[:, 2] - poses[:, 2]))], axis=1)


def _scans(map_: Map) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns of all nodes, (m, 2), and where each node's begin (and the last one's end)."""
    returns = [cloud[cloud[:, 2] == 1.0, :2] for cloud in map_.clouds]
    stride = max(1, -(-sum(map(len, returns)) // _MOST_POINTS))
    returns = [points[::stride] for points in returns]
    offsets = np.concatenate([[0], np.cumsum([len(points) for points in returns], dtype=np.int64)])
    return np.concatenate([np.zeros((0, 2)), *returns]), offsets.astype(np.int64)
