# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a node of Oort's goes, as a message for diagnostics: what is wrong, what to do about it, and the figures."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from oort.live.figures import Figures
from oort.live.inbox import Inbox
from oort.live.window import Spread

OK, WARN, ERROR = range(3)
"""Levels. ROS 1 has the same numbers, ROS 2 bytes."""
_LEVELS = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR

_SILENCE = 2.0  # [s] without a scan
_PATIENCE = 1.0  # [s] that a scan waits for its transform
_BEHIND = 50  # scans and calls in the queue


Problem = tuple[int, str]
"""A level, and a sentence that says what is wrong and what to do."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Health(ABC):
    """How it goes with the scans; times are in seconds, except where the name says ms."""

    queue_size: int
    scan_topic: str
    scans_received: int
    scan_rate_hz: float
    seconds_without_scan: float
    """since the last scan came; inf if none did"""
    scans_processed: int
    drops: Mapping[str, int]
    """scans that were not used though they should have been, by reason"""
    drops_of_late: Sequence[str]
    """the reasons of the last seconds"""
    ms_per_scan: Spread | None
    """to work one off; None if none was"""
    delay_ms: Spread | None
    """from a scan's arrival until the map -> odom that it gives is sent"""
    waiting_scans: int
    """for their transform"""
    seconds_waiting: float
    """of the first of them"""
    waiting_for: str
    """what they wait for, such as "no odom -> base_footprint since 2.3 s" """
    imu_trouble: str
    """why an IMU that is to be used turns nothing of odometry, and what to do; empty if it does, or if none is used"""

    @property
    @abstractmethod
    def part(self) -> str:
        """What the node does."""

    @property
    @abstractmethod
    def all_well(self) -> str:
        """The sentence when nothing is wrong."""

    @abstractmethod
    def problems(self) -> Iterator[Problem]:
        """What is wrong."""

    @abstractmethod
    def figures(self) -> Iterator[tuple[str, str]]:
        """Keys and values, always in this order."""

    def problems_of_input(self) -> Iterator[Problem]:
        """What is wrong with the scans that come."""
        if self.scans_received == 0:
            yield WARN, f"No scan has come on {self.scan_topic}; start the laser, or remap the topic scan"
        elif self.seconds_without_scan > _SILENCE:
            silence = f"{self.seconds_without_scan:.1f} s"
            yield WARN, f"No scan on {self.scan_topic} for {silence}; check that the laser is running"
        if self.waiting_scans and self.seconds_waiting > _PATIENCE:
            yield WARN, f"{self.waiting_scans} scans wait: {self.waiting_for}; check who publishes this transform"
        if self.imu_trouble:
            yield WARN, f"Odometry's own turns are used: {self.imu_trouble}"
        if self.drops_of_late:
            yield WARN, f"Scans are left out ({', '.join(self.drops_of_late)}); check the laser, odometry and clocks"

    def problems_of_queue(self) -> Iterator[Problem]:
        """Whether scans come faster than they are worked off."""
        if self.queue_size > _BEHIND:
            yield (
                WARN,
                f"{self.queue_size} scans and calls are queued; stand still until fewer are, or send fewer scans",
            )

    def figures_of_scans(self) -> Iterator[tuple[str, str]]:
        """What came, what became of it, and how long that took."""
        yield "queue size", str(self.queue_size)
        yield "scans received", str(self.scans_received)
        yield "scan rate [Hz]", f"{self.scan_rate_hz:.1f}"
        yield "scans processed", str(self.scans_processed)
        yield "scans dropped", str(sum(self.drops.values()))
        for reason in sorted(self.drops):
            yield f"scans dropped, {reason}", str(self.drops[reason])
        yield from _spread("ms per scan", self.ms_per_scan)
        yield from _spread("delay [ms]", self.delay_ms)

    def figures_of_waiting(self) -> Iterator[tuple[str, str]]:
        """Of scans that wait for their transform."""
        yield "scans waiting", str(self.waiting_scans)
        yield "waiting for", (self.waiting_for if self.waiting_scans else "") or "-"


def health_of_input(figures: Figures, inbox: Inbox) -> dict[str, Any]:
    """What Health says of the scans that came and wait, by field."""
    waiting, seconds_waiting = inbox.waiting()
    return {
        "queue_size": len(inbox),
        "scans_received": figures.scans_arrived,
        "scan_rate_hz": figures.scan_rate,
        "seconds_without_scan": figures.seconds_without_scan,
        "scans_processed": figures.scans_mapped,
        "drops": dict(figures.drops.counts),
        "drops_of_late": figures.drops.of_late(),
        "ms_per_scan": figures.milliseconds.spread,
        "delay_ms": figures.delays.spread,
        "waiting_scans": waiting,
        "seconds_waiting": seconds_waiting,
    }


def diagnostic_array(health: Health, node_name: str, stamp: Any) -> DiagnosticArray:
    """The message, with one status: "<node>: <what it does>"."""
    problems = sorted(health.problems(), key=lambda problem: -problem[0])  # the worst first, else as they are found
    status = DiagnosticStatus(
        level=_LEVELS[problems[0][0] if problems else OK],
        name=f"{node_name.lstrip('/')}: {health.part}",
        message=". ".join(sentence for _, sentence in problems) or health.all_well,
        hardware_id="oort",
        values=[KeyValue(key=key, value=value) for key, value in health.figures()],
    )
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp
    return message


def number(value: float | None, digits: int) -> str:
    """A figure, or a dash for one that is not known."""
    return "-" if value is None else f"{value:.{digits}f}"


def _spread(name: str, spread: Spread | None) -> Iterator[tuple[str, str]]:
    p50, p99, worst = (None, None, None) if spread is None else (spread.p50, spread.p99, spread.max)
    yield f"{name}, median", number(p50, 1)
    yield f"{name}, 99 %", number(p99, 1)
    yield f"{name}, worst", number(worst, 1)
