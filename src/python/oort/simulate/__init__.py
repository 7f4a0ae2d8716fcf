# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated drives: made-up homes, seen by a short-range sensor on a home robot, with ground truth."""

from oort.simulate.drive import Drive, Event, SimulationConfig, simulate_drive
from oort.simulate.home import Home, Room
from oort.simulate.sensor import Sensor

__all__ = ["Drive", "Event", "Home", "Room", "Sensor", "SimulationConfig", "simulate_drive"]
