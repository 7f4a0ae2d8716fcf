# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a map of which nothing tells where they lie on the rest."""

import numpy as np

from oort._core import Map
from oort.diagnosis.trouble import Trouble

_NODES = 4  # of a part that is told of: smaller ones see nothing that the rest needs


def loose_parts(map_: Map) -> list[Trouble]:
    """One for all of them, or none."""
    parts = [nodes for nodes in map_.loose_parts if len(nodes) >= _NODES]
    if not parts:
        return []
    poses, times = map_.node_poses, map_.cloud_times
    metres = sum(float(np.hypot(*np.diff(poses[nodes, :2], axis=0).T).sum()) for nodes in parts)
    # Of the map, whose first node a session that goes on with it may not have seen.
    first, last = (float(end([end(times[nodes]) for nodes in parts]) - times[0]) for end in (np.min, np.max))
    where = "it lies is not known, and it is" if len(parts) == 1 else "they lie is not known, and they are"
    what = "1 part" if len(parts) == 1 else f"{len(parts)} parts"
    return [
        Trouble(
            "loose_part",
            f"{what} of the drive, {metres:.1f} m from {first:.1f} s to {last:.1f} s after the first scan, could "
            f"not be tied to the rest of the map: where {where} left out of it (a replay's map.png shows it beside)",
            "drive on through places that were mapped before, or tell at the dock that the robot stands there",
            {"parts": len(parts), "nodes": sum(len(nodes) for nodes in parts), "metres": metres},
        )
    ]
