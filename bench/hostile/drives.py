# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs share: a drive through a room, as it should be or with what no sensor says in it."""

from collections.abc import Callable
from typing import Any

import numpy as np

import oort
from oort import Parameters, Session, load_map, save_map
from oort.errors import OortError
from oort.localization import Localizer
from oort.recording import Scan

Readings = Callable[[np.ndarray[Any, np.dtype[np.float32]]], None]


def scan_at(k: int, *, change: Readings | None = None, jump: float = 0.0, range_max: float = 30.0) -> Scan:
    """The k-th scan of a drive through a room of 5 m by 4 m, with readings changed and odometry moved."""
    x, theta, bearings = 0.02 * (k % 100), 0.02 * k, -np.pi / 2 + np.arange(180) * np.pi / 180
    c, s = np.cos(theta + bearings), np.sin(theta + bearings)
    with np.errstate(divide="ignore"):
        ranges = np.minimum(np.where(c > 0, (3.0 - x) / c, (-2.0 - x) / c), np.where(s > 0, 2.5 / s, -1.5 / s))
    values = ranges.astype(np.float32)
    if change is not None:
        change(values)
    limits = -np.pi / 2, np.pi / 180, 0.05, range_max
    return Scan(values, *limits, 0.1 * k, stamp=f"{0.1 * k:.1f}", odometry=(x + jump, 0.0, theta))


def write_log(path: str, scans: int) -> None:
    """The begin of the drive as a CARMEN log."""
    with open(path, "w") as stream:
        for k in range(scans):
            scan = scan_at(k)
            ranges = " ".join(f"{reading:.2f}" for reading in scan.ranges.tolist())
            x, y, theta = scan.odometry
            pose = f"{x:.6f} {y:.6f} {theta:.6f}"
            stream.write(f"FLASER {len(scan.ranges)} {ranges} {pose} {pose} {scan.time:.1f} host {scan.time:.1f}\n")


def driven(scans: int = 60, change: Readings | None = None, range_max: float = 30.0) -> Session:
    """A session that mapped a drive."""
    session = Session(Parameters())
    session.start()
    for k in range(scans):
        session.add_scan(scan_at(k, change=change, range_max=range_max))
    return session


def refused(work: Callable[[], object]) -> str:
    """The sentence with which something is refused."""
    try:
        work()
    except OortError as error:
        return str(error)
    raise AssertionError("not refused")


def drawn(session: Session) -> str:
    """Stops, and draws and saves and loads the map."""
    session.stop()
    grid, _ = oort.render_map(session.map, Parameters())
    assert grid.width * grid.height * grid.resolution**2 < 2000.0, f"{grid.width} x {grid.height} cells"
    save_map("drawn", session.map)
    Localizer(load_map("drawn"), Parameters())
    return f"{session.mapper.num_nodes} nodes, {grid.width} x {grid.height} cells"
