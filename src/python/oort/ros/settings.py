# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The node's private ROS parameters: ~params, ~load, ~events_log, and any parameter of params.json by its path."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import rospy

from oort._core import Parameters
from oort.errors import ParameterError
from oort.parameters import read_parameters
from oort.parameters.reader import unknown_parameter

_OWN = ("params", "load", "events_log")


@dataclass(frozen=True)
class Settings:
    """How the node was asked to run."""

    parameters: Parameters
    load: str
    """a saved map to begin with; empty for none"""
    events_log: str
    """where to write the events file; empty for nowhere"""


def read_settings() -> Settings:
    """Reads the private parameters. Raises ParameterError for one that is unknown, naming the nearest known one."""
    private = rospy.get_param("~", {})
    own = {name: private.pop(name, "") for name in _OWN}
    for name, value in own.items():
        if not isinstance(value, str):
            raise ParameterError(f"~{name} must be a path, not {value!r}")
    parameters = read_parameters(own["params"] or None)
    known = parameters.to_dict()
    for path, value in _flatten(private):
        try:
            if path not in known:
                raise ParameterError(unknown_parameter(path))
            parameters.set(path, value)
        except ParameterError as error:
            name = rospy.resolve_name("~" + path.replace(".", "/"))
            raise ParameterError(f"ROS parameter {name}: {error}") from error
    parameters.check()
    return Settings(parameters, own["load"], own["events_log"])


def _flatten(tree: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in tree.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
