# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a live session looks like between two events, and how its map is drawn."""

from collections.abc import Mapping, Set
from dataclasses import dataclass, field, replace

from oort._core import Map, OccupancyGrid
from oort.locations import Pose
from oort.poses import compose
from oort.session import Session, State


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Everything that readers ask for; it never changes, so that no reader waits for the mapping."""

    revision: int = 0
    """counts up with every change of the map; places may change without"""
    state: State = State.NOT_MAPPING
    path: str = ""
    num_nodes: int = 0
    odom_pose: Pose | None = None
    """T_map_odom while mapping; while paused, as it was last"""
    made_odometry: Pose | None = None
    """T_odom_base at the latest scan, where mapping makes it itself as no odometry is used"""
    places: Mapping[tuple[str, str], Pose] = field(default_factory=dict)
    """T_map_place by namespace and id"""
    waiting: Set[tuple[str, str]] = frozenset()
    """places that get their pose with the next scan"""
    closures: int = 0
    """loops and docks that were closed"""


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A map as it was at one moment."""

    revision: int
    """of its Snapshot"""
    grid: OccupancyGrid
    cleaned: OccupancyGrid
    """without speckle noise"""
    map: Map


def glance(session: Session, before: Snapshot, reported_frame: Pose | None = None) -> Snapshot:
    """The session now, where neither map nor places can differ from ``before``; ``reported_frame`` is the scan's."""
    odom_pose = before.odom_pose
    if session.state is State.NOT_MAPPING:
        odom_pose = None
    elif session.state is State.MAPPING and session.mapper.has_pose:
        odom_pose = odom_pose_of(session.mapper.odom_pose, reported_frame)
    made = session.made_odometry
    return replace(before, state=session.state, path=session.path, odom_pose=odom_pose, made_odometry=made)


def odom_pose_of(T_map_odom: Pose, reported_frame: Pose | None) -> Pose:  # noqa: N803
    """Where the frame that odometry is reported in is on the map, from that of the latest scan's odometry."""
    if reported_frame is None:
        return T_map_odom
    x, y, theta = compose(T_map_odom, reported_frame).tolist()
    return x, y, theta


def look_at(session: Session, before: Snapshot, reported_frame: Pose | None, map_changed: bool) -> Snapshot:
    """The session now; ``map_changed``: whether its map may differ from ``before``."""
    mapper = session.mapper
    locations = ((space, id, mapper.locate(space, id)) for space, id, *_ in mapper.locations)
    return replace(
        glance(session, before, reported_frame),
        revision=before.revision + map_changed,
        num_nodes=mapper.num_nodes,
        places={(space, id): pose for space, id, pose in locations if pose is not None},
        waiting=frozenset(session.locations.waiting),
        closures=sum(mapper.statistics[kind]["accepted"] for kind in ("loops", "docks")),
    )
