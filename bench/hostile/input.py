# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Readings, odometry, numbers and names that cannot be."""

import contextlib
import math
import time
from pathlib import Path
from typing import Any

import numpy as np

from hostile.drives import drawn, driven, refused, scan_at
from oort import Parameters, Session, load_map, save_map
from oort.errors import OortError
from oort.localization import Localizer
from oort.mapper import Mapper
from oort.recording import Scan
from oort.saved_maps import open_map


def nul_in_map_path(inputs: Path) -> str:
    Path("precious.txt").write_text("precious")
    said = refused(lambda: save_map("precious.txt\0", driven(5).map))
    refused(lambda: open_map("precious.txt\0"))
    refused(lambda: Session(Parameters()).start("precious.txt\0"))
    assert Path("precious.txt").read_text() == "precious"
    return said


def far_reading_localiser(inputs: Path) -> str:
    def far(ranges: Any) -> None:
        ranges[90:93] = 1e20, 1e6, 3e38

    def door(ranges: Any) -> None:
        ranges[80:100] = math.inf

    localizer = Localizer(driven(60, door).map, Parameters())
    localizer.start_at((0.0, 0.0, 0.0), 0.01 * np.eye(3))
    started = time.monotonic()
    for k in range(60):
        scan = scan_at(k, change=far, range_max=math.inf)
        localizer.add_scan(scan, scan.odometry)
    seconds = (time.monotonic() - started) / 60
    assert localizer.state == "tracking", localizer.state
    assert seconds < 0.05, f"{seconds} s a scan"
    return f"{1e3 * seconds:.1f} ms a scan"


def far_reading_mapped(inputs: Path) -> str:
    def far(ranges: Any) -> None:
        ranges[90] = 1e6

    return drawn(driven(60, far, math.inf))


def readings_of_5_km(inputs: Path) -> str:
    def far(ranges: Any) -> None:
        ranges[::20] = 5000.0

    return drawn(driven(60, far, math.inf))


def odometry_99999_m_off(inputs: Path) -> str:
    def other_room(ranges: Any) -> None:
        ranges += 0.7 * ranges % 1.0

    session = driven()
    for k in range(60, 70):
        with contextlib.suppress(OortError):
            session.add_scan(scan_at(k, change=lambda ranges: ranges.fill(math.inf), jump=99_999.0))
    for k in range(70, 80):
        with contextlib.suppress(OortError):
            session.add_scan(scan_at(k, change=other_room, jump=99_999.0))
    for k in range(80, 130):
        session.add_scan(scan_at(k))
    return drawn(session)


def map_over_1_gib(inputs: Path) -> str:
    bearings = np.linspace(-np.pi / 2, np.pi / 2, 500_000)
    ranges = (3.0 + 0.5 * np.sin(5 * bearings)).astype(np.float32)
    parameters = Parameters()
    parameters.set("global_slam_thread", False)
    mapper = Mapper(parameters)
    limits = -np.pi / 2, np.pi / 500_000, 0.05, 30.0
    for k in range(100):
        try:
            scan = Scan(ranges, *limits, 0.1 * k, stamp=f"{0.1 * k:.1f}", odometry=(0.0, 0.0, 0.5 * k))
            if k:
                mapper.resume_from_paused()  # the first scan of a segment is matched with nothing, which takes a second
            mapper.add_scan(scan, scan.odometry)
        except OortError as error:
            return f"scan {k}: {error}"
    map_ = mapper.map()
    try:
        save_map("large", map_)
    except OortError as error:
        return str(error)
    assert len(load_map("large")) == len(map_)
    return f"{len(map_)} nodes saved and loaded"
