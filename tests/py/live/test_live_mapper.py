# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The live loop of a program: scans and odometry from any thread."""

import threading
from pathlib import Path

import numpy as np
import pytest

import oort
from helpers.scenes import room_scan
from oort._core import OdometryBuffer
from oort.simulate import Drive


def push(live: oort.LiveMapper, scans: int = 60, first: int = 0) -> None:
    """Scans at 10 Hz, odometry at 20 Hz that is never stamped as a scan is."""
    for k in range(first, first + scans):
        live.push_scan(room_scan(0.01 * k, 0.0, 0.02 * k, 0.1 * k))
        for step in (-0.25, 0.25):
            at = k + step
            live.push_odometry(0.1 * at, (0.01 * at, 0.0, 0.02 * at))


def test_odometry_is_interpolated_at_the_scans_stamps(tmp_path: Path) -> None:
    with oort.LiveMapper(save_to=tmp_path / "map") as live:
        push(live)
        assert len(live.map()) > 0
        pose = live.pose()
        assert pose == pytest.approx((0.5925, 0.0, 1.185), abs=0.03)
        assert live.tracking == "tracking"
        assert live.T_map_odom == pytest.approx((0.0, 0.0, 0.0), abs=0.03)
    saved = oort.load_map(str(tmp_path / "map"))
    assert np.array_equal(saved.node_poses, live.map().node_poses)


def test_the_map_is_that_of_the_same_scans_one_by_one() -> None:
    mapper = oort.Mapper()
    for k in range(60):
        scan = room_scan(0.01 * k, 0.0, 0.02 * k, 0.1 * k)
        mapper.add_scan(scan, scan.odometry)
    mapper.finish()
    with oort.LiveMapper() as live:
        for k in range(60):
            scan = room_scan(0.01 * k, 0.0, 0.02 * k, 0.1 * k)
            live.push_odometry(scan.time, scan.odometry)
            live.push_scan(scan)
    assert np.array_equal(live.map().node_poses, mapper.map().node_poses)


def test_a_drive_is_mapped_with_the_odometry_at_each_stamp(drive: Drive) -> None:
    """Odometry at its own rate, in the order of the stamps, against a mapper that is given what lies between."""
    limits = drive.angle_min, drive.angle_increment, drive.range_min, drive.range_max
    scans = [oort.LaserScan(drive.ranges[k], *limits, t) for k, t in enumerate(drive.scan_times.tolist())]
    poses = list(zip(drive.odometry_times.tolist(), drive.T_odom_base, strict=True))
    mount = drive.T_base_sensor
    buffer, mapper = OdometryBuffer(), oort.Mapper(sensor_on_base=mount)
    for time, pose in poses:
        buffer.add(time, *pose)
    for scan in scans:
        odometry = buffer.lookup(scan.time)
        assert odometry is not None
        mapper.add_scan(scan, odometry)
    mapper.finish()
    with oort.LiveMapper(sensor_on_base=mount) as live:
        for scan in scans:
            while poses and poses[0][0] <= scan.time:
                live.push_odometry(*poses.pop(0))
            live.push_scan(scan)
        for time, pose in poses:
            live.push_odometry(time, pose)
    assert np.array_equal(live.map().node_poses, mapper.map().node_poses)


def test_scans_and_odometry_come_from_threads_of_their_own() -> None:
    with oort.LiveMapper() as live:

        def push_scans() -> None:
            for k in range(50):
                live.push_scan(room_scan(0.0, 0.0, 0.0, 0.1 * k))

        def push_odometry() -> None:
            for k in range(100):
                live.push_odometry(0.05 * k, (0.0, 0.0, 0.0))

        scans, odometry = threading.Thread(target=push_scans), threading.Thread(target=push_odometry)
        scans.start()
        odometry.start()
        while scans.is_alive() or odometry.is_alive():
            live.pose()
        scans.join()
        odometry.join()
        live.map()
        assert live.pose() == pytest.approx((0.0, 0.0, 0.0), abs=0.02)


def test_places_and_the_dock() -> None:
    with oort.LiveMapper() as live:
        push(live, 1)
        live.map()
        live.create_location("dock", "dock")
        push(live, 59, first=1)
        live.notify_docked()
        assert live.locate("dock", "dock") == pytest.approx((0.0, 0.0, 0.0), abs=0.05)
        with pytest.raises(oort.StateError, match=r"LiveMapper.locate: no place 'dock'/'b'; LiveMapper.map\(\)"):
            live.locate("dock", "b")


def test_a_pause_and_a_map_to_go_on_with(tmp_path: Path) -> None:
    with oort.LiveMapper(save_to=tmp_path / "first") as live:
        push(live, 30)
        live.pause()
        live.resume_from_paused()
        push(live, 30, first=30)
    nodes = len(live.map())
    second = oort.LiveMapper(save_to=tmp_path / "second", resume=(tmp_path / "first", (0.0, 0.0, 0.0)))
    push(second)
    second.close()
    second.close()
    assert len(oort.load_map(str(tmp_path / "second"))) > nodes == len(oort.load_map(str(tmp_path / "first")))


def test_saving_on_the_way(tmp_path: Path) -> None:
    with oort.LiveMapper() as live:
        push(live)
        with pytest.raises(oort.StateError, match=r"LiveMapper\.save: give a path"):
            live.save()
        live.save(tmp_path / "copy")
        assert len(oort.load_map(str(tmp_path / "copy"))) == len(live.map()) > 0
    live.save(tmp_path / "after")
    assert len(oort.load_map(str(tmp_path / "after"))) == len(live.map())


def test_errors_name_the_method(tmp_path: Path) -> None:
    live = oort.LiveMapper()
    with pytest.raises(oort.StateError, match=r"^LiveMapper\.notify_docked: no scan"):
        live.notify_docked()
    with pytest.raises(oort.InputError, match=r"^LiveMapper\.push_odometry: the pose must be three numbers"):
        live.push_odometry(0.0, (1.0,))
    with pytest.raises(oort.InputError, match=r"^LiveMapper\.push_odometry: .* not finite"):
        live.push_odometry(0.0, (float("nan"), 0.0, 0.0))
    with pytest.raises(oort.InputError, match=r"^LiveMapper\.push_gyro: "):
        live.push_gyro(0.0, float("inf"))
    with pytest.raises(oort.InputError, match=r"^LiveMapper\.push_scan: takes an oort\.LaserScan, not list"):
        live.push_scan([1.0, 2.0])  # type: ignore[arg-type]
    with pytest.raises(oort.InputError, match=r"^LiveMapper\.push_scan: a time_increment of 1.0 s cannot be"):
        live.push_scan(room_scan(0, 0, 0, 0.0), time_increment=1.0)
    live.close()
    with pytest.raises(oort.StateError, match=r"^LiveMapper\.push_scan: this LiveMapper is closed"):
        live.push_scan(room_scan(0, 0, 0, 0.0))
    (tmp_path / "file").write_text("")
    with pytest.raises(oort.MapFileError, match=r"^LiveMapper: the folder"):
        oort.LiveMapper(save_to=tmp_path / "file" / "map")
    with pytest.raises(oort.MapFileError, match="none"):
        oort.LiveMapper(resume=(tmp_path / "none", (0.0, 0.0, 0.0)))


def test_beams_that_come_one_after_the_other_are_placed_by_odometry() -> None:
    seen = []
    for increment in (0.0, 0.0005):
        with oort.LiveMapper() as live:
            for k in range(40):
                live.push_odometry(0.1 * k, (0.02 * k, 0.0, 0.05 * k))
                live.push_scan(room_scan(0.02 * k, 0.0, 0.05 * k, 0.1 * k), increment)
            live.push_odometry(4.0, (0.8, 0.0, 2.0))
        seen.append(live.map().cloud(1))
    assert not np.allclose(seen[0], seen[1], equal_nan=True)


def test_what_goes_wrong_is_told() -> None:
    troubles: list[str] = []
    with oort.LiveMapper(on_trouble=troubles.append) as live:
        push(live, 3)
        live.push_scan(room_scan(0, 0, 0, 100.0))
    assert troubles == ["a scan was left out: no odometry at its stamp"]
