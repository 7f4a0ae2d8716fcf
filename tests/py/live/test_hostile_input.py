# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What no sensor says, pushed into a LiveMapper in the middle of a drive: told of, and what comes after is mapped."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest

from helpers.scenes import room_scan
from oort import InputError, LaserScan, LiveMapper, OortError, render_map
from oort._core import Parameters
from oort.recording import Scan

HALF = 60  # scans before, and after


@dataclass
class Drive:
    """A LiveMapper on a drive, and what it told."""

    troubles: list[str] = field(default_factory=list)
    k: int = 0

    def __post_init__(self) -> None:
        self.mapper = LiveMapper(on_trouble=self.troubles.append)

    def scan(self) -> Scan:
        return room_scan(0.01 * self.k, 0.0, 0.02 * self.k, 0.1 * self.k)

    def go_on(self, scans: int = HALF) -> None:
        for _ in range(scans):
            scan = self.scan()
            self.mapper.push_odometry(scan.time, scan.odometry)
            self.mapper.push_scan(scan)
            self.k += 1


def changed(scan: Scan, **values: object) -> LaserScan:
    names = ("ranges", "angle_min", "angle_increment", "range_min", "range_max", "time")
    return LaserScan(**{name: values.get(name, getattr(scan, name)) for name in names})  # type: ignore[arg-type]


def odd(**values: object) -> Callable[[Drive], None]:
    """Scans in which some fields are odd."""

    def push(drive: Drive) -> None:
        for _ in range(5):
            scan = drive.scan()
            drive.mapper.push_odometry(scan.time, scan.odometry)
            drive.mapper.push_scan(changed(scan, **values))
            drive.k += 1

    return push


def odometry(*pose: float) -> Callable[[Drive], None]:
    """Odometry that is off for some scans."""

    def push(drive: Drive) -> None:
        for _ in range(5):
            scan = drive.scan()
            drive.mapper.push_odometry(scan.time, pose)
            drive.mapper.push_scan(scan)
            drive.k += 1

    return push


def stamps(*times: float) -> Callable[[Drive], None]:
    """Scans and odometry with odd stamps, beside those of the drive."""

    def push(drive: Drive) -> None:
        for stamp in times:
            scan = drive.scan()
            drive.mapper.push_scan(changed(scan, time=stamp))

    return push


NAN, INF = math.nan, math.inf
SCANS = {
    "nan": odd(ranges=np.full(180, NAN)),
    "inf": odd(ranges=np.full(180, INF)),
    "minus inf": odd(ranges=np.full(180, -INF)),
    "negative": odd(ranges=np.full(180, -1.0)),
    "zeros": odd(ranges=np.zeros(180)),
    "far": odd(ranges=np.full(180, 1e20), range_max=INF),
    "1e6 m": odd(ranges=np.full(180, 1e6), range_max=INF),
    "no beams": odd(ranges=[]),
    "one beam": odd(ranges=[1.0]),
    "a million beams": odd(ranges=np.full(1_000_000, 2.0), angle_increment=math.pi / 1e6),
    "more than a million beams": odd(ranges=np.full(1_000_001, 2.0), angle_increment=math.pi / 1e6),
    "fewer beams": odd(ranges=np.full(90, 2.0)),
    "increment 0": odd(angle_increment=0.0),
    "increment nan": odd(angle_increment=NAN),
    "increment inf": odd(angle_increment=INF),
    "increment 1e300": odd(angle_increment=1e300),
    "increment -1e300": odd(angle_increment=-1e300),
    "angle nan": odd(angle_min=NAN),
    "angle 1e300": odd(angle_min=1e300),
    "limits nan": odd(range_min=NAN, range_max=NAN),
    "limits crossed": odd(range_min=5.0, range_max=1.0),
    "stamps of the past": stamps(0.0, -1e9, -1.0),
    "stamps of years ahead": stamps(1e9, 4e9, 1e18),
    "stamps that are none": stamps(NAN, INF, -INF),
    "stamps repeated": stamps(5.9, 5.9, 5.9),
    "odometry 99,999 m off": odometry(99_999.0, 0.0, 0.0),
    "odometry 1e300": odometry(1e300, -1e300, 0.0),
    "odometry turned by 1e300": odometry(0.6, 0.0, 1e300),
    "odometry denormal": odometry(5e-324, 1e-313, 1e-320),
}


@pytest.mark.parametrize("name", SCANS)
def test_what_is_hostile_is_forgotten(name: str) -> None:
    drive = Drive()
    drive.go_on()
    try:
        SCANS[name](drive)
    except OortError as error:
        assert isinstance(error, InputError)
    drive.go_on()
    drive.mapper.map()  # with all that came before
    nodes = len(drive.mapper.map())
    pose = drive.mapper.pose()
    drive.mapper.close()
    truth = room_scan(0.01 * (drive.k - 1), 0.0, 0.02 * (drive.k - 1), 0.0).odometry
    assert pose is not None
    np.testing.assert_allclose(pose[:2], truth[:2], atol=0.1, err_msg=f"{drive.troubles}")
    assert nodes >= 5
    grid, _ = render_map(drive.mapper.map(), Parameters())
    assert grid.width * grid.height < 200 * 200
    scans = drive.mapper._live.figures
    assert scans.scans_arrived >= 2 * HALF
    assert sum(scans.drops.counts.values()) == 0 or drive.troubles, "scans were left out in silence"


def test_scans_at_500_hz_are_not_left_out() -> None:
    drive = Drive()
    started = time.monotonic()
    for k in range(1000):
        scan = drive.scan()
        drive.mapper.push_odometry(k / 500, scan.odometry)
        drive.mapper.push_scan(changed(scan, time=k / 500))
        drive.k = k // 50
        time.sleep(max(0.0, started + k / 500 - time.monotonic()))
    drive.mapper.map()
    assert sum(drive.mapper._live.figures.drops.counts.values()) == 0, drive.troubles
    drive.mapper.close()


def test_many_scans_that_wait_for_odometry_cost_little() -> None:
    drive = Drive()
    for k in range(3000):
        drive.mapper.push_scan(changed(drive.scan(), time=1.0 + k / 355))
    started = time.thread_time()
    for k in range(1000):
        drive.mapper.push_odometry(0.9 * k / 1000, (0.0, 0.0, 0.0))
    assert time.thread_time() - started < 1.0, "each message of odometry asks all scans that wait"
    drive.mapper.close()
