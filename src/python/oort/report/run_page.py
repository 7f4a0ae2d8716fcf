# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The data of report.html: what a run left, gathered for the page."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import Map, OccupancyGrid, Parameters, parameter_table
from oort.evaluation.attempts import Attempt
from oort.evaluation.truth import Judgement
from oort.report.arrays import pack
from oort.report.layers import (
    area_layer,
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


def run_page_data(
    report: Mapping[str, Any],
    parameters: Parameters,
    map_: Map,
    grid: OccupancyGrid | None,
    attempts: Sequence[Attempt],
    log: ScanLog,
    base_poses: NDArray[np.float64],
    judgement: Judgement | None = None,
) -> dict[str, Any]:
    """What the page of a run shows. ``base_poses`` are T_map_base, (n, 3), of the scans in ``log``."""
    return {
        "page_version": PAGE_VERSION,
        "name": report["input"],
        "kind": report["kind"],
        "recorded_seconds": report["recorded_seconds"],
        "figures": table_rows(report),
        "notes": list(report["notes"]),
        "odometry_faults": report.get("odometry_faults", {"count": 0, "first": []}),
        "parameters": parameters.to_dict(),
        "changed_parameters": changed_parameters(parameters),
        "grid": None if grid is None or not grid.cells.size else grid_layer(grid),
        "nodes": node_layer(map_),
        "edges": edge_layer(map_),
        "closures": closure_layer(map_, attempts),
        "places": place_layer(map_),
        "rooms": room_layer(map_, grid),
        "areas": area_layer(map_),
        "samples": _samples(log, base_poses),
        "truth": None if judgement is None else truth_layer(judgement, thinned(log, MOST_SAMPLES)[0], base_poses),
    }


def changed_parameters(parameters: Parameters) -> list[dict[str, Any]]:
    """Parameters that differ from the defaults, in the order of the table."""
    return [
        {"path": entry.path, "value": parameters.get(entry.path), "default": entry.default}
        for entry in parameter_table()
        if parameters.get(entry.path) != entry.default
    ]


def _samples(log: ScanLog, base_poses: NDArray[np.float64]) -> dict[str, Any]:
    rows, columns = thinned(log, MOST_SAMPLES)
    begin = float(columns["time"].min()) if len(rows) else 0.0
    return {
        "begin": begin,
        "scans": len(log.times),
        "states": list(TRACKING_STATES),
        "time": pack(columns["time"] - begin, "f4"),
        "pose": pack(base_poses[rows].reshape(-1, 3), "f4"),
        "state": pack(columns["state"], "u1"),
        **{name: pack(columns[name], "f4") for name in ("inlier_ratio", "local_ms", "waited_ms")},
    }
