# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of one laser as scans with odometry, once the transforms that they need have come."""

import time
from collections.abc import Callable
from functools import partial

from sensor_msgs.msg import LaserScan

from oort.live import UnusableScanError
from oort.live.inbox import Resolve
from oort.node.logs import Seldom, once
from oort.node.messages import stamp_parts, to_scan
from oort.node.transforms import Transforms
from oort.recording import Pose, Scan
from oort.recording.laser_scan import seconds
from oort.recording.limits import NO_LIMITS, ScanLimits
from oort.recording.motion import SNAPSHOT, beam_span

_MOUNT_PATIENCE = 5.0  # [s] of the wall's clock that a further laser's transform may come later than its first scan


class Laser:
    """Takes the scans of all lasers; the one whose scan can be used first is the main one, whose scans others join."""

    def __init__(
        self,
        transforms: Transforms,
        compensates_motion: bool,
        found: Callable[[str, Pose], None],
        limits: ScanLimits = NO_LIMITS,
    ) -> None:
        """``found`` is told of the laser: its frame and T_base_sensor, before its first scan.

        ``compensates_motion``: whether a scan waits for the odometry at its last beam, if it took time.
        """
        self._transforms = transforms
        self._compensates_motion = compensates_motion
        self._found = found
        self._limits = limits
        self._say_frame, self._say_increment = once(), Seldom()
        self._unplaced: dict[str, float] = {}  # [s] time.monotonic() of the first scan in frames without a transform
        self.frame = ""
        """the main one's frame, once it is known"""

    def resolve_later(self, message: LaserScan, sensor_frame: str, arrived: float) -> tuple[Resolve, Resolve]:
        """What makes a scan of a message that arrived at a monotonic time [s], when it is its turn.

        The second does so of what is known, when no more will come.
        """
        stamp = seconds(*stamp_parts(message.header.stamp))
        span = self._span(message)

        def resolve(last_resort: bool = False) -> Scan | None:
            if not message.ranges:
                raise UnusableScanError("without readings")
            mount = self._transforms.mount(sensor_frame)
            if mount is None:
                self._check_patience(sensor_frame)
            placement = None if mount is None else self._transforms.place(stamp, arrived, span, last_resort)
            if mount is None or placement is None:
                return None
            if not self.frame:
                self._found(sensor_frame, mount.sensor_on_base)
                self.frame = sensor_frame
            other = mount.sensor_on_base if sensor_frame != self.frame else None
            return to_scan(message, placement, mount.upside_down, self._limits, other)

        return resolve, partial(resolve, last_resort=True)

    def _check_patience(self, sensor_frame: str) -> None:
        """Raises UnusableScanError if the scans of a laser that nobody places would hold up another's."""
        first = self._unplaced.setdefault(sensor_frame, time.monotonic())
        if self.frame and time.monotonic() > first + _MOUNT_PATIENCE:
            raise UnusableScanError(f"no transform from the base to their frame {sensor_frame}")

    def awaited(self, sensor_frame: str, expected: str) -> str:
        """The frame whose scans are used or, before one could be, wait: ``expected``, unless they come in another."""
        if self.frame or sensor_frame == expected:
            return self.frame or expected
        self._say_frame(
            f"the scans are in frame {sensor_frame}, not in the sensor_frame {expected} of the parameters; using "
            f"{sensor_frame}"
        )
        return sensor_frame

    def _span(self, message: LaserScan) -> tuple[float, float]:
        span = beam_span(len(message.ranges), message.time_increment) if self._compensates_motion else SNAPSHOT
        if span is None:
            self._say_increment(
                f"a time_increment of {message.time_increment} s cannot be: the beams are taken as measured at once"
            )
        return span or SNAPSHOT
