# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the robot was last on a map, kept beside it."""

import json
from pathlib import Path

from oort.errors import OortError
from oort.export.files import write_atomically
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
            x, y, theta = map(float, json.loads(self.path.read_text(encoding="utf-8"))["T_map_sensor"])
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError) as error:
            log.warning("%s cannot be used: %s", self.path, error)
            return None
        return x, y, theta

    def write(self, T_map_sensor: Pose) -> None:  # noqa: N803
        """Keeps the pose for the next start; if that cannot be done, a warning says so once."""
        try:
            write_atomically(self.path, (json.dumps({"T_map_sensor": T_map_sensor}) + "\n").encode())
        except OortError as error:
            self._complain(f"the pose is not kept for the next start: {error}")
