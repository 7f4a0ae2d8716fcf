# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A page that shows a live session while it runs: the map as it grows, the robot, the queue, how long things take."""

from oort.view.server import PORT, Viewer

__all__ = ["PORT", "Viewer"]
