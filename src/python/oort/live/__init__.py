# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A session that keeps up with a robot: what the ROS node drives, without ROS."""

from oort.live.inbox import UnusableScanError
from oort.live.listener import Listener
from oort.live.mapper import LiveMapper
from oort.live.session import LiveSession
from oort.live.snapshot import Drawing, Snapshot

__all__ = ["Drawing", "Listener", "LiveMapper", "LiveSession", "Snapshot", "UnusableScanError"]
