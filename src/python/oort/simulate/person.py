# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A person who walks through the robot's view now and then, seen at shin height as two legs."""

from collections.abc import Callable

import numpy as np

from oort.poses import Array

LEG_RADIUS = 0.06  # m
HALF_HIPS = 0.1  # m between the line of walking and a leg
STRIDE = 1.3  # m, two paces
SWING = 0.22  # m that a foot gets ahead of the body
PACE = (0.7, 1.2)  # m/s
FIRST, PAUSE = 12.0, (15.0, 35.0)  # s before the first walk and between walks
AWAY = 3.3  # m from the robot where a walk begins and ends
CLOSEST, CLOSE = 0.5, 2.2  # m; a walk keeps the first distance from the robot and comes within the second
TRIES = 30


def simulate_person(
    robot: Array,
    period: float,
    path: Callable[[int, int], Array],
    number_of_places: int,
    rng: np.random.Generator,
) -> Array:
    """Centres (n, 2, 2) of the two legs at each pose of ``robot`` (n, 3), every ``period`` s; NaN while out of sight.

    A walk leads along ``path(start, goal)`` from one of the home's places to another and crosses before the robot.
    """
    legs = np.full((len(robot), 2, 2), np.nan)
    now = round(FIRST / period)
    while now < len(robot):
        for _ in range(TRIES):
            start, goal = rng.choice(number_of_places, 2, replace=False).tolist()
            walk = walk_along(path(start, goal), float(rng.uniform(*PACE)) * period)
            if now + len(walk) <= len(robot) and _crosses(walk.mean(axis=1), robot[now : now + len(walk)]):
                legs[now : now + len(walk)] = walk
                now += len(walk)
                break
        now += round(float(rng.uniform(*PAUSE)) / period)
    return legs


def walk_along(path: Array, pace: float) -> Array:
    """Legs (m, 2, 2) at each moment of a walk along ``path`` that gets ahead by ``pace`` metres a moment."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    walked = np.arange(0.0, way[-1], pace)
    at = np.column_stack([np.interp(walked, way, path[:, 0]), np.interp(walked, way, path[:, 1])])
    ahead = np.column_stack([np.interp(walked + 0.3, way, path[:, 0]), np.interp(walked + 0.3, way, path[:, 1])])
    behind = np.column_stack([np.interp(walked - 0.3, way, path[:, 0]), np.interp(walked - 0.3, way, path[:, 1])])
    along = (ahead - behind) / np.maximum(np.hypot(*(ahead - behind).T), 1e-9)[:, None]
    aside = np.column_stack([-along[:, 1], along[:, 0]]) * HALF_HIPS
    swing = along * (SWING * np.sin(2.0 * np.pi * walked / STRIDE))[:, None]
    return np.stack([at + aside + swing, at - aside - swing], axis=1)


def _crosses(body: Array, robot: Array) -> bool:
    """Whether a walk comes from afar, passes before the robot without touching it, and goes away."""
    dx, dy = body[:, 0] - robot[:, 0], body[:, 1] - robot[:, 1]
    distance = np.hypot(dx, dy)
    before = dx * np.cos(robot[:, 2]) + dy * np.sin(robot[:, 2]) > 0.0
    far = min(distance[0], distance[-1]) >= AWAY
    return bool(far and distance.min() >= CLOSEST and np.any(before & (distance <= CLOSE)))
