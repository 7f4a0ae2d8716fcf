# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Sensors that home robots have, by the figures of their data sheets, rounded. Noise that none tells is Kuri's."""

import math

from oort.simulate.sensor import Sensor

PRESETS = {
    "kuri": Sensor(),
    "realsense": Sensor(math.radians(87.0), 87, 0.28, 4.0, noise=0.005, noise_per_metre=0.01),
    "ld06": Sensor(
        2.0 * math.pi, 450, 0.02, 8.0, noise=0.01, noise_per_metre=0.005, sweep_seconds=0.1, driver="turned-round"
    ),
    "hokuyo": Sensor(math.radians(270.0), 540, 0.06, 5.0, noise=0.01, noise_per_metre=0.005, sweep_seconds=0.019),
}

MEANINGS = {
    "kuri": "short range: 180 degrees, a beam per degree, 3 m",
    "realsense": "a depth camera such as RealSense's D435, as a scan: 87 degrees, a beam per degree, 0.28 to 4 m",
    "ld06": "a clockwise spinning laser such as LD06 or RPLidar: 360 degrees, 450 beams in 0.1 s, 8 m indoors; its "
    "driver turns the beams round and keeps their times",
    "hokuyo": "a scanner such as Hokuyo's UST-05LX: 270 degrees, a beam per half degree, all in 19 ms, 5 m",
}
"""what each is, for help"""
