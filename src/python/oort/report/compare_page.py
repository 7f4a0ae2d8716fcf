# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""compare.html: two runs side by side and over each other."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from oort.report.arrays import pack, unpack
from oort.report.page import make_page

_FRAMES = 1.0  # [s] between samples of two runs that still mean the same scan


def compare_page_data(a: Mapping[str, Any], b: Mapping[str, Any], names: tuple[str, str]) -> dict[str, Any]:
    """What the page for the data of two reports shows; ``names`` tell them apart."""
    return {
        "page_version": a["page_version"],
        "names": list(names),
        "runs": [dict(a), dict(b)],
        "figures": _side_by_side(dict(a["figures"]), dict(b["figures"])),
        "parameters": [row for row in _side_by_side(a["parameters"], b["parameters"]) if row[1] != row[2]],
        "apart": trajectories_apart(a, b),
    }


def make_compare_page(data: Mapping[str, Any]) -> bytes:
    """The page of the data."""
    scripts = ("data.js", "map.js", "timeline.js", "compare.js")
    return make_page("compare.html", scripts, f"Oort: {' and '.join(data['names'])}", data)


def trajectories_apart(a: Mapping[str, Any], b: Mapping[str, Any]) -> dict[str, Any]:
    """How far apart two runs of one drive have the base at the same time [m], without aligning them.

    Empty where the two have no time in common.
    """
    times, positions = zip(*(_stamped(run["samples"]) for run in (a, b)), strict=True)
    if not len(times[0]) or not len(times[1]):
        return {"time": pack([], "f4"), "distance": pack([], "f4")}
    order = np.argsort(times[1], kind="stable")
    later = np.clip(np.searchsorted(times[1][order], times[0]), 1, max(1, len(order) - 1))
    nearest = np.where(
        np.abs(times[1][order][later - 1] - times[0])
        <= np.abs(times[1][order][np.minimum(later, len(order) - 1)] - times[0]),
        later - 1,
        np.minimum(later, len(order) - 1),
    )
    match = order[nearest]
    common = np.abs(times[1][match] - times[0]) <= _FRAMES
    distance = np.linalg.norm(positions[0][common] - positions[1][match[common]], axis=1)
    return {"time": pack(times[0][common] - times[0][0], "f4"), "distance": pack(distance, "f4")}


def _stamped(samples: Mapping[str, Any]) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    return samples["begin"] + unpack(samples["time"]).astype(np.float64), unpack(samples["pose"])[:, :2]


def _side_by_side(a: Mapping[str, Any], b: Mapping[str, Any]) -> list[list[Any]]:
    return [[name, a.get(name), b.get(name)] for name in dict.fromkeys([*a, *b])]
