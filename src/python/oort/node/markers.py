# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The pose graph and the named places as markers for RViz, each kind in a namespace that can be shown or hidden."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from oort._core import ODOMETRY_EDGE, SWITCH_ON, Map
from oort.node.messages import rotation
from oort.recording import Pose

# Each kind lies a little higher than the one before it, so that what overlaps does not flicker.
_CHAIN = ("chain", (0.25, 0.45, 0.9, 1.0), 0.01)
_BY_ODOMETRY = ("chain by odometry", (1.0, 0.6, 0.0, 1.0), 0.02)
_UNDONE = ("closures undone", (0.9, 0.1, 0.1, 1.0), 0.03)
_CLOSURES = ("closures", (0.1, 0.75, 0.2, 1.0), 0.04)
_NODES = ("nodes", (0.1, 0.2, 0.55, 1.0), 0.05)
_PLACES = ("places", (0.75, 0.1, 0.75, 1.0), 0.06)
_NAMES = ("place names", (0.3, 0.0, 0.3, 1.0), 0.3)

_LINE_WIDTH = 0.02  # [m]
_NODE_SIZE = 0.05  # [m]
_ARROW = (0.4, 0.08, 0.05)  # length, width, height [m]
_TEXT_HEIGHT = 0.22  # [m]

_Kind = tuple[str, tuple[float, float, float, float], float]  # namespace, colour, height [m]


def graph_markers(map_: Map, places: Sequence[tuple[str, str, Pose]], frame: str, stamp: Any) -> MarkerArray:
    """All of a map's graph and the places (namespace, id, pose in the map); what was shown before is deleted.

    A kind of which there is nothing gets no marker. Links that the optimiser has switched off are red.
    """
    points = [_point(x, y) for x, y, _ in map_.node_poses.tolist()]  # shared by all markers: making them costs most
    edges, closures = map_.edges, map_.switchable_edges
    by_odometry, believed = edges["type"] == ODOMETRY_EDGE, closures["switch"] >= SWITCH_ON
    markers = [
        _lines(_CHAIN, points, edges["i"][~by_odometry], edges["j"][~by_odometry]),
        _lines(_BY_ODOMETRY, points, edges["i"][by_odometry], edges["j"][by_odometry]),
        _lines(_UNDONE, points, closures["i"][~believed], closures["j"][~believed]),
        _lines(_CLOSURES, points, closures["i"][believed], closures["j"][believed]),
        _marker(_NODES, Marker.SPHERE_LIST, (_NODE_SIZE,) * 3, points=points),
    ]
    message = MarkerArray(markers=[Marker(action=Marker.DELETEALL), *(marker for marker in markers if marker.points)])
    for number, place in enumerate(sorted(places)):
        message.markers.extend(_place(number, *place))
    for marker in message.markers:
        marker.header.frame_id, marker.header.stamp = frame, stamp
    return message


def _lines(kind: _Kind, points: list[Point], i: NDArray[np.uint64], j: NDArray[np.uint64]) -> Marker:
    ends: Iterable[int] = np.column_stack([i, j]).ravel().tolist()
    return _marker(kind, Marker.LINE_LIST, (_LINE_WIDTH, 0.0, 0.0), points=[points[end] for end in ends])


def _place(number: int, name_space: str, id_: str, pose: Pose) -> tuple[Marker, Marker]:
    """An arrow and its name, on the side to which it does not point."""
    arrow = _marker(_PLACES, Marker.ARROW, _ARROW, id=number)
    text = f"{name_space}/{id_}" if name_space else id_
    name = _marker(_NAMES, Marker.TEXT_VIEW_FACING, (0.0, 0.0, _TEXT_HEIGHT), id=number, text=text)
    for marker in (arrow, name):
        marker.pose.position.x, marker.pose.position.y, theta = pose
        marker.pose.orientation = rotation(theta)
    name.pose.position.y -= math.copysign(_TEXT_HEIGHT, math.sin(theta))
    return arrow, name


def _marker(kind: _Kind, shape: int, scale: tuple[float, float, float], **fields: object) -> Marker:
    name_space, colour, height = kind
    marker = Marker(ns=name_space, type=shape, action=Marker.ADD, color=_colour(*colour), **fields)
    marker.scale.x, marker.scale.y, marker.scale.z = scale
    marker.pose.position.z = height
    marker.pose.orientation.w = 1.0
    return marker


def _colour(red: float, green: float, blue: float, alpha: float) -> ColorRGBA:
    return ColorRGBA(r=red, g=green, b=blue, a=alpha)


def _point(x: float, y: float) -> Point:
    point = Point()  # arguments to it would take three times as long
    point.x, point.y = x, y
    return point
