# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Markers for RViz: every node, link and place is shown in its kind, and nothing that RViz would refuse."""

import io
import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rospy")
import genpy
from visualization_msgs.msg import Marker, MarkerArray

from oort import LaserScan, Map, Mapper, Parameters
from oort.node.markers import graph_markers
from oort.node.messages import yaw

STAMP = genpy.Time(12, 34)
LINES = ("chain", "chain by odometry", "closures", "closures undone")


def graph(
    poses: list[tuple[float, float, float]],
    edges: list[tuple[int, int, int]],
    closures: list[tuple[int, int, float]],
) -> Map:
    """A stand-in for a map: edges are i, j and type, closures i, j and switch."""

    def columns(rows: list[Any], last: str, kind: type) -> dict[str, Any]:
        i, j, value = zip(*rows, strict=True) if rows else ((), (), ())
        return {"i": np.array(i, dtype=np.uint64), "j": np.array(j, dtype=np.uint64), last: np.array(value, dtype=kind)}

    return cast(
        Map,
        SimpleNamespace(
            node_poses=np.array(poses, dtype=np.float64).reshape(-1, 3),
            edges=columns(edges, "type", np.uint8),
            switchable_edges=columns(closures, "switch", np.float64),
        ),
    )


def by_kind(message: MarkerArray) -> dict[str, list[Any]]:
    """The markers after the first, which deletes, by namespace."""
    first, *rest = message.markers
    assert first.action == Marker.DELETEALL
    kinds: dict[str, list[Any]] = {}
    for marker in rest:
        assert marker.action == Marker.ADD
        kinds.setdefault(marker.ns, []).append(marker)
    return kinds


def segments(markers: list[Any]) -> list[tuple[float, float]]:
    """The x of both ends of each line."""
    (marker,) = markers
    xs = [point.x for point in marker.points]
    return list(zip(xs[::2], xs[1::2], strict=True))


def test_every_link_is_shown_in_its_kind() -> None:
    map_ = graph(
        [(float(k), 10.0 + k, 0.3) for k in range(5)],
        [(0, 1, 0), (1, 2, 1), (2, 3, 0), (3, 4, 1)],
        [(4, 0, 1.0), (3, 0, 0.5), (4, 1, 0.499), (2, 0, 0.0)],
    )
    kinds = by_kind(graph_markers(map_, [], "map", STAMP))
    assert segments(kinds["chain"]) == [(0, 1), (2, 3)]
    assert segments(kinds["chain by odometry"]) == [(1, 2), (3, 4)]
    assert segments(kinds["closures"]) == [(4, 0), (3, 0)]
    assert segments(kinds["closures undone"]) == [(4, 1), (2, 0)]
    (nodes,) = kinds["nodes"]
    assert [(point.x, point.y, point.z) for point in nodes.points] == [(k, 10.0 + k, 0.0) for k in range(5)]
    assert nodes.type == Marker.SPHERE_LIST
    green, red = kinds["closures"][0].color, kinds["closures undone"][0].color
    assert green.g > 2 * max(green.r, green.b)
    assert red.r > 2 * max(red.g, red.b)


def test_places_are_arrows_with_names() -> None:
    places = [("rooms", "kitchen", (1.0, 2.0, 0.5)), ("dock", "dock", (0.0, 0.0, -3.0))]
    kinds = by_kind(graph_markers(graph([(0, 0, 0)], [], []), places, "map", STAMP))
    assert [name.text for name in kinds["place names"]] == ["dock/dock", "rooms/kitchen"]
    arrow = kinds["places"][1]
    assert arrow.type == Marker.ARROW
    assert (arrow.pose.position.x, arrow.pose.position.y) == (1.0, 2.0)
    assert yaw(arrow.pose.orientation) == pytest.approx(0.5)
    assert kinds["place names"][1].type == Marker.TEXT_VIEW_FACING
    again = by_kind(graph_markers(graph([(0, 0, 0)], [], []), places[::-1], "map", STAMP))
    assert again == kinds  # the order in which places are told decides nothing


def test_a_place_in_no_namespace_shows_its_id_alone() -> None:
    kinds = by_kind(graph_markers(graph([(0, 0, 0)], [], []), [("", "sofa", (1.0, 2.0, 0.5))], "map", STAMP))
    assert [name.text for name in kinds["place names"]] == ["sofa"]


def test_a_name_is_not_in_its_arrows_way() -> None:
    places = [("", "a", (1.0, 2.0, 0.5)), ("", "b", (1.0, 2.0, -0.5))]
    kinds = by_kind(graph_markers(graph([(0, 0, 0)], [], []), places, "map", STAMP))
    assert kinds["place names"][0].pose.position.y < 2.0 < kinds["place names"][1].pose.position.y


def test_an_empty_map_deletes_what_was_shown() -> None:
    message = graph_markers(Map(), [], "map", STAMP)
    assert [marker.action for marker in message.markers] == [Marker.DELETEALL]
    assert message.markers[0].header.frame_id == "map"


def test_a_mapped_drive() -> None:
    mapper = Mapper(Parameters())
    for k in range(4):
        mapper.add_scan(LaserScan(np.linspace(1.0, 2.0, 150), -1.5, 0.02, 0.1, 5.0, 0.1 * k), (0.5 * k, 0.0, 0.0))
    map_ = mapper.map()
    kinds = by_kind(graph_markers(map_, [], "map", STAMP))
    assert len(kinds["nodes"][0].points) == len(map_) == 4
    drawn = sum(len(marker.points) // 2 for kind in LINES for marker in kinds.get(kind, []))
    assert drawn == len(map_.edges["i"]) + len(map_.switchable_edges["i"])
    assert len(map_.edges["i"]) == 3


@st.composite
def graphs(draw: st.DrawFn) -> Map:
    count = draw(st.integers(0, 6))
    if count == 0:
        return graph([], [], [])
    node, number = st.integers(0, count - 1), st.floats(-1e3, 1e3)
    return graph(
        draw(st.lists(st.tuples(number, number, number), min_size=count, max_size=count)),
        draw(st.lists(st.tuples(node, node, st.sampled_from([0, 1])), max_size=8)),
        draw(st.lists(st.tuples(node, node, st.floats(0, 1)), max_size=8)),
    )


text = st.text(st.characters(codec="utf-8"), max_size=8)
places = st.lists(st.tuples(text, text, st.tuples(*[st.floats(-100, 100)] * 3)), max_size=5)


@given(map_=graphs(), places=places)
def test_rviz_takes_every_marker(map_: Map, places: list[tuple[str, str, tuple[float, float, float]]]) -> None:
    """RViz warns of markers without points, size or rotation, and of two with one name."""
    message = graph_markers(map_, places, "map", STAMP)
    kinds = by_kind(message)
    keys = [(marker.ns, marker.id) for marker in message.markers]
    assert len(keys) == len(set(keys))
    heights: dict[str, float] = {}
    for kind, markers in kinds.items():
        heights[kind] = markers[0].pose.position.z
        for marker in markers:
            assert (marker.header.frame_id, marker.header.stamp) == ("map", STAMP)
            turn = marker.pose.orientation
            assert math.hypot(turn.x, turn.y, turn.z, turn.w) == pytest.approx(1.0)
            assert marker.color.a == 1.0
            assert (marker.scale.z if kind == "place names" else marker.scale.x) > 0.0
            assert bool(marker.points) == (kind in LINES or kind == "nodes")
            assert not marker.points or kind == "nodes" or len(marker.points) % 2 == 0
    assert len(set(heights.values())) == len(heights)  # at one height they would flicker
    buffer = io.BytesIO()
    message.serialize(buffer)
    assert MarkerArray().deserialize(buffer.getvalue()).markers[-1].points == message.markers[-1].points
