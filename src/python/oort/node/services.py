# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The node's services: oort_msgs and std_srvs in front of a live session."""

from collections.abc import Callable
from typing import Any

import rospy
from oort_msgs import srv
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from oort.errors import OortError
from oort.live import LiveSession
from oort.node.messages import FastMapResponse, grid_message, map_reply, pose_stamped


class Services:
    """Answers map/* and graph_loc/* under the node's name. What fails, fails with a sentence that says what to do."""

    def __init__(self, live: LiveSession, map_frame: str) -> None:
        """Offers the services."""
        self._live = live
        self._map_frame = map_frame
        self._offer("map/republish_maps", Empty, self._republish)
        self._offer("map/start", srv.SetString, self._start)
        self._offer("map/load", srv.SetString, self._load)
        self._offer("map/resume", srv.MapResume, self._resume)
        self._offer("map/resume_here", srv.SetString, self._resume_here)
        self._offer("map/state", srv.GetString, lambda _: srv.GetStringResponse(live.snapshot.state.value))
        self._offer("map/name", srv.GetString, lambda _: srv.GetStringResponse(live.snapshot.path))
        self._offer("map/has_map", srv.GetBool, lambda _: srv.GetBoolResponse(live.has_map))
        self._offer("map/num_nodes", srv.GetUInt, lambda _: srv.GetUIntResponse(live.snapshot.num_nodes))
        self._offer("map/map", srv.GetMap, self._map)
        self._offer("graph_loc/create", srv.LocCreate, self._create)
        self._offer("graph_loc/create_points", srv.LocCreatePoints, self._create_points)
        self._offer("graph_loc/is_ready", srv.GetBool, lambda _: srv.GetBoolResponse(live.places.is_ready))
        self._offer("graph_loc/list", srv.LocNamespace, self._list)
        self._offer("graph_loc/list_namespaces", srv.GetStrings, self._list_namespaces)
        self._offer("graph_loc/delete", srv.LocDelete, self._delete)
        self._offer("graph_loc/locate", srv.LocLocate, self._locate)
        self._offer("graph_loc/clear", srv.LocNamespace, self._clear)
        # map/stop comes last: who waits for it finds all the others.
        for name in ("notify_docked", "pause", "resume_from_paused", "clear", "stop"):
            self._offer(f"map/{name}", Empty, self._empty_call(f"map/{name}"))

    def _offer(self, name: str, kind: Any, handle: Callable[[Any], Any]) -> None:
        def answer(request: Any) -> Any:
            try:
                return handle(request)
            except OortError as error:
                text = str(error) if str(error).startswith(name) else f"{name}: {error}"
                rospy.logwarn("%s", text)
                raise rospy.ServiceException(text) from error

        rospy.Service(f"~{name}", kind, answer)

    def _empty_call(self, name: str) -> Callable[[EmptyRequest], EmptyResponse]:
        def handle(_: EmptyRequest) -> EmptyResponse:
            self._live.call(name)
            return EmptyResponse()

        return handle

    def _republish(self, _: EmptyRequest) -> EmptyResponse:
        self._live.redraw()
        return EmptyResponse()

    def _start(self, request: srv.SetStringRequest) -> srv.SetStringResponse:
        self._live.call("map/start", [request.data])
        return srv.SetStringResponse()

    def _load(self, request: srv.SetStringRequest) -> srv.SetStringResponse:
        self._live.call("map/load", [request.data])
        return srv.SetStringResponse()

    def _resume(self, request: srv.MapResumeRequest) -> srv.MapResumeResponse:
        pose = request.pose
        self._live.call("map/resume", [request.new_map_loc, [pose.x, pose.y, pose.theta]])
        return srv.MapResumeResponse()

    def _resume_here(self, request: srv.SetStringRequest) -> srv.SetStringResponse:
        """map/resume from where a localiser sees the robot."""
        self._live.call("map/resume", [request.data, list(self._live.places.here("map/resume_here"))])
        return srv.SetStringResponse()

    def _map(self, _: srv.GetMapRequest) -> FastMapResponse:
        drawing = self._live.gallery.latest(self._live.snapshot.revision)
        return map_reply(grid_message(drawing.grid, self._map_frame, rospy.Time.now()))

    def _create(self, request: srv.LocCreateRequest) -> srv.LocCreateResponse:
        self._live.places.create(request.nspace, request.id)
        return srv.LocCreateResponse()

    def _create_points(self, request: srv.LocCreatePointsRequest) -> srv.LocCreatePointsResponse:
        points = [[point.x, point.y] for point in request.points]
        self._live.call("graph_loc/create_points", [list(request.nspaces), points, list(request.ids)])
        return srv.LocCreatePointsResponse()

    def _list(self, request: srv.LocNamespaceRequest) -> srv.LocNamespaceResponse:
        return _places(
            [
                (space, id)
                for space, id in self._live.snapshot.places
                if space == request.nspace or (request.use_as_prefix and space.startswith(request.nspace))
            ]
        )

    def _list_namespaces(self, _: srv.GetStringsRequest) -> srv.GetStringsResponse:
        return srv.GetStringsResponse(list(dict.fromkeys(space for space, _ in self._live.snapshot.places)))

    def _delete(self, request: srv.LocDeleteRequest) -> srv.LocDeleteResponse:
        return srv.LocDeleteResponse(self._live.call("graph_loc/delete", [request.nspace, request.id]))

    def _locate(self, request: srv.LocLocateRequest) -> srv.LocLocateResponse:
        pose = self._live.places.locate(request.nspace, request.id)
        return srv.LocLocateResponse(pose_stamped(pose, self._map_frame, rospy.Time.now()))

    def _clear(self, request: srv.LocNamespaceRequest) -> srv.LocNamespaceResponse:
        return _places(self._live.call("graph_loc/clear", [request.nspace, request.use_as_prefix]))


def _places(names: list[tuple[str, str]]) -> srv.LocNamespaceResponse:
    return srv.LocNamespaceResponse(nspaces=[space for space, _ in names], ids=[id for _, id in names])
