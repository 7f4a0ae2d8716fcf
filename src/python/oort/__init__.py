# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Oort: 2D laser SLAM for home robots with short-range, coarse depth sensors."""

from oort._core import Map, Mapper, OccupancyGrid, Parameters, ScanResult, load_map, render_map, save_map
from oort._core import __version__ as __version__
from oort.errors import InputError, MapFileError, OortError, ParameterError, StateError
from oort.parameters import read_parameters
from oort.session import Session, State

__all__ = [
    "InputError",
    "Map",
    "MapFileError",
    "Mapper",
    "OccupancyGrid",
    "OortError",
    "ParameterError",
    "Parameters",
    "ScanResult",
    "Session",
    "State",
    "StateError",
    "load_map",
    "read_parameters",
    "render_map",
    "save_map",
]
