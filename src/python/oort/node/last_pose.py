# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the robot was last on a map, kept beside it."""

import json
from pathlib import Path

from oort.errors import OortError
from oort.export.files import write_atomically
from oort.inputs import floats, quoted, read_text
from oort.node.logs import log, once
from oort.recording import Pose


class LastPose:
    """The file BASE.last_pose.json with T_map_sensor."""

    def __init__(self, base: str) -> None:
        """Of the map with this base path."""
        self.path = Path(base + ".last_pose.json")
        self._complain = once()

    def read(self) -> Pose | None:
        """None if there is none that can be used; a file that cannot be read is warned of."""
        try:
            if not self.path.exists():
                return None
            pose = json.loads(read_text(self.path))["T_map_sensor"]
            if not isinstance(pose, list):
                raise TypeError(f"{quoted(pose)} is no pose")
            x, y, theta = floats([repr(float(value)) for value in pose], str(self.path))
        except (OortError, OSError, ValueError, LookupError, TypeError, OverflowError, RecursionError) as error:
            log.warning("%s cannot be used: %s", self.path, quoted(str(error)))
            return None
        return x, y, theta

    def write(self, T_map_sensor: Pose) -> None:  # noqa: N803
        """Keeps the pose for the next start; if that cannot be done, a warning says so once."""
        try:
            write_atomically(self.path, (json.dumps({"T_map_sensor": T_map_sensor}) + "\n").encode())
        except OortError as error:
            self._complain(f"the pose is not kept for the next start: {error}")
