# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How messages name the calls of a session: as who made them knows them, a program by methods, a robot by services."""

from collections.abc import Callable

Naming = Callable[[str], str]
"""From a call's name in an events file, such as map/notify_docked, to the one in messages."""

METHODS = {
    "map/start": "start",
    "map/load": "load",
    "map/resume": "resume",
    "map/notify_docked": "notify_docked",
    "map/pause": "pause",
    "map/resume_from_paused": "resume_from_paused",
    "map/stop": "stop",
    "map/clear": "clear",
    "map/accept": "accept",
    "map/reject": "reject",
    "graph_loc/create": "create_location",
    "graph_loc/create_points": "create_points",
    "graph_loc/delete": "delete_location",
    "graph_loc/clear": "clear_locations",
}
"""The methods of Session that calls make."""

_READERS = {"graph_loc/list": "locations.list_ids", "graph_loc/locate": "locations.locate"}


def service(call: str) -> str:
    """As the events file has it and the node offers it."""
    return call


def session_method(call: str) -> str:
    """As a program calls it."""
    return f"Session.{(METHODS | _READERS)[call]}"
