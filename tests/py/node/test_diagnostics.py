# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Diagnostics: what is wrong is said at the right level and with advice, and the figures keep their order."""

import io
import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rospy")
import genpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from oort.live.window import Spread
from oort.node.diagnostics import diagnostic_array
from oort.node.health import MappingHealth

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
STAMP = genpy.Time(12, 34)
WELL = MappingHealth(
    state="mapping",
    path="/home/me/map",
    queue_size=1,
    scan_topic="/scan_reduced_mapping",
    scans_received=120,
    scan_rate_hz=10.04,
    seconds_without_scan=0.1,
    scans_processed=117,
    drops={"without readings": 2, "unusable": 1},
    drops_of_late=[],
    ms_per_scan=Spread(1.24, 3.5, 12.0),
    delay_ms=Spread(22.0, 41.0, 50.0),
    tracking="tracking",
    inlier_ratio=0.876,
    nodes=40,
    closures=3,
    last_save="map",
    seconds_since_save=4.2,
    save_error="",
    waiting_scans=1,
    seconds_waiting=0.02,
    waiting_for="no odom -> base_footprint since 0.0 s",
    imu_trouble="",
    troubles=[],
    clock_jumps=0,
)
EMPTY = replace(
    WELL,
    state="not_mapping",
    path="",
    scans_received=0,
    scans_processed=0,
    seconds_without_scan=math.inf,
    drops={},
    ms_per_scan=None,
    delay_ms=None,
    tracking="idle",
    inlier_ratio=None,
    nodes=0,
    last_save="",
    seconds_since_save=None,
    waiting_scans=0,
)


def status(health: MappingHealth) -> Any:
    message = diagnostic_array(health, "/oort_slam", STAMP)
    assert message.header.stamp == STAMP
    (only,) = message.status
    return only


def test_all_well() -> None:
    told = status(WELL)
    assert (told.level, told.name, told.hardware_id) == (OK, "oort_slam: mapping", "oort")
    assert told.message == "Mapping, 40 nodes"


def test_the_figures() -> None:
    assert [(item.key, item.value) for item in status(WELL).values] == [
        ("state", "mapping"),
        ("path", "/home/me/map"),
        ("queue size", "1"),
        ("scans received", "120"),
        ("scan rate [Hz]", "10.0"),
        ("scans processed", "117"),
        ("scans dropped", "3"),
        ("scans dropped, unusable", "1"),
        ("scans dropped, without readings", "2"),
        ("ms per scan, median", "1.2"),
        ("ms per scan, 99 %", "3.5"),
        ("ms per scan, worst", "12.0"),
        ("delay [ms], median", "22.0"),
        ("delay [ms], 99 %", "41.0"),
        ("delay [ms], worst", "50.0"),
        ("tracking", "tracking"),
        ("inlier ratio", "0.88"),
        ("nodes", "40"),
        ("closures", "3"),
        ("last save", "map"),
        ("time since last save [s]", "4.2"),
        ("save error", "-"),
        ("scans waiting", "1"),
        ("waiting for", "no odom -> base_footprint since 0.0 s"),
        ("clock jumps", "0"),
    ]


def test_what_is_not_known_is_a_dash() -> None:
    values = {item.key: item.value for item in status(EMPTY).values}
    unknown = {key for key, value in values.items() if value == "-"}
    assert unknown == {
        "path",
        *(f"{name}, {part}" for name in ("ms per scan", "delay [ms]") for part in ("median", "99 %", "worst")),
        "inlier ratio",
        "last save",
        "time since last save [s]",
        "save error",
        "waiting for",
    }


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({}, "Not mapping"),
        ({"nodes": 7}, "Not mapping, a map of 7 nodes is loaded"),
        ({"state": "paused"}, "Paused; map/resume_from_paused goes on"),
    ],
)
def test_without_mapping_nothing_is_missed(change: dict[str, Any], message: str) -> None:
    told = status(replace(EMPTY, **change))
    assert (told.level, told.message) == (OK, message)


@pytest.mark.parametrize(
    ("change", "level", "says"),
    [
        ({"scans_received": 0}, WARN, "No scan has come on /scan_reduced_mapping; start the laser"),
        ({"seconds_without_scan": 3.21}, WARN, "No scan on /scan_reduced_mapping for 3.2 s; check"),
        (
            {"waiting_scans": 14, "seconds_waiting": 2.3, "waiting_for": "no odom -> base_footprint since 2.3 s"},
            WARN,
            "14 scans wait: no odom -> base_footprint since 2.3 s; check",
        ),
        ({"drops_of_late": ["late", "odd"]}, WARN, "Scans are left out (late, odd); check"),
        (
            {"imu_trouble": "no yaw rate on /imu; start the IMU"},
            WARN,
            "Odometry's own turns are used: no yaw rate on /imu; start",
        ),
        ({"tracking": "lost"}, WARN, "Tracking is lost"),
        ({"queue_size": 51}, WARN, "51 scans and calls are queued"),
        ({"save_error": "/full: no space left"}, ERROR, "The map was not saved (/full: no space left); "),
    ],
)
def test_each_trouble_is_said_with_advice(change: dict[str, Any], level: int, says: str) -> None:
    told = status(replace(WELL, **change))
    assert told.level == level
    assert told.message.startswith(says)
    assert ";" in told.message  # after it, what to do


@pytest.mark.parametrize(
    "change",
    [
        {"seconds_without_scan": 1.9},
        {"waiting_scans": 9, "seconds_waiting": 0.9},
        {"queue_size": 50},
        {"clock_jumps": 1},
    ]
    + [{"tracking": tracking} for tracking in ("uncertain", "idle")],
)
def test_what_is_usual_is_no_trouble(change: dict[str, Any]) -> None:
    assert status(replace(WELL, **change)).level == OK


def test_a_failed_save_is_told_in_every_state_and_first() -> None:
    assert status(replace(EMPTY, save_error="full")).level == ERROR
    told = status(replace(WELL, tracking="lost", queue_size=99, save_error="full"))
    assert told.level == ERROR
    sentences = told.message.split(". ")
    assert [sentence.split()[0] for sentence in sentences] == ["The", "Tracking", "99"]


spreads = st.none() | st.builds(Spread, *[st.floats(0, 1e5)] * 3)
healths = st.builds(
    MappingHealth,
    state=st.sampled_from(["not_mapping", "mapping", "paused"]),
    drops=st.dictionaries(st.text(max_size=20), st.integers(0, 10**9), max_size=4),
    ms_per_scan=spreads,
    delay_ms=spreads,
    tracking=st.sampled_from(["tracking", "uncertain", "lost", "idle"]),
    seconds_without_scan=st.floats(0, math.inf),
)


@given(health=healths)
def test_any_health_can_be_sent(health: MappingHealth) -> None:
    sent = diagnostic_array(health, "/oort_ros_mapping", STAMP)
    buffer = io.BytesIO()
    sent.serialize(buffer)
    assert DiagnosticArray().deserialize(buffer.getvalue()) == sent
    told = sent.status[0]
    assert told.message
    keys = [item.key for item in told.values]
    assert len(keys) == len(set(keys))
    assert [key for key in keys if not key.startswith("scans dropped, ")] == [item.key for item in status(EMPTY).values]
