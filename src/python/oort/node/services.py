# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The node's services: oort_msgs in front of a live session."""

from collections.abc import Callable
from typing import Any

from oort.errors import InputError
from oort.history import describe, versions
from oort.live import LiveSession
from oort.node.messages import place_grid, pose_stamped
from oort.node.middleware import Middleware

_Handle = Callable[[Any], dict[str, Any] | None]


class Services:
    """Answers map/* and graph_loc/* under the node's name. What fails, fails with a sentence that says what to do."""

    def __init__(self, live: LiveSession, middleware: Middleware, map_frame: str) -> None:
        """Offers the services."""
        self._live = live
        self._middleware = middleware
        self._map_frame = map_frame
        middleware.offer("map/republish_maps", "Empty", lambda _: live.redraw())
        middleware.offer("map/start", "SetString", self._start)
        middleware.offer("map/load", "SetString", self._load)
        middleware.offer("map/resume", "MapResume", self._resume)
        middleware.offer("map/resume_here", "SetString", self._resume_here)
        middleware.offer("map/state", "GetString", lambda _: {"data": live.snapshot.state.value})
        middleware.offer("map/name", "GetString", lambda _: {"data": live.snapshot.path})
        middleware.offer("map/has_map", "GetBool", lambda _: {"data": live.has_map})
        middleware.offer("map/num_nodes", "GetUInt", lambda _: {"data": live.snapshot.num_nodes})
        middleware.offer("map/map", "GetMap", self._map)
        middleware.offer("map/history", "GetStrings", self._history)
        middleware.offer("map/restore", "SetString", self._restore)
        middleware.offer("graph_loc/create", "LocCreate", self._create)
        middleware.offer("graph_loc/create_points", "LocCreatePoints", self._create_points)
        middleware.offer("graph_loc/is_ready", "GetBool", lambda _: {"data": live.places.is_ready})
        middleware.offer("graph_loc/list", "LocNamespace", self._list)
        middleware.offer("graph_loc/list_namespaces", "GetStrings", self._list_namespaces)
        middleware.offer("graph_loc/delete", "LocDelete", self._delete)
        middleware.offer("graph_loc/locate", "LocLocate", self._locate)
        middleware.offer("graph_loc/clear", "LocNamespace", self._clear)
        # map/stop comes last: who waits for it finds all the others.
        for name in ("notify_docked", "pause", "resume_from_paused", "accept", "reject", "clear", "stop"):
            middleware.offer(f"map/{name}", "Empty", self._empty_call(f"map/{name}"))

    def _empty_call(self, name: str) -> _Handle:
        def handle(_: Any) -> None:
            self._live.call(name)

        return handle

    def _start(self, request: Any) -> None:
        self._live.call("map/start", [request.data])

    def _load(self, request: Any) -> None:
        self._live.call("map/load", [request.data])

    def _resume(self, request: Any) -> None:
        pose = request.pose
        self._live.call("map/resume", [request.new_map_loc, [pose.x, pose.y, pose.theta]])

    def _resume_here(self, request: Any) -> None:
        """map/resume from where a localiser sees the robot."""
        self._live.call("map/resume", [request.data, list(self._live.places.here("map/resume_here"))])

    def _map(self, _: Any) -> dict[str, Any]:
        drawing = self._live.gallery.latest(self._live.snapshot.revision)
        message = self._middleware.grid(drawing.grid)
        return {"map": place_grid(message, drawing.grid, self._map_frame, self._stamp())}

    def _history(self, _: Any) -> dict[str, Any]:
        path = self._live.snapshot.path
        return {"data": [describe(version) for version in versions(path)] if path else []}

    def _restore(self, request: Any) -> None:
        if not request.data.isdecimal():
            raise InputError(f"{request.data!r} is no version's number; map/history lists them")
        self._live.restore(int(request.data))

    def _create(self, request: Any) -> None:
        self._live.places.create(request.nspace, request.id)

    def _create_points(self, request: Any) -> None:
        points = [[point.x, point.y] for point in request.points]
        self._live.call("graph_loc/create_points", [list(request.nspaces), points, list(request.ids)])

    def _list(self, request: Any) -> dict[str, Any]:
        return _places(
            [
                (space, id)
                for space, id in self._live.snapshot.places
                if space == request.nspace or (request.use_as_prefix and space.startswith(request.nspace))
            ]
        )

    def _list_namespaces(self, _: Any) -> dict[str, Any]:
        return {"data": list(dict.fromkeys(space for space, _ in self._live.snapshot.places))}

    def _delete(self, request: Any) -> dict[str, Any]:
        if self._live.call("graph_loc/delete", [request.nspace, request.id]):
            return {"success": True}
        return {"success": False, "message": f"graph_loc/delete: there is no {request.nspace!r}/{request.id!r}"}

    def _locate(self, request: Any) -> dict[str, Any]:
        pose = self._live.places.locate(request.nspace, request.id)
        return {"pose": pose_stamped(pose, self._map_frame, self._stamp())}

    def _clear(self, request: Any) -> dict[str, Any]:
        return _places(self._live.call("graph_loc/clear", [request.nspace, request.use_as_prefix]))

    def _stamp(self) -> Any:
        return self._middleware.stamp(self._middleware.now())


def _places(names: list[tuple[str, str]]) -> dict[str, Any]:
    return {"nspaces": [space for space, _ in names], "ids": [id for _, id in names]}
