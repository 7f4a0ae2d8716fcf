# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes' ROS parameters: a few of their own, and any parameter of params.json by its path."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from oort._core import Parameters, unknown_parameter
from oort.errors import ParameterError
from oort.node.middleware import Middleware
from oort.parameters import read_parameters
from oort.parameters.reader import missing_viewers, set_parameter
from oort.recording.limits import ScanLimits

_LIMITS = ("min_range", "max_range", "mask")
_VIEW = ("view_port", "view_address", "view_control")


@dataclass(frozen=True)
class ViewSettings:
    """The live view, where one was asked for."""

    port: int
    address: str
    control: bool


@dataclass(frozen=True)
class Settings:
    """How a node was asked to run."""

    parameters: Parameters
    own: dict[str, str]
    """the texts of the node's own parameters, empty where not given"""
    limits: ScanLimits
    """which readings of the laser count"""
    view: ViewSettings | None


def read_settings(middleware: Middleware, names: Sequence[str]) -> Settings:
    """Reads the node's parameters, ``names`` being its own.

    Raises ParameterError for one that is unknown, naming the nearest known one.
    """
    given = middleware.parameters()
    own = {name: given.pop(name, "") for name in ["params", *names]}
    limits = _read_limits(middleware, {name: given.pop(name) for name in _LIMITS if name in given})
    view = _read_view(middleware, {name: given.pop(name) for name in _VIEW if name in given})
    for name, value in own.items():
        inner = {path: given[path] for path in given if path.startswith(f"{name}.")}
        if inner or not isinstance(value, str):
            value = inner or value
            raise ParameterError(f"{middleware.parameter_name(name)} must be a text, such as a path, not {value!r}")
    parameters = read_parameters(own["params"] or None)
    known = parameters.to_dict()
    for path, value in given.items():
        try:
            if path not in known:
                raise ParameterError(unknown_parameter(path))
            set_parameter(parameters, path, value)
        except ParameterError as error:
            name = middleware.resolve(middleware.parameter_name(path))
            raise ParameterError(f"ROS parameter {name}: {error}") from error
    parameters.check()
    for note in missing_viewers(parameters):
        if note.partition(":")[0] in given:
            warnings.warn(note, stacklevel=2)
    middleware.show_parameters({**own, **parameters.to_dict()})
    return Settings(parameters, own, limits, view)


def _read_limits(middleware: Middleware, given: dict[str, Any]) -> ScanLimits:
    """Metres and pairs of bearings [rad]. Raises ParameterError."""
    try:
        min_range, max_range = (None if given.get(name) is None else float(given[name]) for name in _LIMITS[:2])
        masks = [(float(begin), float(end)) for begin, end in _pairs(given.get("mask", []))]
    except (TypeError, ValueError) as error:
        low, high, mask = map(middleware.parameter_name, _LIMITS)
        raise ParameterError(
            f"{low} and {high} are metres, and {mask} a list of pairs of bearings such as [[-0.1, 0.1]], not "
            f"{given}: {error}"
        ) from None
    return ScanLimits(min_range, max_range, masks)


def _read_view(middleware: Middleware, given: dict[str, Any]) -> ViewSettings | None:
    """Raises ParameterError."""
    port, address, control = (
        given.get("view_port", 0),
        given.get("view_address", "127.0.0.1"),
        given.get("view_control"),
    )
    port_name, address_name, control_name = map(middleware.parameter_name, _VIEW)
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        raise ParameterError(f"{port_name} must be a port, 1 to 65535, or 0 for no view, not {port!r}")
    if not isinstance(address, str) or not isinstance(control, bool | None):
        raise ParameterError(f"{address_name} must be a text and {control_name} true or false, not {given}")
    return ViewSettings(port, address, bool(control)) if port else None


def _pairs(values: Any) -> Any:
    """ROS 2 has no lists of lists: there the bearings stand one after another."""
    if values and not isinstance(values[0], list | tuple):
        return list(zip(values[::2], values[1::2], strict=True))
    return values
