# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes' private ROS parameters: a few of their own, and any parameter of params.json by its path."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import rospy

from oort._core import Parameters
from oort.errors import ParameterError
from oort.parameters import read_parameters
from oort.parameters.reader import unknown_parameter


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
    parameters, own = read_private(["load", "events_log"])
    return Settings(parameters, own["load"], own["events_log"])


def read_private(names: Sequence[str]) -> tuple[Parameters, dict[str, str]]:
    """The parameters of params.json, and the texts of a node's own private parameters, empty where not given.

    Raises ParameterError for a private parameter that is unknown, naming the nearest known one.
    """
    private = rospy.get_param("~", {})
    own = {name: private.pop(name, "") for name in ["params", *names]}
    for name, value in own.items():
        if not isinstance(value, str):
            raise ParameterError(f"~{name} must be a text, such as a path, not {value!r}")
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
    return parameters, own


def _flatten(tree: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in tree.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
