# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Plays a recording into a live session, as fast as the robot drove or faster."""

import math
import time
from collections.abc import Callable

from oort.errors import OortError
from oort.live import LiveSession
from oort.recording import Recording, Scan
from oort.session import State

_AHEAD = 4  # scans in the queue, beyond which the player waits: a slow machine lags behind, and loses nothing
_LOOK = 0.02  # [s] between looks


def play(
    recording: Recording,
    live: LiveSession,
    speed: float,
    map_path: str,
    told: Callable[[float], None],
) -> None:
    """Maps a recording ``speed`` times as fast as it was recorded, inf for as fast as can be, until the map is stopped.

    The map is saved at ``map_path`` if that is not empty. ``told`` hears what share was played.
    Raises InputError for a recording that cannot be read, MapFileError where the map cannot be saved, and OortError if
    mapping ends by a fault of its own.
    """
    live.mount_sensor(recording.sensor_on_base)
    live.call("map/start", [map_path])
    begin: tuple[float, float] | None = None  # of the recording, and by this machine's clock
    for number, scan in enumerate(recording.scans(), start=1):
        now = time.monotonic()
        begin = begin or (scan.time, now)
        due = begin[1] + (scan.time - begin[0]) / speed if math.isfinite(speed) else now
        while time.monotonic() < due or len(live.inbox) > _AHEAD:
            if live.failure:
                raise OortError(live.failure)
            time.sleep(min(_LOOK, max(due - time.monotonic(), 0.001)))
        if live.snapshot.state is State.NOT_MAPPING:
            return
        live.add_scan(_ready(scan))
        told(number / max(1, recording.num_scans))
    live.call("map/stop")


def _ready(scan: Scan) -> Callable[[], Scan]:
    return lambda: scan
