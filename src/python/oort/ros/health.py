# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a live session's figures."""

import time

from oort.live import LiveSession
from oort.ros.diagnostics import Health


def look_over(live: LiveSession, scan_topic: str, waiting_for: str) -> Health:
    """How mapping goes now; ``waiting_for`` says which transform the waiting scans lack."""
    snapshot = live.snapshot
    waiting, seconds_waiting = live.inbox.waiting()
    result = live.last_result
    return Health(
        state=snapshot.state.value,
        path=snapshot.path,
        queue_size=len(live.inbox),
        scan_topic=scan_topic,
        scans_received=live.scans_arrived,
        scan_rate_hz=live.arrivals.hertz(time.monotonic()),
        seconds_without_scan=live.seconds_without_scan,
        scans_processed=live.scans_mapped,
        drops=dict(live.drops),
        ms_per_scan=live.milliseconds.spread,
        delay_ms=live.delays.spread,
        tracking=live.tracking.value,
        hit_fraction=None if result is None else result.hit_fraction,
        nodes=snapshot.num_nodes,
        closures=snapshot.closures,
        last_save=live.saver.last_saved,
        seconds_since_save=live.saver.seconds_since_save,
        save_error=live.saver.error,
        waiting_scans=waiting,
        seconds_waiting=seconds_waiting,
        waiting_for=waiting_for,
        clock_jumps=live.clock_jumps,
    )
