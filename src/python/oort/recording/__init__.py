# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of robots: one way to read CARMEN logs and ROS 1 and ROS 2 bags."""

from oort.recording.open import ACCEPTED, open_recording
from oort.recording.types import Pose, Recording, Scan

__all__ = ["ACCEPTED", "Pose", "Recording", "Scan", "open_recording"]
