# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded drive, followed on a saved map."""

import time
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from oort._core import LocalizationState, Map, Parameters
from oort.errors import InputError
from oort.localization import Localizer, start_covariance
from oort.poses import compose
from oort.recording import Pose, Recording, Scan
from oort.report.stopwatch import Stopwatch


@dataclass(frozen=True, slots=True)
class Stretch:
    """Consecutive scans in one state of the localiser."""

    state: LocalizationState
    begin: str
    """stamp of the first scan [s]"""
    end: str
    """stamp of the last scan [s]"""
    scans: int


@dataclass
class LocalizedDrive:
    """A recorded drive, followed on a map. The lists have an entry for each scan whose pose is known."""

    recording: Recording
    localizer: Localizer
    watch: Stopwatch = field(default_factory=Stopwatch)
    stamps: list[str] = field(default_factory=list)
    base_poses: list[Pose] = field(default_factory=list)
    """T_map_base"""
    deviations: list[float] = field(default_factory=list)
    """largest standard deviation of the position [m]"""
    states: list[LocalizationState] = field(default_factory=list)
    stretches: list[Stretch] = field(default_factory=list)
    """of all scans, those without a pose too"""
    recorded_seconds: float = 0.0


def follow(
    recording: Recording, scans: Iterable[Scan], map_: Map, parameters: Parameters, start: Pose | None = None
) -> LocalizedDrive:
    """Follows the scans of a recording on a map, from about a pose T_map_sensor, or from a search of the whole map.

    Raises InputError if there is no scan, or the map is empty or contradicts itself.
    """
    recording.require_odometry("following a robot on a map")
    localizer = Localizer(map_, parameters, recording.sensor_on_base)
    if start is not None:
        localizer.start_at(start, start_covariance())
    drive = LocalizedDrive(recording, localizer)
    times: list[float] = []
    for scan in scans:
        if scan.mount is not None:
            localizer.add_scan_of_other(scan, scan.odometry, scan.mount)
            continue
        started = time.perf_counter()
        localizer.add_scan(scan, scan.odometry)
        drive.watch.scan_seconds.append(time.perf_counter() - started)
        times.append(scan.time)
        _note(drive, scan)
    if not times:
        raise InputError(f"{recording.name}: no scan to localise")
    drive.recorded_seconds = max(times) - min(times)
    return drive


def _note(drive: LocalizedDrive, scan: Scan) -> None:
    localizer = drive.localizer
    state = localizer.state
    last = drive.stretches[-1] if drive.stretches else None
    if last is not None and last.state == state:
        drive.stretches[-1] = Stretch(state, last.begin, scan.stamp, last.scans + 1)
    else:
        drive.stretches.append(Stretch(state, scan.stamp, scan.stamp, 1))
    if localizer.T_map_odom is not None:
        drive.stamps.append(scan.stamp)
        x, y, theta = compose(localizer.T_map_odom, scan.odometry).tolist()
        drive.base_poses.append((x, y, theta))
        drive.deviations.append(float(np.sqrt(np.linalg.eigvalsh(localizer.covariance[:2, :2])[-1])))
        drive.states.append(state)
