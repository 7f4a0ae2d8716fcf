# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes (and reads back) what other programs understand: trajectories, grid maps, pose graphs and pictures."""

from oort.export.g2o import PoseGraph, read_g2o, write_g2o
from oort.export.map_server import GridMap, read_map_server, write_map_server
from oort.export.picture import write_closures_picture, write_picture
from oort.export.tum import Trajectory, read_tum, write_tum

__all__ = [
    "GridMap",
    "PoseGraph",
    "Trajectory",
    "read_g2o",
    "read_map_server",
    "read_tum",
    "write_closures_picture",
    "write_g2o",
    "write_map_server",
    "write_picture",
    "write_tum",
]
