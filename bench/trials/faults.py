# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry that fails once: how long is the robot lost, and is the map right afterwards?"""

import numpy as np
from numpy.typing import NDArray

from oort.poses import between
from oort.simulate import Drive
from trials.jobs import ate_of
from trials.replays import Replayed

Figures = dict[str, float]

LOST = (0.15, float(np.radians(8.0)))
"""Lost is who is told to be elsewhere, seen from where he was just before the fault, than he is, by this [m] or [rad].

Where he was then is looked up in the map of the time, as the map around may be mended meanwhile.
"""

STEADY = 20
"""Found again is who is not lost for so many scans."""

PERIOD = 0.1  # [s] from scan to scan


def measure_fault(drive: Drive, replayed: Replayed) -> Figures:
    """How long the pose told after each scan was off once the fault began, and the map's error from then on.

    And whether that was told too: of how many scans that were lost, and of those that were not.
    """
    assert drive.fault_times is not None
    begin, end = np.searchsorted(drive.scan_times, np.array(drive.fault_times) - 1e-6).tolist()
    before = max(0, begin - 1)
    moved = between(drive.T_map_base[before], drive.T_map_base[begin:])
    told = between(replayed.T_map_mark_then[begin:], replayed.T_map_base_then[begin:])
    error = between(moved, told)
    off = (np.hypot(error[:, 0], error[:, 1]) > LOST[0]) | (np.abs(error[:, 2]) > LOST[1])
    first, found = lost_span(off)
    doubted = np.array([state != "tracking" for state in replayed.states[begin:]])
    return {
        "scans_lost": float(off.sum()),
        "scans_found": float((~off).sum()),
        "told_lost": float((off & doubted).sum()),
        "told_found": float((~off & doubted).sum()),
        "lost_s": PERIOD * (found - first),
        "recovered": float(found < len(off)),
        "ate_after": ate_of(drive, replayed.T_map_base, slice(end, None)).position_rmse,
    }


def lost_span(off: NDArray[np.bool_]) -> tuple[int, int]:
    """From when to when one is lost, as places in ``off``; the length of it stands for never found again."""
    if not off.any():
        return 0, 0
    first = int(np.argmax(off))
    for found in range(first, len(off) - STEADY + 1):
        if not off[found : found + STEADY].any():
            return first, found
    return first, len(off)
