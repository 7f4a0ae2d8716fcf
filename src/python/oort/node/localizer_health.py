# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How localisation goes."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import LocalizationState
from oort.localization import Localizer
from oort.node.diagnostics import WARN, Health, Problem, number
from oort.recording import Pose


@dataclass(frozen=True, slots=True)
class Sighting:
    """What a localiser said after a scan; another thread may read it while the next scan is worked on."""

    state: LocalizationState | None = None
    """None before the first scan"""
    support: float | None = None
    T_map_sensor: Pose | None = None
    T_map_odom: Pose | None = None
    covariance: NDArray[np.float64] | None = None
    """(3, 3) of T_map_sensor, along the axes of the map; None while searching"""
    statistics: Mapping[str, Any] = field(default_factory=dict)
    reported_frame: Pose | None = None
    """of the scan, with which T_map_odom goes; see Scan"""

    @staticmethod
    def of(localizer: Localizer, reported_frame: Pose | None = None) -> "Sighting":
        """As it is now; ``reported_frame`` is that of its last scan."""
        pose = localizer.T_map_sensor
        covariance = None if pose is None else localizer.covariance
        return Sighting(
            localizer.state,
            localizer.support,
            pose,
            localizer.T_map_odom,
            covariance,
            localizer.statistics,
            reported_frame,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class LocalizerHealth(Health):
    """Of a localiser on a saved map."""

    map_path: str
    last: Sighting
    told_by_other: bool
    """whether another program, such as Oort's mapping, tells map -> odom"""

    @property
    def part(self) -> str:
        """What the node does."""
        return "localisation"

    @property
    def all_well(self) -> str:
        """The sentence when nothing is wrong."""
        if self.told_by_other:
            return "Another program tells map -> odom"
        return (
            "Tracking" if self.last.state == LocalizationState.TRACKING else "Uncertain; the map is searched meanwhile"
        )

    def problems(self) -> Iterator[Problem]:
        """What is wrong; a place that another program tells is not missed."""
        yield from self.problems_of_input()
        if self.last.state == LocalizationState.LOST and not self.told_by_other:
            yield WARN, "The place is lost; drive slowly to where more is in view, or tell the place on initialpose"
        if self.last.state == LocalizationState.SEARCHING and not self.told_by_other:
            rejections = _by_reason(self.last.statistics["search_rejections"])
            yield WARN, f"The place is not found yet ({rejections}); drive on, or tell it on initialpose"
        yield from self.problems_of_queue()

    def figures(self) -> Iterator[tuple[str, str]]:
        """Keys and values, always in this order."""
        statistics = self.last.statistics
        yield "state", self.last.state or "-"
        yield "map", self.map_path
        yield from self.figures_of_scans()
        yield "support", number(self.last.support, 2)
        position, heading = _deviations(self.last.covariance)
        yield "position deviation [m]", number(position, 3)
        yield "heading deviation [rad]", number(heading, 3)
        yield "scans matched", str(statistics.get("matched", 0))
        yield "matches rejected", _by_reason(statistics.get("match_rejections", {}))
        yield "searches", str(statistics.get("searches", 0))
        yield "searches rejected", _by_reason(statistics.get("search_rejections", {}))
        yield "jumps", str(statistics.get("jumps", 0))
        yield "map -> odom told by another", "yes" if self.told_by_other else "no"
        yield from self.figures_of_waiting()


def _deviations(covariance: NDArray[np.float64] | None) -> tuple[float | None, float | None]:
    """Standard deviations of the position [m], along its worst direction, and of the heading [rad]."""
    if covariance is None:
        return None, None
    return float(np.sqrt(np.linalg.eigvalsh(covariance[:2, :2])[-1])), float(np.sqrt(covariance[2, 2]))


def _by_reason(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{why} {n}" for why, n in sorted(counts.items())) or "-"
