# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How well scans and closures matched, and how far a solved map's edges are off: the histograms of report.json."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort._core import ODOMETRY_EDGE, SWITCH_ON, Map
from oort.evaluation.graph import squared_errors
from oort.export.chart import Panel

INLIER_EDGES = tuple(k / 20 for k in range(20))
"""Lower limits of the bins of inlier ratios. The last bin of a histogram is all from its limit on."""
CHI2_EDGES = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
"""Likewise of chi^2: 7.8 is the 95 % limit of three degrees of freedom."""
_TITLES = {
    ("inlier_ratio", "scans"): "inlier ratio of tracked scans",
    ("inlier_ratio", "closures"): "inlier ratio of closures",
    ("inlier_ratio", "rejected"): "inlier ratio of rejected closures",
    ("chi2", "laser"): "chi2 of matched edges",
    ("chi2", "odometry"): "chi2 of odometry edges",
    ("chi2", "closures"): "chi2 of closures that are on",
    ("chi2", "switched_off"): "chi2 of closures undone",
}


def make_histograms(
    map_: Map, scans: Sequence[float], rejected: Sequence[float] = ()
) -> dict[str, dict[str, list[float]]]:
    """Counts by inlier ratio and by chi^2 (squared Mahalanobis distance), as report.json has them.

    `scans` are the inlier ratios of the scans that were matched, `rejected` those of closures that were rejected
    though there was a match. The edges' chi^2 are at the map's poses; a switch
    takes nothing from it.
    """
    chain, closures = map_.edges, map_.switchable_edges
    chain_chi2, closure_chi2 = _chi_squared(map_, chain), _chi_squared(map_, closures)
    odometry, off = chain["type"] == ODOMETRY_EDGE, closures["switch"] < SWITCH_ON
    return {
        "inlier_ratio": {
            "edges": list(INLIER_EDGES),
            "scans": _count(scans, INLIER_EDGES),
            "closures": _count(map_.loop_results["hit_fraction"], INLIER_EDGES),
            "rejected": _count(rejected, INLIER_EDGES),
        },
        "chi2": {
            "edges": list(CHI2_EDGES),
            "laser": _count(chain_chi2[~odometry], CHI2_EDGES),
            "odometry": _count(chain_chi2[odometry], CHI2_EDGES),
            "closures": _count(closure_chi2[~off], CHI2_EDGES),
            "switched_off": _count(closure_chi2[off], CHI2_EDGES),
        },
    }


def panels(histograms: dict[str, dict[str, list[float]]]) -> list[Panel]:
    """What to draw of them: those that count anything."""
    return [
        Panel(title, histograms[quantity]["edges"], histograms[quantity][kind])
        for (quantity, kind), title in _TITLES.items()
        if any(histograms[quantity][kind])
    ]


def _chi_squared(map_: Map, edges: dict[str, NDArray[Any]]) -> NDArray[np.float64]:
    poses = map_.node_poses
    return squared_errors(poses[edges["i"]], poses[edges["j"]], edges["pose"], edges["covariance"])


def _count(values: ArrayLike, edges: Sequence[float]) -> list[float]:
    """How many values are at or above each limit and below the next."""
    bins = np.searchsorted(edges, np.asarray(values, dtype=np.float64), side="right") - 1
    counts: list[float] = np.bincount(np.clip(bins, 0, None), minlength=len(edges)).tolist()
    return counts
