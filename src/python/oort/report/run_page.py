# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The data of report.html: what a run left, gathered for the page."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import Map, OccupancyGrid, Parameters, parameter_table
from oort.evaluation.attempts import Attempt
from oort.evaluation.truth import Judgement
from oort.export.beside import Beside
from oort.report.arrays import pack
from oort.report.layers import (
    area_layer,
    beside_layer,
    closure_layer,
    edge_layer,
    grid_layer,
    node_layer,
    place_layer,
    room_layer,
    truth_layer,
)
from oort.report.replay_report import table_rows
from oort.report.scan_log import TRACKING_STATES, ScanLog, thinned

PAGE_VERSION = 1
"""of the data within the page"""

MOST_SAMPLES = 20_000
"""rows of the timeline: an hour at 5 Hz"""


@dataclass(frozen=True, eq=False)
class Way:
    """Each scan of the run."""

    log: ScanLog
    base_poses: NDArray[np.float64]
    """T_map_base, (n, 3)"""
    carriers: NDArray[np.int64]
    """(n,) the node that it is carried by, -1 of none"""
    uses_odometry: bool = True


def run_page_data(
    report: Mapping[str, Any],
    parameters: Parameters,
    map_: Map,
    grid: OccupancyGrid | None,
    beside: Beside | None,
    attempts: Sequence[Attempt],
    way: Way,
    judgement: Judgement | None = None,
) -> dict[str, Any]:
    """What the page of a run shows. ``beside`` is the drawn map with its loose parts, None if there is no drawing."""
    return {
        "page_version": PAGE_VERSION,
        "name": report["input"],
        "kind": report["kind"],
        "recorded_seconds": report["recorded_seconds"],
        "figures": table_rows(report),
        "notes": list(report["notes"]),
        "troubles": [{"text": trouble["text"], "advice": trouble["advice"]} for trouble in report.get("troubles", [])],
        "odometry_faults": report.get("odometry_faults", {"count": 0, "first": []}),
        "parameters": parameters.to_dict(),
        "changed_parameters": changed_parameters(parameters),
        "grid": None if grid is None or beside is None else grid_layer(grid, beside),
        "beside": None if beside is None else beside_layer(beside),
        "nodes": node_layer(map_),
        "edges": edge_layer(map_),
        "closures": closure_layer(map_, attempts),
        "places": place_layer(map_),
        "rooms": room_layer(map_, grid),
        "areas": area_layer(map_),
        "samples": _samples(way),
        "truth": None if judgement is None else _truth(judgement, way),
    }


def changed_parameters(parameters: Parameters) -> list[dict[str, Any]]:
    """Parameters that differ from the defaults, in the order of the table."""
    return [
        {"path": entry.path, "value": parameters.get(entry.path), "default": entry.default}
        for entry in parameter_table()
        if parameters.get(entry.path) != entry.default
    ]


def _truth(judgement: Judgement, way: Way) -> dict[str, Any]:
    return truth_layer(judgement, thinned(way.log, MOST_SAMPLES)[0], way.base_poses)


def _samples(way: Way) -> dict[str, Any]:
    rows, columns = thinned(way.log, MOST_SAMPLES)
    begin = float(columns["time"].min()) if len(rows) else 0.0
    return {
        "begin": begin,
        "scans": len(way.log.times),
        "states": list(TRACKING_STATES),
        "time": pack(columns["time"] - begin, "f4"),
        "pose": pack(way.base_poses[rows].reshape(-1, 3), "f4"),
        "node": pack(way.carriers[rows], "i4"),
        "state": pack(columns["state"], "u1"),
        **{name: pack(columns[name], "f4") for name in ("inlier_ratio", "local_ms", "waited_ms")},
        **({name: pack(columns[name], "f4") for name in ("way_scale", "turn_scale")} if way.uses_odometry else {}),
    }
