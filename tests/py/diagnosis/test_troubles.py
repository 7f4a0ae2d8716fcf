# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a recording or a setup is named, and nothing else."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from helpers.hall import MOUNT as HALL_MOUNT
from helpers.hall import hall_drive
from oort import Parameters
from oort.diagnosis import Observer, Trouble
from oort.poses import Array, between, compose, wrap_angle
from oort.recording import Pose, Scan
from oort.session import Session
from oort.simulate import Drive, Sensor, SimulationConfig, simulate_drive

MOUNT = (0.109, 0.0, 0.0)
DRIVE = simulate_drive(7, SimulationConfig(minutes=0.5))


def scans_of(drive: Drive) -> list[Scan]:
    """Without a file in between."""
    return [
        Scan(
            ranges,
            drive.angle_min,
            drive.angle_increment,
            drive.range_min,
            drive.range_max,
            time,
            stamp=f"{time:.6f}",
            odometry=_pose(pose),
        )
        for ranges, time, pose in zip(drive.ranges, drive.scan_times.tolist(), drive.T_odom_base_at_scans, strict=True)
    ]


def _pose(values: Array) -> Pose:
    x, y, theta = values.tolist()
    return x, y, theta


def troubles_of(scans: Sequence[Scan], mount: Pose = MOUNT) -> dict[str, Trouble]:
    session = Session(Parameters(), mount)
    session.start()
    for scan in scans:
        session.add_scan(scan)
        session.observe(scan)
    session.stop()
    return {trouble.code: trouble for trouble in session.troubles()}


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_of_a_sound_robot_nothing_is_told(seed: int) -> None:
    assert troubles_of(scans_of(simulate_drive(seed, SimulationConfig(minutes=0.5)))) == {}


def mirrored(scan: Scan) -> Scan:
    return replaced(scan, ranges=scan.ranges[::-1])


def replaced(scan: Scan, ranges: ArrayLike) -> Scan:
    return Scan(
        np.array(ranges, dtype=np.float32),
        scan.angle_min,
        scan.angle_increment,
        scan.range_min,
        scan.range_max,
        scan.time,
        stamp=scan.stamp,
        odometry=scan.odometry,
    )


def turned_wrongly(scan: Scan) -> Scan:
    x, y, theta = scan.odometry
    return replace(scan, odometry=(x, y, -theta))


def standing(scan: Scan) -> Scan:
    return replace(scan, odometry=(0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("code", "spoil"),
    [("turn_sign", mirrored), ("turn_sign", turned_wrongly), ("odometry_static", standing)],
)
def test_odometry_against_scans(code: str, spoil: Callable[[Scan], Scan]) -> None:
    found = troubles_of([spoil(scan) for scan in scans_of(DRIVE)])
    assert code in found
    assert next(iter(found)) == code, "the cause comes first"


@pytest.mark.parametrize("degrees", [180, 90, -40])
def test_a_laser_that_looks_elsewhere_than_its_mount_says(degrees: int) -> None:
    x, y, _ = MOUNT
    found = troubles_of(scans_of(DRIVE), (x, y, math.radians(-degrees)))
    assert found["mount_yaw"].evidence["yaw_error_rad"] == pytest.approx(math.radians(degrees), abs=0.1) or (
        abs(degrees) == 180 and abs(found["mount_yaw"].evidence["yaw_error_rad"]) > 3.0
    )


def test_in_a_hall_nothing_is_told_of_a_sound_robot() -> None:
    assert troubles_of(hall_drive(), HALL_MOUNT) == {}


def test_in_a_hall_most_pairs_of_scans_fit() -> None:
    observer = Observer(HALL_MOUNT)
    for scan in hall_drive():
        observer.add(scan)
    assert np.mean([sample.fits for sample in observer.samples]) > 0.9
    apart = [between(sample.odometry, sample.scans) for sample in observer.samples if not sample.degenerate]
    assert np.median([math.hypot(x, y) for x, y, _ in apart]) < 0.02


@pytest.mark.parametrize("spoil", [mirrored, turned_wrongly])
def test_in_a_hall_scans_that_turn_the_other_way(spoil: Callable[[Scan], Scan]) -> None:
    assert next(iter(troubles_of([spoil(scan) for scan in hall_drive()], HALL_MOUNT))) == "turn_sign"


@pytest.mark.parametrize("degrees", [180, 90, -40])
@pytest.mark.parametrize("every", [1, 4], ids=["", "few scans"])
def test_in_a_hall_a_turned_laser(degrees: int, every: int) -> None:
    x, y, _ = HALL_MOUNT
    found = troubles_of(hall_drive()[::every], (x, y, math.radians(-degrees)))
    assert next(iter(found)) == "mount_yaw"
    assert not {code for code in found if code.startswith("odometry")}
    yaw = found["mount_yaw"].evidence["yaw_error_rad"]
    assert abs(wrap_angle(yaw - math.radians(degrees))) < 0.1


@pytest.mark.parametrize("scans_late", [10, -6])
def test_scans_and_odometry_of_different_clocks(scans_late: int) -> None:
    scans = scans_of(DRIVE)
    poses = [scan.odometry for scan in scans]
    shifted = [
        replace(scan, odometry=poses[min(max(k + scans_late, 0), len(poses) - 1)]) for k, scan in enumerate(scans)
    ]
    assert troubles_of(shifted)["clock_offset"].evidence["offset_s"] == pytest.approx(0.1 * scans_late, abs=0.1)


@pytest.mark.parametrize("scale", [0.9, 1.1])
def test_odometry_that_drives_too_far(scale: float) -> None:
    scaled = [replace(scan, odometry=_pose(np.array(scan.odometry) * (scale, scale, 1.0))) for scan in scans_of(DRIVE)]
    found = troubles_of(scaled)
    assert set(found) == {"odometry_translation_scale"}
    assert found["odometry_translation_scale"].evidence["scale"] == pytest.approx(1.0 / scale, abs=0.03)


def test_odometry_that_jumps() -> None:
    scans = scans_of(DRIVE)
    half = len(scans) // 2
    jumped = [
        scan if k < half else replace(scan, odometry=_pose(compose((3.0, 0.0, 0.0), scan.odometry)))
        for k, scan in enumerate(scans)
    ]
    jump = troubles_of(jumped)["odometry_jump"]
    assert jump.evidence["times"] == 1
    assert jump.evidence["distance_m"] == pytest.approx(3.0, abs=0.1)


def test_a_pause_is_no_gap() -> None:
    scans = scans_of(DRIVE)
    moving = next(k for k in range(200, len(scans)) if math.dist(scans[k].odometry, scans[k + 30].odometry) > 0.7)
    session = Session(Parameters(), MOUNT)
    session.start()
    for scan in scans[: moving + 1]:
        session.add_scan(scan)
        session.observe(scan)
    session.pause()
    session.resume_from_paused()
    for scan in scans[moving + 30 :]:
        session.add_scan(scan)
        session.observe(scan)
    session.stop()
    assert "scan_gap" not in {trouble.code for trouble in session.troubles()}


def test_scans_that_are_missing() -> None:
    scans = scans_of(DRIVE)
    moving = next(k for k in range(200, len(scans)) if math.dist(scans[k].odometry, scans[k + 30].odometry) > 0.7)
    gap = troubles_of(scans[: moving + 1] + scans[moving + 30 :])["scan_gap"]
    assert gap.evidence["longest_s"] == pytest.approx(3.0)
    assert f"the longest {scans[moving].time - scans[0].time:.1f} s after the first scan" in str(gap)


def test_body_and_beam_order() -> None:
    body = troubles_of(scans_of(simulate_drive(7, SimulationConfig(Sensor(body=math.radians(10)), minutes=0.5))))
    assert set(body) == {"body_in_view"}
    assert "--mask" in body["body_in_view"].advice


def test_a_drive_that_is_uncertain() -> None:
    empty = [replaced(scan, ranges=np.full(len(scan.ranges), np.inf)) for scan in scans_of(DRIVE)]
    scans = [*scans_of(DRIVE)[:50], *empty[50:]]
    assert set(troubles_of(scans)) == {"uncertain"}


def test_a_laser_that_sends_its_last_scan_again_is_told() -> None:
    scans = scans_of(DRIVE)
    stuck = [replaced(scan, ranges=scans[100].ranges) if 100 < k <= 120 else scan for k, scan in enumerate(scans)]
    told = troubles_of(stuck)
    assert list(told) == ["scan_repeated"]
    assert 15 <= told["scan_repeated"].evidence["times"] <= 20
