# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry as it comes in: what a scan waits for, and whose poses it must not get."""

import time

import pytest

from oort.live import UnusableScanError
from oort.live.odometry import Odometry


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
