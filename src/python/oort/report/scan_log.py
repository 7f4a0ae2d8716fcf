# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What became of each scan of a drive, over time."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from oort._core import ScanResult, TrackingState

TRACKING_STATES = (*(state.value for state in TrackingState), "not mapped")
"""in the order of severity; codes are places in it"""

_NOT_MAPPED = len(TRACKING_STATES) - 1


@dataclass
class ScanLog:
    """One row per scan, in their order."""

    times: list[float] = field(default_factory=list)
    """stamps [s]"""
    states: list[int] = field(default_factory=list)
    """codes of TRACKING_STATES"""
    inlier_ratios: list[float] = field(default_factory=list)
    """nan for a scan that was not matched, or of which nothing lies on the local map"""
    seconds: list[float] = field(default_factory=list)
    """that local SLAM took; nan for a scan that was not mapped"""
    waited: list[float] = field(default_factory=list)
    """[s] that the scan waited for global SLAM; nan for a scan that was not mapped"""

    way_scales: list[float] = field(default_factory=list)
    """how far the base drives where odometry says 1, as learned; nan for a scan that was not mapped"""
    turn_scales: list[float] = field(default_factory=list)
    """likewise how far it turns"""

    def add(
        self,
        time: float,
        result: ScanResult | None,
        seconds: float = np.nan,
        waited: float = np.nan,
        scale: tuple[float, float] = (np.nan, np.nan),
    ) -> None:
        """Adds the next scan with what the mapper made of it (None: it was not mapping)."""
        self.times.append(time)
        self.states.append(_NOT_MAPPED if result is None else TRACKING_STATES.index(result.tracking))
        # The first scan of a segment is tracked, too, on a local map on which nothing is.
        matched = result is not None and result.was_tracked and result.inlier_ratio > 0.0
        self.inlier_ratios.append(result.inlier_ratio if result is not None and matched else np.nan)
        self.seconds.append(seconds)
        self.waited.append(waited)
        self.way_scales.append(scale[0])
        self.turn_scales.append(scale[1])

    @property
    def matched_inlier_ratios(self) -> NDArray[np.float64]:
        """Of the scans that were matched."""
        ratios = np.array(self.inlier_ratios, dtype=np.float64)
        return ratios[~np.isnan(ratios)]


def thinned(log: ScanLog, most: int) -> tuple[NDArray[np.int64], dict[str, NDArray[np.float64]]]:
    """The log in at most ``most`` rows: the scan that stands for each row, and the rows' figures.

    A row of several scans has the longest times, the lowest inlier ratio and the worst state of them, so that no
    short trouble is lost.
    """
    count = len(log.times)
    starts = np.unique(np.linspace(0, count, min(count, most), endpoint=False).astype(np.int64))
    states = np.maximum.reduceat(np.array(log.states, dtype=np.float64), starts) if count else np.zeros(0)
    columns = {"state": states}
    for name, values, worst in (
        ("inlier_ratio", log.inlier_ratios, np.fmin),
        ("local_ms", log.seconds, np.fmax),
        ("waited_ms", log.waited, np.fmax),
    ):
        array = np.array(values, dtype=np.float64) * (1e3 if name.endswith("_ms") else 1.0)
        columns[name] = worst.reduceat(array, starts) if count else array
    for name, values in (("way_scale", log.way_scales), ("turn_scale", log.turn_scales)):
        columns[name] = np.array(values, dtype=np.float64)[starts] if count else np.zeros(0)
    columns["time"] = np.array(log.times, dtype=np.float64)[starts] if count else np.zeros(0)
    return starts, columns
