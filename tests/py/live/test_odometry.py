# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry as it comes in: what a scan waits for, and whose poses it must not get."""

import math
import time

import pytest

from oort.live import UnusableScanError
from oort.live.odometry import Odometry
from oort.live.snapshot import odom_pose_of
from oort.poses import compose


def told(start: float = 0.0, end: float = 10.0, speed: float = 1.0) -> Odometry:
    """That of a robot which drives along x, told fifty times a second."""
    odometry = Odometry()
    tell(odometry, start, end, speed)
    return odometry


def tell(odometry: Odometry, start: float, end: float, speed: float = 1.0) -> bool:
    """Whether the first pose said that the clock was set back."""
    set_back = [odometry.add(start + 0.02 * k, (speed * 0.02 * k, 0.0, 0.0)) for k in range(round(50 * (end - start)))]
    return set_back[0]


def test_a_scan_waits_for_its_time() -> None:
    odometry = told()
    assert odometry.at(5.0, time.monotonic()) == pytest.approx((5.0, 0.0, 0.0))
    assert odometry.at(10.5, time.monotonic()) is None
    assert not tell(odometry, 10.0, 11.0)
    assert odometry.at(10.5, time.monotonic()) is not None


def test_a_clock_that_goes_back_a_little() -> None:
    """Scans come before the odometry that says so, and what is known of their stamps is of another place."""
    odometry = told()
    assert odometry.at(9.9, time.monotonic()) is not None
    arrived = time.monotonic()
    assert odometry.at(5.0, arrived) is None
    assert tell(odometry, 5.0, 6.0, speed=0.0)
    assert odometry.at(5.0, arrived) == (0.0, 0.0, 0.0)
    assert odometry.at(5.1, time.monotonic()) == (0.0, 0.0, 0.0)


def test_odometry_that_hears_of_it_first() -> None:
    odometry = told()
    assert odometry.at(9.9, time.monotonic()) is not None
    before = time.monotonic()
    assert tell(odometry, 5.0, 6.0, speed=0.0)
    assert odometry.at(5.1, time.monotonic()) == (0.0, 0.0, 0.0)
    with pytest.raises(UnusableScanError, match="before the clock was set back"):
        odometry.at(9.99, before)


def test_scans_a_little_out_of_order() -> None:
    odometry = told()
    assert odometry.at(5.0, time.monotonic()) is not None
    assert odometry.at(4.5, time.monotonic()) == pytest.approx((4.5, 0.0, 0.0))


def test_what_is_lacking(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("oort.live.odometry.time.monotonic", lambda: now[0])
    odometry = told()
    odometry.at(10.5, now[0])
    assert odometry.lack("odom -> base") == "no odom -> base since 0.0 s"
    odometry.at(3609.98, now[0])
    assert odometry.lack("odom -> base") == "check the clocks: scans are stamped 3600.0 s ahead of odometry"
    now[0] += 2.3
    assert odometry.lack("odom -> base") == "no odom -> base since 2.3 s"


def test_a_scan_waits_for_its_last_beam() -> None:
    odometry = told(end=10.0)  # up to 9.98
    now = time.monotonic()
    placement = odometry.place(9.8, now, (0.0, 0.1))
    assert placement is not None
    assert placement.sweep is not None
    assert placement.sweep[1] == pytest.approx((0.1, 0.0, 0.0))
    assert not placement.guessed
    assert odometry.place(9.94, now, (0.0, 0.1)) is None
    assert odometry.place(9.94, now, (0.0, 0.1), last_resort=True) is None  # as long as nothing may be extrapolated
    tell(odometry, 10.0, 11.0)
    assert odometry.place(9.94, now, (0.0, 0.1)) is not None


def test_the_last_resort_is_bounded() -> None:
    odometry = Odometry(max_extrapolation=0.1)
    tell(odometry, 0.0, 10.0)
    now = time.monotonic()
    for stamp, span in ((9.94, (0.0, 0.1)), (10.05, (0.0, 0.0))):
        assert odometry.place(stamp, now, span) is None
        placement = odometry.place(stamp, now, span, last_resort=True)
        assert placement is not None
        assert placement.guessed
        assert placement.odometry == pytest.approx((stamp, 0.0, 0.0))
    assert odometry.place(10.05, now, (0.0, 0.1), last_resort=True) is None
    assert odometry.place(10.2, now, last_resort=True) is None


def test_no_last_resort_across_a_clock_that_was_set_back() -> None:
    odometry = Odometry(max_extrapolation=0.1)
    tell(odometry, 0.0, 10.0)
    assert odometry.place(9.9, time.monotonic()) is not None
    assert odometry.place(5.0, time.monotonic(), last_resort=True) is None


def test_a_gyro_turns_the_odometry_and_the_map_is_told_in_the_frame_that_is_reported() -> None:
    odometry = Odometry(use_gyro=True)
    for k in range(300):  # it stands for two seconds, and then turns by 1 rad/s, of which the wheels tell a half
        turned = max(0.0, 0.02 * k - 2.0)
        odometry.add_gyro(0.02 * k, 1.01 if turned > 0.0 else 0.01)
        odometry.add(0.02 * k, (3.0, 0.0, 0.5 * turned))
    now = time.monotonic()
    placement = odometry.place(5.0, now)
    assert placement is not None
    assert placement.guessed
    assert placement.odometry == pytest.approx((3.0, 0.0, 3.0), abs=0.02)
    T_map_odom = (1.0, 2.0, 0.3)
    on_map = compose(T_map_odom, placement.odometry)
    reported = odom_pose_of(T_map_odom, placement.reported_frame)
    assert compose(reported, (3.0, 0.0, 1.5)) == pytest.approx(on_map)
    assert odometry.place(5.99, now) is None  # the gyro is behind
    odometry.add(6.2, (3.0, 0.0, 2.0))
    assert odometry.place(6.1, now) is None
    assert odometry.place(6.1, now, last_resort=True) is not None


def turning(odometry: Odometry, begin: float, end: float, set_back: float = 0.0) -> None:
    """A robot that stands for two seconds and then turns by 1 rad/s, of which the wheels tell a half."""
    for k in range(round(50 * begin), round(50 * end)):
        turned = max(0.0, 0.02 * k - 2.0)
        odometry.add(0.02 * k - set_back, (3.0, 0.0, 0.5 * turned))
        odometry.add_gyro(0.02 * k - set_back, 1.01 if turned > 0.0 else 0.01)


def heading(odometry: Odometry, stamp: float) -> float:
    placement = odometry.place(stamp, time.monotonic())
    assert placement is not None
    return placement.odometry[2]


def test_a_gyro_whose_clock_is_set_back() -> None:
    """Neither the frame of its odometry jumps, nor is its bias learned again."""
    odometry = Odometry(use_gyro=True)
    turning(odometry, 0.0, 4.5)
    before = heading(odometry, 4.48)
    turning(odometry, 4.5, 6.5, set_back=2.0)
    assert heading(odometry, 2.5) == pytest.approx(before + 0.02, abs=0.02)
    assert math.remainder(heading(odometry, 4.0) - before, math.tau) == pytest.approx(1.5, abs=0.04)


@pytest.mark.parametrize("stamp", [1e9, 4.0, 0.5])
def test_a_gyro_with_one_wrong_stamp(stamp: float) -> None:
    odometry = Odometry(use_gyro=True)
    turning(odometry, 0.0, 3.0)
    odometry.add_gyro(stamp, 0.0)
    turning(odometry, 3.0, 5.0)
    assert heading(odometry, 4.9) == pytest.approx(2.9, abs=0.06)


def test_a_gyro_that_turns_nothing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("oort.live.odometry.time.monotonic", lambda: now[0])
    odometry = Odometry(use_gyro=True)

    def drive(begin: int, end: int, speed: float, late: float = 0.0) -> None:
        for k in range(begin, end):
            now[0] += 0.02
            odometry.add(0.02 * k, (speed * k, 0.0, 0.0))
            odometry.add_gyro(0.02 * k - late, 0.0)

    drive(0, 200, speed=0.01)
    assert not odometry.gyro_trouble(), "it may stand yet"
    drive(200, 300, speed=0.01)
    assert "let the robot stand" in odometry.gyro_trouble()
    drive(300, 500, speed=0.0)
    assert not odometry.gyro_trouble()
    drive(500, 800, speed=0.0, late=30.0)
    assert "check the IMU's rate and the clocks" in odometry.gyro_trouble()
    now[0] += 3.0
    assert not odometry.gyro_trouble(), "odometry does not flow"


def test_a_scan_whose_beams_are_older_than_odometry() -> None:
    """Their odometry will not come: no scan behind it has to wait for that."""
    odometry = Odometry()
    arrived = time.monotonic()
    tell(odometry, 5.0, 10.0)
    with pytest.raises(UnusableScanError, match="older than the odometry"):
        odometry.place(5.04, arrived, (0.0, -0.1))
    assert odometry.place(5.2, arrived, (0.0, -0.1)) is not None
    assert odometry.place(5.04, time.monotonic(), (0.0, -0.1)) is None, "the clock may have been set back"
