# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""When a replay makes the calls of a drive, and the log that a live drive leaves for it."""

import errno
import json
import math
import os
import resource
import signal
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.scenes import room_scan
from oort import InputError
from oort.events import SCAN, Event, EventLog, read_events, scan_entry
from oort.offline.schedule import LoggedSchedule, Schedule, TimedSchedule, make_schedule
from oort.recording import Scan

PWRITE = os.pwrite


class Made(list[str]):
    """What happened, in order."""

    def __call__(self, number: int, event: Event) -> None:
        self.append(f"{number} {event.call}")


def scan(t: float) -> Scan:
    return room_scan(0.0, 0.0, 0.0, t)


def logged(*scans_and_calls: float | str) -> list[Event]:
    """A number stands for the scan of that time; a live robot's clock is not that of its scans."""
    return [
        Event(7.0, entry) if isinstance(entry, str) else Event(7.0, SCAN, [scan(entry).stamp])
        for entry in scans_and_calls
    ]


def walk(schedule: Schedule, made: Made, times: list[float], until: float = math.inf) -> Made:
    """Goes through a recording; scans that are mapped go down as their times."""
    for t in times:
        if schedule.take(scan(t)) is not None:
            made.append(f"{t:g}")
    schedule.finish(until)
    return made


# ---- by time ----


def test_a_call_comes_before_the_first_scan_that_reaches_its_time() -> None:
    made = Made()
    events = [Event(0.5, "a"), Event(1.0, "b"), Event(1.5, "c"), Event(9.0, "d")]
    assert walk(TimedSchedule(events, made), made, [1.0, 2.0]) == ["0 a", "1 b", "1", "2 c", "2", "3 d"]


def test_calls_up_to_the_end_are_made_and_none_after_it() -> None:
    made = Made()
    events = [Event(3.0, "a"), Event(3.1, "b")]
    assert walk(TimedSchedule(events, made), made, [1.0], until=3.0) == ["1", "0 a"]


def test_calls_out_of_order_keep_their_numbers_and_equal_times_their_order() -> None:
    made = Made()
    events = [Event(5.0, "late"), Event(1.0, "first"), Event(1.0, "second")]
    assert walk(TimedSchedule(events, made), made, [2.0, 6.0]) == ["1 first", "2 second", "2", "0 late", "6"]


def test_a_recording_whose_clock_is_set_back_makes_no_call_twice() -> None:
    made = Made()
    assert walk(TimedSchedule([Event(5.0, "a")], made), made, [6.0, 1.0, 6.0]) == ["0 a", "6", "1", "6"]


# ---- by the log of a live drive ----


def test_only_listed_scans_are_mapped_and_calls_come_where_they_are_listed() -> None:
    made = Made()
    schedule = LoggedSchedule(logged("map/start", 2.0, "a", "b", 4.0, "map/stop"), made)
    assert walk(schedule, made, [1.0, 2.0, 3.0, 4.0, 5.0]) == ["0 map/start", "2", "2 a", "3 b", "4", "5 map/stop"]


def test_a_scan_has_the_odometry_that_the_log_says_it_had(tmp_path: Path) -> None:
    sweep = ((0.0, 0.0, 0.0), (0.1, 0.0, 1.0 / 3.0))
    had = [
        replace(scan(1.0), odometry=(0.1, 0.2, 0.3), sweep=sweep, guessed=True),
        replace(scan(2.0), odometry=(1.0 / 3.0, 0.0, 0.0), guessed=True),
        scan(3.0),
    ]
    log = EventLog(tmp_path / "log.json")
    for taken in had:
        log.add(0.0, SCAN, scan_entry(taken))
    log.close()
    schedule = make_schedule(read_events(tmp_path / "log.json"), Made())
    again = [schedule.take(replace(scan(t), odometry=(7.0, 7.0, 7.0))) for t in (1.0, 2.0)]
    assert [(s.odometry, s.sweep) for s in again if s is not None] == [(s.odometry, s.sweep) for s in had[:2]]
    last = scan(3.0)
    assert schedule.take(last) is last


@pytest.mark.parametrize(
    "rest",
    [
        [[1, 2]],
        [[1, 2, 3], [[1, 2, 3]]],
        [[1, 2, 3], {}],
        [[1, 2, 3], 7],
        [[1, 2, "x"], None],
        [[1, 2, 10**400], None],
        [{}, None],
        [None, None],
    ],
)
def test_a_log_with_odometry_that_cannot_be(rest: list[object]) -> None:
    schedule = LoggedSchedule([Event(0.0, SCAN, [scan(1.0).stamp, *rest])], Made())
    with pytest.raises(InputError, match="cannot be"):
        schedule.take(scan(1.0))


def test_the_times_in_a_log_count_for_nothing() -> None:
    made = Made()
    events = [Event(1e9, "a"), Event(1e9, SCAN, [scan(1.0).stamp]), Event(-5.0, "b")]
    assert walk(LoggedSchedule(events, made), made, [1.0]) == ["0 a", "1", "2 b"]


def test_a_scan_that_comes_twice_is_mapped_as_often_as_it_is_listed() -> None:
    made = Made()
    assert walk(LoggedSchedule(logged(1.0, "a", 1.0), made), made, [1.0, 1.0, 1.0]) == ["1", "1 a", "1"]


@pytest.mark.parametrize("listed", [(1.0, 9.0, "a", 2.0), (2.0, 1.0, "a", 3.0)])
def test_listed_scans_that_the_recording_has_not_are_an_error(listed: tuple[float | str, ...]) -> None:
    made = Made()
    with pytest.raises(InputError, match=r"event 1: the scan .*\(2 listed scans were not found\)"):
        walk(LoggedSchedule(logged(*listed), made), made, [1.0, 2.0, 3.0])
    assert "2 a" not in made


def test_a_part_of_the_recording_needs_only_a_part_of_the_log() -> None:
    made = Made()
    schedule = LoggedSchedule(logged("a", 1.0, "b", 2.0, "c"), made)
    assert walk(schedule, made, [1.0], until=1.5) == ["0 a", "1", "2 b"]


def test_a_log_is_told_by_its_scans() -> None:
    assert isinstance(make_schedule(logged("a", 1.0), Made()), LoggedSchedule)
    assert isinstance(make_schedule(logged("a"), Made()), TimedSchedule)
    assert isinstance(make_schedule([], Made()), TimedSchedule)


@given(st.lists(st.one_of(st.integers(0, 9).map(float), st.sampled_from(["a", "b"]))))
def test_a_log_is_repeated_as_it_was(drive: list[float | str]) -> None:
    """Whatever was mapped: a recording with these scans among others gives the same in the same order."""
    made = Made()
    events = logged(*drive)
    recording = [t for entry in drive if isinstance(entry, float) for t in (entry, 100.0)]
    expected = [f"{entry:g}" if isinstance(entry, float) else f"{k} {entry}" for k, entry in enumerate(drive)]
    assert walk(LoggedSchedule(events, made), made, recording) == expected


# ---- writing the log ----

entries = st.tuples(
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from(["map/start", SCAN]),
    st.lists(st.one_of(st.text(), st.floats(-1e6, 1e6), st.booleans(), st.lists(st.text()))),
)


@given(st.lists(entries))
def test_what_is_written_is_read(
    tmp_path_factory: pytest.TempPathFactory, written: list[tuple[float, str, list[object]]]
) -> None:
    """And after each entry already."""
    path = tmp_path_factory.mktemp("log") / "events.json"
    log = EventLog(path)
    assert read_events(path) == []
    for count, entry in enumerate(written, start=1):
        log.add(*entry)
        assert read_events(path) == [Event(*entry) for entry in written[:count]]
    log.close()


def test_a_log_begins_anew_and_the_last_one_stays(tmp_path: Path) -> None:
    path = tmp_path / "events.json"
    for call in ("first", "second", "third"):
        log = EventLog(path)
        log.add(1.0, call, ())
        log.close()
    assert read_events(path) == [Event(1.0, "third", [])]
    assert read_events(f"{path}.1") == [Event(1.0, "second", [])]


@pytest.fixture
def log(tmp_path: Path) -> EventLog:
    """A log with one entry."""
    log = EventLog(tmp_path / "events.json")
    log.add(1.0, "map/start", ["/a/map"])
    return log


def refuse(file: int, text: bytes, offset: int) -> int:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def cut_short(file: int, text: bytes, offset: int) -> int:
    return PWRITE(file, text[: len(text) // 2], offset)


@pytest.mark.parametrize("full", [refuse, cut_short])
def test_a_full_disk_loses_an_entry_and_no_more(
    log: EventLog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, full: Callable[[int, bytes, int], int]
) -> None:
    def pwrite(file: int, text: bytes, offset: int) -> int:
        return full(file, text, offset) if b"lost" in text else PWRITE(file, text, offset)

    before = (tmp_path / "events.json").read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr("oort.events.os.pwrite", pwrite)
        for _ in range(3):
            with pytest.raises(InputError, match=r"events\.json: an entry of the events log is lost: No space left"):
                log.add(2.0, "lost", ["long enough to be cut within" * 10])
            assert (tmp_path / "events.json").read_bytes() == before
    log.add(3.0, "map/stop", [])
    assert [event.call for event in read_events(tmp_path / "events.json")] == ["map/start", "map/stop"]


def test_a_limit_of_the_files_size(log: EventLog, tmp_path: Path) -> None:
    """The system itself says no, and has written a part."""
    path = tmp_path / "events.json"
    before = path.read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) + 20, limits[1]))
        with pytest.raises(InputError, match="lost"):
            log.add(2.0, "lost", ["more than twenty bytes"])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert path.read_bytes() == before
    assert json.loads(before)


def test_a_disk_that_fails(log: EventLog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Then nothing can be put right either; it is an error of the log all the same."""

    def fail(*_: object) -> int:
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr("oort.events.os.pwrite", fail)
    with pytest.raises(InputError, match="an entry of the events log is lost: Input/output error"):
        log.add(2.0, "map/stop", [])


@pytest.mark.parametrize(
    ("path", "why"),
    [("none/events.json", "written: "), ("", "written: "), ("/dev/full", "a device or a pipe; give a file")],
)
def test_a_log_that_cannot_be_written(tmp_path: Path, path: str, why: str) -> None:
    with pytest.raises(InputError, match=f"the events log cannot be {why}"):
        EventLog(tmp_path / path)
