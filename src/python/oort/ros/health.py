# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a live session's figures."""

from oort.live import LiveSession
from oort.ros.diagnostics import Health


def look_over(live: LiveSession, scan_topic: str, waiting_for: str) -> Health:
    """How mapping goes now; ``waiting_for`` says which transform the waiting scans lack."""
    snapshot = live.snapshot
    figures, saver = live.figures, live.keeper.saver
    waiting, seconds_waiting = live.inbox.waiting()
    result = figures.last_result
    return Health(
        state=snapshot.state.value,
        path=snapshot.path,
        queue_size=len(live.inbox),
        scan_topic=scan_topic,
        scans_received=figures.scans_arrived,
        scan_rate_hz=figures.scan_rate,
        seconds_without_scan=figures.seconds_without_scan,
        scans_processed=figures.scans_mapped,
        drops=dict(figures.drops.counts),
        drops_of_late=figures.drops.of_late(),
        ms_per_scan=figures.milliseconds.spread,
        delay_ms=figures.delays.spread,
        tracking=figures.tracking(snapshot.state).value,
        hit_fraction=None if result is None else result.hit_fraction,
        nodes=snapshot.num_nodes,
        closures=snapshot.closures,
        last_save=saver.last_saved,
        seconds_since_save=saver.seconds_since_save,
        save_error=saver.error,
        waiting_scans=waiting,
        seconds_waiting=seconds_waiting,
        waiting_for=waiting_for,
        clock_jumps=figures.clock_jumps,
    )
