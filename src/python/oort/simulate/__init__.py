# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated drives: homes that are made up or given, seen by the sensor of a home robot, with ground truth."""

from oort.simulate.drive import Drive, Event, SimulationConfig, simulate_drive
from oort.simulate.home import Home, Room
from oort.simulate.plan import Plan
from oort.simulate.plan_files import read_plan
from oort.simulate.presets import PRESETS
from oort.simulate.sensor import Sensor

__all__ = [
    "PRESETS",
    "Drive",
    "Event",
    "Home",
    "Plan",
    "Room",
    "Sensor",
    "SimulationConfig",
    "read_plan",
    "simulate_drive",
]
