# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a live session looks like between two events."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from oort.locations import Pose
from oort.session import Session, State


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Everything that readers ask for; it never changes, so that no reader waits for the mapping."""

    revision: int = 0
    """counts up with every change of the map"""
    state: State = State.NOT_MAPPING
    path: str = ""
    num_nodes: int = 0
    odom_pose: Pose | None = None
    """T_map_odom while mapping; while paused, as it was last"""
    places: Mapping[tuple[str, str], Pose] = field(default_factory=dict)
    """T_map_place by namespace and id"""
    closures: int = 0
    """loops and docks that were closed"""


def look_at(session: Session, before: Snapshot, changed: bool) -> Snapshot:
    """The session now; ``changed``: whether the map may differ from ``before``."""
    mapper = session.mapper
    odom_pose = before.odom_pose
    if session.state is State.NOT_MAPPING:
        odom_pose = None
    elif session.state is State.MAPPING and mapper.has_pose:
        odom_pose = mapper.odom_pose
    if not changed:
        return replace(before, state=session.state, path=session.path, odom_pose=odom_pose)
    locations = ((space, id, mapper.locate(space, id)) for space, id, *_ in mapper.locations)
    return Snapshot(
        revision=before.revision + 1,
        state=session.state,
        path=session.path,
        num_nodes=mapper.num_nodes,
        odom_pose=odom_pose,
        places={(space, id): pose for space, id, pose in locations if pose is not None},
        closures=sum(mapper.statistics[kind]["accepted"] for kind in ("loops", "docks")),
    )
