# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes' private ROS parameters: a few of their own, and any parameter of params.json by its path."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import rospy

from oort._core import Parameters, unknown_parameter
from oort.errors import ParameterError
from oort.parameters import read_parameters
from oort.parameters.reader import set_parameter
from oort.recording.limits import ScanLimits

_LIMITS = ("min_range", "max_range", "mask")


@dataclass(frozen=True)
class Settings:
    """How the node was asked to run."""

    parameters: Parameters
    load: str
    """a saved map to begin with; empty for none"""
    events_log: str
    """where to write the events file; empty for nowhere"""
    limits: ScanLimits
    """which readings of the laser count"""


def read_settings() -> Settings:
    """Reads the private parameters. Raises ParameterError for one that is unknown, naming the nearest known one."""
    parameters, own = read_private(["load", "events_log"])
    return Settings(parameters, own["load"], own["events_log"], read_limits())


def read_private(names: Sequence[str]) -> tuple[Parameters, dict[str, str]]:
    """The parameters of params.json, and the texts of a node's own private parameters, empty where not given.

    Raises ParameterError for a private parameter that is unknown, naming the nearest known one.
    """
    private = rospy.get_param("~", {})
    own = {name: private.pop(name, "") for name in ["params", *names]}
    for name in _LIMITS:
        private.pop(name, None)  # see read_limits()
    for name, value in own.items():
        if not isinstance(value, str):
            raise ParameterError(f"~{name} must be a text, such as a path, not {value!r}")
    parameters = read_parameters(own["params"] or None)
    known = parameters.to_dict()
    for path, value in _flatten(private):
        try:
            if path not in known:
                raise ParameterError(unknown_parameter(path))
            set_parameter(parameters, path, value)
        except ParameterError as error:
            name = rospy.resolve_name("~" + path.replace(".", "/"))
            raise ParameterError(f"ROS parameter {name}: {error}") from error
    parameters.check()
    return parameters, own


def read_limits() -> ScanLimits:
    """The private parameters ~min_range, ~max_range [m] and ~mask, pairs of bearings [rad]. Raises ParameterError."""
    given = {name: rospy.get_param(f"~{name}") for name in _LIMITS if rospy.has_param(f"~{name}")}
    try:
        min_range, max_range = (None if given.get(name) is None else float(given[name]) for name in _LIMITS[:2])
        masks = [(float(begin), float(end)) for begin, end in given.get("mask", [])]
    except (TypeError, ValueError) as error:
        raise ParameterError(
            f"~min_range and ~max_range are metres, and ~mask a list of pairs of bearings such as [[-0.1, 0.1]], not "
            f"{given}: {error}"
        ) from None
    return ScanLimits(min_range, max_range, masks)


def _flatten(tree: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in tree.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
