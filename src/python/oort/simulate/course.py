# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a simulated drive leads through and how it moves there: a tour of a home, or along a bare corridor."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from oort.poses import Array
from oort.simulate.driver import Driver, Motion
from oort.simulate.floor_plan import FloorPlan, Rect
from oort.simulate.free_space import ClearanceGrid
from oort.simulate.home import DOCK_FRONT, Home, Room
from oort.simulate.planar import transform
from oort.simulate.tour import Places, find_places, plan_tour

DOCKED = 2.0  # s on the dock, before and after
CRUISE = (0.28, 0.45)  # m/s
MEAN_SPEED = 0.4  # m/s of routes' cost, turns and halts included, to guess a tour's length from its duration
CARRIED, CARRIED_TURN = 1.0, 0.3  # m and rad at most that somebody carries the robot
CARRYING_TIME = 2.0  # s
CARRYING_CLEARANCE = 0.25  # m along the way of the carried robot

CORRIDOR_WIDTH, CORRIDOR_WAY = 1.5, 30.0  # m
BEHIND, BEFORE = 3.5, 1.0  # m from the ends of the way to the walls at the corridor's ends
WEAVE = 0.06  # m of each of the two waves by which the way leaves the corridor's middle


@dataclass(frozen=True, eq=False)
class Course:
    """A scene in its plan's frame and the motion through it."""

    home: Home
    motion: Motion
    places: Places | None
    """among which people walk; None where nobody does"""
    carried: tuple[int, int] | None = None
    """steps of the motion between which the robot was carried, its wheels at rest"""


def tour_home(
    home: Home,
    plan: FloorPlan,
    grid: ClearanceGrid,
    minutes: float,
    rng: np.random.Generator,
    carrying: np.random.Generator | None = None,
    roam: bool = False,
) -> Course:
    """From the dock along a tour, with halts and looks around here and there, and backwards onto the dock.

    With ``carrying`` somebody carries the robot to a place nearby once, about halfway. With ``roam`` the places are
    other ones for each ``rng``, and their order is random, not short.
    """
    places = find_places(plan, grid, transform(home.dock, [DOCK_FRONT, 0.0]), rng if roam else None)
    driver = Driver(home.dock, places.grid)
    driver.wait(DOCKED)
    driver.follow(_straight(home.dock), float(rng.uniform(*CRUISE)))
    tour = plan_tour(places, 60.0 * minutes * MEAN_SPEED, rng, roam)
    stretch: list[Array] = []
    carried = None
    for number, (start, goal) in enumerate(pairwise(tour), start=1):
        stretch.append(places.path(start, goal))
        halt = float(rng.random())
        last = goal == tour[-1]
        carry = carrying is not None and carried is None and 2 * number >= len(tour) and not last
        if last or halt < 0.3 or carry:
            driver.follow(_joined(stretch), float(rng.uniform(*CRUISE)))
            stretch = []
        if not last and halt < 0.15:
            driver.turn_by(float(rng.choice([-1.0, 1.0])) * 2.0 * np.pi)
        elif not last and halt < 0.3:
            driver.wait(float(rng.uniform(0.5, 2.0)))
        if carry and carrying is not None:
            carried = _carry(driver, grid, carrying)
            stretch = [_line(driver.pose[:2], grid.point(places.cells[goal]))]
    driver.turn_to(float(home.dock[2]))
    driver.back_onto(home.dock)
    driver.wait(DOCKED)
    return Course(home, driver.motion(), places, carried)


def drive_corridor(there_and_back: bool, rng: np.random.Generator) -> Course:
    """Along a straight corridor with bare walls, weaving a little; the end is seen when it is nearly reached.

    On the way back, too, nothing is to be seen but the two walls. The home's dock is where the drive begins.
    """
    corridor = Rect(0.0, 0.0, BEHIND + CORRIDOR_WAY + BEFORE, CORRIDOR_WIDTH)
    corners = corridor.polygon()
    walls = np.hstack([corners, np.roll(corners, -1, axis=0)])
    grid = ClearanceGrid(corridor.grown(0.3, 0.3))
    grid.open_rect(corridor)
    grid.block_segments(walls)
    x = np.arange(BEHIND, BEHIND + CORRIDOR_WAY + 0.05, 0.1)
    fade = np.minimum(1.0, np.minimum(x - x[0], x[-1] - x))  # straight at both ends
    waves = [np.sin(2.0 * np.pi * (x / rng.uniform(4.0, 9.0) + rng.random())) for _ in range(2)]
    way = np.column_stack([x, corridor.centre[1] + WEAVE * fade * (waves[0] + waves[1])])
    start = np.array([*way[0], 0.0])
    driver = Driver(start, grid)
    driver.wait(DOCKED)
    driver.follow(way, float(rng.uniform(*CRUISE)))
    if there_and_back:
        driver.turn_by(np.pi)
        driver.follow(way[::-1], float(rng.uniform(*CRUISE)))
        driver.turn_to(0.0)
    driver.wait(DOCKED)
    scene = Home((Room("corridor", corners),), (), (), walls, np.empty((0, 3)), start)
    return Course(scene, driver.motion(), None)


def _carry(driver: Driver, grid: ClearanceGrid, rng: np.random.Generator) -> tuple[int, int] | None:
    """Carry the robot over free floor, if there is any to carry it to. Returns the steps before and after."""
    x, y, heading = driver.pose
    for angle in rng.uniform(-np.pi, np.pi) + np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
        goal = (x + CARRIED * float(np.cos(angle)), y + CARRIED * float(np.sin(angle)))
        if min(grid.at(px, py) for px, py in _line((x, y), goal)) >= CARRYING_CLEARANCE:
            driver.wait(1.0)
            before = driver.steps
            driver.be_carried((*goal, heading + float(rng.uniform(-CARRIED_TURN, CARRIED_TURN))), CARRYING_TIME)
            after = driver.steps
            driver.wait(1.0)
            return before, after
    return None


def _straight(dock: Array) -> Array:
    """Points from the dock to the place before it."""
    way = np.linspace(0.0, DOCK_FRONT, 9)
    return transform(dock, np.column_stack([way, np.zeros_like(way)]))


def _line(start: tuple[float, float], goal: tuple[float, float]) -> Array:
    """Points (n, 2) from one place straight to another, about 10 cm apart."""
    count = 2 + int(np.hypot(goal[0] - start[0], goal[1] - start[1]) / 0.1)
    return np.linspace(start, goal, count)


def _joined(paths: Sequence[Array]) -> Array:
    """Paths that begin where the one before ends, as one without doubled points."""
    return np.vstack([paths[0], *(path[1:] for path in paths[1:])])
