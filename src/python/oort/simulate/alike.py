# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Homes made to be mistaken: rooms that are all alike, furniture included, off both sides of a straight corridor.

Doors repeat at one distance along the corridor. What lies on one side is the other side turned by 180 degrees, so that
a robot that drives the corridor in either direction sees the same again and again. Only the dock stands out, at one of
the corridor's ends.
"""

import numpy as np

from oort.poses import Array, compose
from oort.simulate.floor_plan import CORNER_TO_DOOR, WALL_THICKNESS, Doorway, FloorPlan, Rect, RoomPlan
from oort.simulate.free_space import ClearanceGrid
from oort.simulate.home import Furnisher, Home

ROOMS_PER_SIDE = (3, 4)
ROOM_WIDTH, ROOM_DEPTH = (2.6, 3.6), (2.6, 3.6)  # m along and across the corridor
CORRIDOR_WIDTH = (1.25, 1.5)
CORRIDOR_ENDS = 1.5  # m of corridor beyond the rooms, at both ends
DOOR_WIDTH = (0.82, 0.92)
KINDS = ("bedroom", "bathroom", "study")


def make_alike_home(rng: np.random.Generator) -> tuple[Home, FloorPlan, ClearanceGrid]:
    """Draw a home of identical rooms in its plan's frame, with its plan and its free space."""
    while True:
        plan, turns = _make_plan(rng)
        furnisher = Furnisher(plan, rng)
        end = plan.rooms[0].rect
        dock = np.array([end.x0 + 0.01, end.centre[1], -0.5 * np.pi])
        if not furnisher.dock_at(0, dock):
            continue
        first = len(furnisher.pieces)
        furnisher.furnish_room(1)
        model = furnisher.pieces[first:]
        for turn in turns[1:]:
            for piece in model:
                furnisher.put(piece.moved(turn))
        return furnisher.home(), plan, furnisher.grid


def _make_plan(rng: np.random.Generator) -> tuple[FloorPlan, list[Array]]:
    """A plan with the corridor first, and for each other room the motion that takes the first room to it.

    The corridor's axis is y = 0, and x = 0 its middle, so that a turn by 180 degrees about the origin takes the rooms
    of one side to those of the other.
    """
    count = int(rng.integers(ROOMS_PER_SIDE[0], ROOMS_PER_SIDE[1] + 1))
    width, depth = float(rng.uniform(*ROOM_WIDTH)), float(rng.uniform(*ROOM_DEPTH))
    half, door = 0.5 * float(rng.uniform(*CORRIDOR_WIDTH)), float(rng.uniform(*DOOR_WIDTH))
    door_at = float(rng.uniform(CORNER_TO_DOOR, width - CORNER_TO_DOOR - door))
    kind = str(rng.choice(KINDS))
    pitch = width + WALL_THICKNESS
    left, low = -0.5 * count * pitch + 0.5 * WALL_THICKNESS, half + WALL_THICKNESS
    corridor = Rect(left - CORRIDOR_ENDS, -half, -left + CORRIDOR_ENDS, half)
    room = Rect(left, low, left + width, low + depth)
    gap = Rect(left + door_at, half, left + door_at + door, low)
    places = [(i * pitch, turned) for turned in (False, True) for i in range(count)]
    rooms = [RoomPlan("corridor", corridor), *(RoomPlan(kind, _moved(room, *place)) for place in places)]
    doorways = [Doorway((0, i), _moved(gap, *place), False) for i, place in enumerate(places, start=1)]
    turns = [compose([0.0, 0.0, np.pi if turned else 0.0], [along, 0.0, 0.0]) for along, turned in places]
    return FloorPlan(tuple(rooms), tuple(doorways)), turns


def _moved(rect: Rect, along: float, turned: bool) -> Rect:
    """A rectangle shifted along x and then, maybe, turned by exactly 180 degrees about the origin."""
    x0, x1 = rect.x0 + along, rect.x1 + along
    return Rect(-x1, -rect.y1, -x0, -rect.y0) if turned else Rect(x0, rect.y0, x1, rect.y1)
