# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Diagnostics of the localiser: what is wrong is said with advice, unless another program tells the place."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
import genpy
from diagnostic_msgs.msg import DiagnosticStatus

from oort import LocalizationState
from oort.live.window import Spread
from oort.node.diagnostics import diagnostic_array
from oort.node.localizer_health import LocalizerHealth, Sighting

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
STATISTICS = {
    "matched": 90, "searches": 5, "jumps": 1,
    "match_rejections": {"low support": 8}, "search_rejections": {"low_support": 1, "ambiguous": 3},
}  # fmt: skip
SIGHTING = Sighting(
    LocalizationState.TRACKING, 0.92, (1.0, 2.0, 0.5), (0.9, 2.0, 0.5), np.diag([0.0009, 0.0004, 0.0001]), STATISTICS
)  # fmt: skip
WELL = LocalizerHealth(
    queue_size=1, scan_topic="/scan", scans_received=100, scan_rate_hz=10.0, seconds_without_scan=0.1,
    scans_processed=98, drops={}, drops_of_late=[], ms_per_scan=Spread(0.2, 1.5, 20.0), delay_ms=None,
    waiting_scans=0, seconds_waiting=0.0, waiting_for="", imu_trouble="",
    map_path="/maps/home", last=SIGHTING, told_by_other=False,
)  # fmt: skip


def status(health: LocalizerHealth) -> Any:
    (only,) = diagnostic_array(health, "/oort_localizer", genpy.Time(1, 2)).status
    return only


def in_state(state: str) -> Sighting:
    return replace(SIGHTING, state=LocalizationState(state))


def test_all_well() -> None:
    told = status(WELL)
    assert (told.level, told.name, told.message) == (OK, "oort_localizer: localisation", "Tracking")
    values = {item.key: item.value for item in told.values}
    assert values["position deviation [m]"] == "0.030"
    assert values["heading deviation [rad]"] == "0.010"
    assert values["searches rejected"] == "ambiguous 3, low_support 1"
    assert values["support"] == "0.92"


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"last": in_state("lost")}, "The place is lost; drive slowly"),
        ({"last": in_state("searching")}, "The place is not found yet (ambiguous 3, low_support 1); drive on"),
        ({"seconds_without_scan": 3.2}, "No scan on /scan for 3.2 s; check"),
        ({"imu_trouble": "no yaw rate on /imu; start the IMU"}, "Odometry's own turns are used: no yaw rate on /imu;"),
        ({"queue_size": 51}, "51 scans and calls are queued; "),
    ],
)
def test_each_trouble_is_said_with_advice(change: dict[str, Any], says: str) -> None:
    told = status(replace(WELL, **change))
    assert told.level == WARN
    assert told.message.startswith(says)


@pytest.mark.parametrize("state", ["lost", "searching"])
def test_a_place_that_another_program_tells_is_not_missed(state: str) -> None:
    told = status(replace(WELL, last=in_state(state), told_by_other=True))
    assert (told.level, told.message) == (OK, "Another program tells map -> odom")


def test_before_the_first_scan_figures_are_dashes() -> None:
    told = status(replace(WELL, last=Sighting(), scans_received=0))
    assert told.message.startswith("No scan has come on /scan; start the laser")
    unknown = {item.key for item in told.values if item.value == "-"}
    assert {"state", "support", "position deviation [m]", "heading deviation [rad]"} <= unknown
