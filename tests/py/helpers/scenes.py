# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Scans of made-up rooms."""

import numpy as np

from oort.recording import Scan


def room_scan(x: float, y: float, theta: float, time: float) -> Scan:
    """What 180 beams see in a room of 5 m by 4 m with a corner cut off by a box, from a pose that odometry knows."""
    bearings = -np.pi / 2 + np.arange(180) * np.pi / 180
    heading = theta + bearings
    c, s = np.cos(heading), np.sin(heading)
    with np.errstate(divide="ignore"):
        walls = np.minimum(
            np.where(c > 0, (3.0 - x) / c, (-2.0 - x) / c), np.where(s > 0, (2.5 - y) / s, (-1.5 - y) / s)
        )
    box = (1.5 + 0.6 - x - y) / (c + s)  # the line x + y = 2.1 stands for a sofa across the corner
    ranges = np.where((box > 0) & (box < walls), box, walls).astype(np.float32)
    limits = -np.pi / 2, np.pi / 180, 0.05, 6.0
    return Scan(ranges, *limits, time, stamp=f"{time:.6f}", odometry=(x, y, theta))
