# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Oort: 2D laser SLAM for home robots with short-range, coarse depth sensors."""

# ruff: noqa: E402 (the imports take a third of a second, in which Ctrl-C may come)
from oort.interrupts import end_without_a_word

end_without_a_word()

from oort._core import (
    LocalizationState,
    Map,
    OccupancyGrid,
    Parameters,
    RenderedMap,
    ScanOutcome,
    ScanResult,
    TrackingState,
    load_map,
    merge_maps,
    render_map,
    save_map,
)
from oort._core import __version__ as __version__
from oort.config import Config
from oort.errors import InputError, MapFileError, OortError, ParameterError, StateError
from oort.export.notebook import map_html, map_png
from oort.live import LiveMapper
from oort.localization import Localizer
from oort.mapper import Mapper
from oort.offline.replay import replay
from oort.parameters import read_parameters
from oort.recording import LaserScan, open_recording
from oort.session import Session, State

__all__ = [
    "Config",
    "InputError",
    "LaserScan",
    "LiveMapper",
    "LocalizationState",
    "Localizer",
    "Map",
    "MapFileError",
    "Mapper",
    "OccupancyGrid",
    "OortError",
    "ParameterError",
    "Parameters",
    "RenderedMap",
    "ScanOutcome",
    "ScanResult",
    "Session",
    "State",
    "StateError",
    "TrackingState",
    "load_map",
    "merge_maps",
    "open_recording",
    "read_parameters",
    "render_map",
    "replay",
    "save_map",
]

# Notebooks ask an object for these. The engine makes maps, but pictures are drawn in Python.
setattr(Map, "_repr_html_", map_html)  # noqa: B010 (the stub does not know them)
setattr(Map, "_repr_png_", map_png)  # noqa: B010
