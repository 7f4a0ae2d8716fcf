# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of robots: one way to read CARMEN logs and ROS 1 and ROS 2 bags."""

from oort.recording.open import ACCEPTED, open_recording
from oort.recording.types import LaserScan, Pose, Recording, Scan, Sweep

__all__ = ["ACCEPTED", "LaserScan", "Pose", "Recording", "Scan", "Sweep", "open_recording"]
