# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How mapping goes, as a message for diagnostics: what is wrong, what to do about it, and the figures."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import genpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from oort.live.window import Spread

_SILENCE = 2.0  # [s] without a scan
_PATIENCE = 1.0  # [s] that a scan waits for its transform
_BEHIND = 50  # scans and calls in the queue


@dataclass(frozen=True, kw_only=True, slots=True)
class Health:
    """How mapping goes; times are in seconds, except where the name says ms."""

    state: str
    """not_mapping, mapping or paused"""
    path: str
    """where the map is saved; empty for nowhere"""
    queue_size: int
    scan_topic: str
    scans_received: int
    scan_rate_hz: float
    seconds_without_scan: float
    """since the last scan came; inf if none did"""
    scans_processed: int
    drops: Mapping[str, int]
    """scans that were not mapped though they should have been, by reason"""
    drops_of_late: Sequence[str]
    """the reasons of the last seconds"""
    ms_per_scan: Spread | None
    """to map one; None if none was"""
    delay_ms: Spread | None
    """from a scan's arrival until the map -> odom that it gives is sent"""
    tracking: str
    """tracking, uncertain, lost or idle"""
    hit_fraction: float | None
    """share of the last scan's returns that hit what was seen before"""
    nodes: int
    closures: int
    """loops and docks that were closed"""
    last_save: str
    """map, or meta where only the places were written; empty if nothing was"""
    seconds_since_save: float | None
    save_error: str
    """why the last save failed; empty if it did not"""
    waiting_scans: int
    """for their transform"""
    seconds_waiting: float
    """of the first of them"""
    waiting_for: str
    """what they wait for, such as "no odom -> base_footprint since 2.3 s" """
    clock_jumps: int
    """how often the scans' clock was set back"""


def diagnostic_array(health: Health, node_name: str, stamp: genpy.Time) -> DiagnosticArray:
    """The message, with one status: "<node>: mapping"."""
    problems = sorted(_problems(health), key=lambda problem: -problem[0])  # the worst first, else as they are found
    status = DiagnosticStatus(
        level=problems[0][0] if problems else DiagnosticStatus.OK,
        name=f"{node_name.lstrip('/')}: mapping",
        message=". ".join(sentence for _, sentence in problems) or _all_well(health),
        hardware_id="oort",
        values=[KeyValue(key, value) for key, value in _figures(health)],
    )
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp
    return message


def _all_well(health: Health) -> str:
    if health.state == "mapping":
        return f"Mapping, {health.nodes} nodes"
    if health.state == "paused":
        return "Paused; map/resume_from_paused goes on"
    return "Not mapping" + (f", a map of {health.nodes} nodes is loaded" if health.nodes else "")


def _problems(health: Health) -> Iterator[tuple[int, str]]:
    """Levels and sentences that say what is wrong and what to do."""
    warn, error = DiagnosticStatus.WARN, DiagnosticStatus.ERROR
    if health.save_error:
        yield error, f"The map was not saved ({health.save_error}); correct that, then call map/stop or map on"
    if health.state != "mapping":
        return
    if health.scans_received == 0:
        yield warn, f"No scan has come on {health.scan_topic}; start the laser, or remap the topic scan"
    elif health.seconds_without_scan > _SILENCE:
        silence = f"{health.seconds_without_scan:.1f} s"
        yield warn, f"No scan on {health.scan_topic} for {silence}; check that the laser is running"
    if health.waiting_scans and health.seconds_waiting > _PATIENCE:
        yield warn, f"{health.waiting_scans} scans wait: {health.waiting_for}; check who publishes this transform"
    if health.drops_of_late:
        yield warn, f"Scans are left out ({', '.join(health.drops_of_late)}); check the laser, odometry and clocks"
    if health.tracking == "lost":
        yield warn, "Tracking is lost, mapping goes on by odometry alone; drive slowly to a place with more in view"
    if health.queue_size > _BEHIND:
        yield warn, f"{health.queue_size} scans and calls are queued; stand still until fewer are, or send fewer scans"


def _figures(health: Health) -> Iterator[tuple[str, str]]:
    """Keys and values, always in this order."""
    yield "state", health.state
    yield "path", health.path or "-"
    yield "queue size", str(health.queue_size)
    yield "scans received", str(health.scans_received)
    yield "scan rate [Hz]", f"{health.scan_rate_hz:.1f}"
    yield "scans processed", str(health.scans_processed)
    yield "scans dropped", str(sum(health.drops.values()))
    for reason in sorted(health.drops):
        yield f"scans dropped, {reason}", str(health.drops[reason])
    yield from _spread("ms per scan", health.ms_per_scan)
    yield from _spread("delay [ms]", health.delay_ms)
    yield "tracking", health.tracking
    yield "hit fraction", _number(health.hit_fraction, 2)
    yield "nodes", str(health.nodes)
    yield "closures", str(health.closures)
    yield "last save", health.last_save or "-"
    yield "time since last save [s]", _number(health.seconds_since_save, 1)
    yield "save error", health.save_error or "-"
    yield "scans waiting", str(health.waiting_scans)
    yield "waiting for", (health.waiting_for if health.waiting_scans else "") or "-"
    yield "clock jumps", str(health.clock_jumps)


def _spread(name: str, spread: Spread | None) -> Iterator[tuple[str, str]]:
    p50, p99, worst = (None, None, None) if spread is None else (spread.p50, spread.p99, spread.max)
    yield f"{name}, median", _number(p50, 1)
    yield f"{name}, 99 %", _number(p99, 1)
    yield f"{name}, worst", _number(worst, 1)


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
