# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the page is told of a live session, as plain data. Reading never waits for the mapping."""

import time
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import SWITCH_ON, Map
from oort.areas import areas_of, is_area
from oort.errors import StateError
from oort.export.beside import Beside, set_beside
from oort.live import LiveSession
from oort.live.window import Window
from oort.poses import compose
from oort.recording import Scan
from oort.report.arrays import Packed, pack
from oort.report.layers import grid_layer
from oort.session import State

SAMPLES = 3000
"""rows of the charts that a page gets when it is opened: ten minutes"""

_BEAMS = 400  # of a scan, at most, that are shown


class Watch:
    """Looks at a live session."""

    def __init__(self, live: LiveSession, title: str, control: bool, clock: Callable[[], float] = time.time) -> None:
        """``title`` is what is shown; ``control``: whether the page may make calls."""
        self._live = live
        self._title = title
        self._control = control
        self._clock = clock
        self._shown: tuple[int, bytes | None] = (-1, None)
        self.samples: deque[list[float | None]] = deque(maxlen=SAMPLES)
        """time [s], scans in the queue, P50 and P99 [ms] of mapping a scan, P99 [ms] of a scan's delay, inlier ratio"""
        self._progress: float | None = None

    def state(self) -> dict[str, Any]:
        """The session now; takes a sample for the charts."""
        live = self._live
        snapshot, figures, drawing = live.snapshot, live.figures, live.gallery.drawing
        mapping, delays, result = _spread(figures.milliseconds), _spread(figures.delays), figures.last_result
        waiting, since = live.inbox.waiting()
        ratio = result.inlier_ratio if result is not None and result.was_tracked else None
        sample = [self._clock(), float(len(live.inbox)), mapping["p50"], mapping["p99"], delays["p99"], ratio]
        self.samples.append(sample)
        known = [(space, id, pose) for (space, id), pose in snapshot.places.items()]
        places = [{"space": space, "id": id, "pose": list(pose)} for space, id, pose in known if not is_area(space)]
        return {
            "title": self._title,
            "control": self._control,
            "state": snapshot.state.value,
            "tracking": figures.tracking(snapshot.state).value,
            "path": snapshot.path,
            "nodes": snapshot.num_nodes,
            "closures": snapshot.closures,
            "pose": None if result is None or snapshot.state is State.NOT_MAPPING else list(result.T_map_base),
            "scan": self._scan(),
            "queue": len(live.inbox),
            "waiting_for_odometry": [waiting, since],
            "scan_rate": figures.scan_rate,
            "mapping_ms": mapping,
            "delay_ms": delays,
            "scans": [figures.scans_mapped, figures.scans_arrived],
            "left_out": dict(figures.drops.counts),
            "while_paused": figures.scans_while_paused,
            "troubles": [str(trouble) for trouble in live.troubles],
            "failure": live.failure,
            "places": places,
            "areas": [{"kind": area.kind, "points": area.points} for area in areas_of(known)],
            "drawing": None if drawing is None or snapshot.num_nodes == 0 else drawing.revision,
            "progress": self._progress,
            "sample": sample,
        }

    def tell_progress(self, share: float) -> None:
        """Shows what share of a recording was played; unless told there is no end."""
        self._progress = share

    def map_layers(self) -> dict[str, Any]:
        """The newest drawing of the map with its graph. Raises StateError if there is none."""
        drawing = self._live.gallery.drawing
        if drawing is None or not drawing.grid.cells.size:
            raise StateError("there is no map yet")
        beside = set_beside(drawing.map, drawing.grid, self._live.gallery.parameters)
        return {"revision": drawing.revision, "grid": grid_layer(drawing.grid, beside), **_graph(drawing.map, beside)}

    def _scan(self) -> list[float]:
        """x, y, x, y ... [m]: where the newest scan's returns are on the map."""
        result, scan = self._live.figures.last_result, self._live.figures.last_scan
        if result is None or scan is None or self._live.snapshot.state is State.NOT_MAPPING:
            return []
        T_map_sensor = compose(result.T_map_base, self._live.sensor_on_base)
        points: list[float] = np.round(_placed(scan, T_map_sensor), 3).ravel().tolist()
        return points


def _placed(scan: Scan, pose: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    step = -(-len(scan.ranges) // _BEAMS) or 1
    ranges = scan.ranges[::step].astype(np.float64)
    bearings = scan.angle_min + scan.angle_increment * step * np.arange(len(ranges))
    kept = (ranges >= scan.range_min) & (ranges < scan.range_max)
    angles = pose[2] + bearings[kept]
    return np.stack([pose[0] + ranges[kept] * np.cos(angles), pose[1] + ranges[kept] * np.sin(angles)], axis=1)


def _graph(map_: Map, beside: Beside) -> dict[str, Any]:
    """Lines from node to node where they are drawn; ``shift`` is how far [m] that is from where the robot is now."""
    chain, loops = map_.edges, map_.switchable_edges
    on = loops["switch"] >= SWITCH_ON
    drawn = np.isfinite(beside.shift[:, 0])

    def lines(i: NDArray[np.uint64], j: NDArray[np.uint64]) -> Packed:
        return pack(beside.ends(i, j)[drawn[i]], "i4")

    return {
        "nodes": pack(map_.node_poses[:, :2] + beside.shift, "f4"),
        "chain": lines(chain["i"], chain["j"]),
        "closures": lines(loops["i"][on], loops["j"][on]),
        "undone": lines(loops["i"][~on], loops["j"][~on]),
        "captions": [{"text": text, "place": list(place)} for text, place in beside.captions],
        "shift": np.nan_to_num(beside.shift[-1]).tolist() if len(map_) else [0.0, 0.0],
    }


def _spread(window: Window) -> dict[str, float | None]:
    spread = window.spread
    if spread is None:
        return {"p50": None, "p99": None, "max": None}
    return {"p50": spread.p50, "p99": spread.p99, "max": spread.max}
