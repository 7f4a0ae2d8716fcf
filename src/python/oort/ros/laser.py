# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of one laser as scans with odometry, once the transforms that they need have come."""

from collections.abc import Callable

from sensor_msgs.msg import LaserScan

from oort.live import UnusableScanError
from oort.live.inbox import Resolve
from oort.recording import Pose, Scan
from oort.recording.laser_scan import seconds
from oort.ros.messages import to_scan
from oort.ros.transforms import Transforms


class Laser:
    """Takes the scans of the laser whose scan can be used first, and refuses those of others."""

    def __init__(self, transforms: Transforms, found: Callable[[str, Pose], None]) -> None:
        """``found`` is told of the laser: its frame and T_base_sensor, before its first scan."""
        self._transforms = transforms
        self._found = found
        self.frame = ""
        """its frame, once it is known"""

    def resolve_later(self, message: LaserScan, sensor_frame: str, arrived: float) -> Resolve:
        """What makes a scan of a message that arrived at a monotonic time [s], when it is its turn."""
        stamp = seconds(message.header.stamp.secs, message.header.stamp.nsecs)

        def resolve() -> Scan | None:
            if not message.ranges:
                raise UnusableScanError("without readings")
            if self.frame and sensor_frame != self.frame:
                raise UnusableScanError("in another laser's frame")
            mount = self._transforms.mount(sensor_frame)
            odometry = None if mount is None else self._transforms.odometry(stamp, arrived)
            if mount is None or odometry is None:
                return None
            if not self.frame:
                self._found(sensor_frame, mount.sensor_on_base)
                self.frame = sensor_frame
            return to_scan(message, odometry, mount.upside_down)

        return resolve
