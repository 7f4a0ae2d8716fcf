# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A differential drive that follows paths, turns on the spot and backs onto its dock, at 50 steps a second.

The driver sees the true pose: this is a person with a remote control, or a robot that knows its way.
"""

import math
from dataclasses import dataclass

import numpy as np

from oort.poses import Array
from oort.simulate.free_space import ClearanceGrid

STEP = 0.02  # s
ACCELERATION, BRAKING, TURN_ACCELERATION = 0.8, 1.0, 4.0  # m/s^2, m/s^2, rad/s^2
TURN_SPEED = 1.2  # rad/s on the spot
CURVE_SPEED = 1.0  # rad/s in curves
BACKING_SPEED = 0.12  # m/s
LOOKAHEAD = 0.35  # m, of pure pursuit
STOP_AND_TURN = 1.0  # rad of heading error from which the robot turns on the spot
TURNED = 0.25  # rad of heading error at which it drives on
LONGEST = 3600.0  # s; a drive that takes longer has lost its way


@dataclass(frozen=True, eq=False)
class Motion:
    """The true motion: ``poses`` (n, 3) at each step; ``steps`` (n - 1, 2) way [m] and turn [rad] between them."""

    poses: Array
    steps: Array


class Driver:
    """Drives the base step by step and keeps its motion. Speeds never jump: accelerations are limited."""

    def __init__(self, pose: Array, grid: ClearanceGrid) -> None:
        """Start at rest at ``pose`` (x, y, heading), in the frame of ``grid``."""
        self._x, self._y, self._heading = (float(value) for value in pose)
        self._speed = self._turn = 0.0
        self._grid = grid
        self._poses = [(self._x, self._y, self._heading)]
        self._steps: list[tuple[float, float]] = []

    @property
    def pose(self) -> tuple[float, float, float]:
        """Where the base is: x [m], y [m], heading [rad]."""
        return self._x, self._y, self._heading

    @property
    def steps(self) -> int:
        """How many steps there were so far."""
        return len(self._steps)

    @property
    def elapsed(self) -> float:
        """Time since the start, s."""
        return len(self._steps) * STEP

    def motion(self) -> Motion:
        """All of the motion so far."""
        return Motion(np.array(self._poses), np.array(self._steps))

    def wait(self, seconds: float) -> None:
        """Come to rest, then stand."""
        while self._speed != 0.0 or self._turn != 0.0:
            self._step(0.0, 0.0)
        for _ in range(round(seconds / STEP)):
            self._step(0.0, 0.0)

    def turn_by(self, angle: float) -> None:
        """Turn on the spot by ``angle`` [rad], to the left when positive; whole turns count."""
        goal = self._heading + angle
        while abs(goal - self._heading) > 0.004 or abs(self._turn) > 0.1:
            left = goal - self._heading
            self._step(0.0, math.copysign(min(TURN_SPEED, math.sqrt(4.0 * abs(left)), 8.0 * abs(left)), left))
        self.wait(0.0)

    def turn_to(self, heading: float) -> None:
        """Turn on the spot, the shorter way, to ``heading``."""
        self.turn_by(_wrap(heading - self._heading))

    def follow(self, path: Array, cruise: float) -> None:
        """Follow points (n, 2) by pure pursuit at up to ``cruise`` m/s and stop at the last."""
        points = [(float(x), float(y)) for x, y in path]
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))]).tolist()
        nearest, turning = 0, False
        while True:
            nearest = self._progress(points, way, nearest)
            ahead = nearest
            while ahead < len(points) - 1 and way[ahead] - way[nearest] < LOOKAHEAD:
                ahead += 1
            dx, dy = points[ahead][0] - self._x, points[ahead][1] - self._y
            left = way[-1] - way[nearest]
            if left < LOOKAHEAD:
                left = dx * math.cos(self._heading) + dy * math.sin(self._heading)
                if left < 0.01 and not turning:
                    break
            distance = math.hypot(dx, dy)
            error = _wrap(math.atan2(dy, dx) - self._heading) if distance > 0.1 else 0.0
            turning = abs(error) > (TURNED if turning else STOP_AND_TURN)
            if turning:
                self._step(0.0, math.copysign(min(TURN_SPEED, 2.5 * abs(error)), error))
                continue
            curvature = 2.0 * math.sin(error) / max(distance, 0.5 * LOOKAHEAD)
            speed = min(cruise, self._safe_speed(), math.sqrt(1.2 * max(left, 0.0)) + 0.02)
            speed = min(speed, CURVE_SPEED / max(abs(curvature), 1e-9))
            self._step(speed, speed * curvature)
        self.wait(0.0)

    def back_onto(self, dock: Array) -> None:
        """Drive backwards to the pose ``dock`` along its axis, before which the robot stands, and stop there."""
        dock_x, dock_y, dock_heading = (float(value) for value in dock)
        cosine, sine = math.cos(dock_heading), math.sin(dock_heading)
        while True:
            dx, dy = self._x - dock_x, self._y - dock_y
            left, aside = cosine * dx + sine * dy, cosine * dy - sine * dx
            if left <= 0.5 * self._speed**2 / BRAKING + 0.001:
                break
            # Linearised, the offset decays over the way driven like exp(-s / 8 cm) and exp(-s / 12 cm).
            turn = -2.5 * _wrap(self._heading - dock_heading) + 12.5 * aside
            self._step(-min(BACKING_SPEED, 0.02 + math.sqrt(0.6 * left)), max(-0.5, min(0.5, turn)))
        self.wait(0.0)

    def be_carried(self, goal: tuple[float, float, float], seconds: float) -> None:
        """Be brought to the pose ``goal`` by somebody, evenly, with the wheels at rest: the steps are zero."""
        start, count = np.array(self.pose), round(seconds / STEP)
        for share in np.arange(1, count + 1) / count:
            self._x, self._y, self._heading = (start + share * (np.array(goal) - start)).tolist()
            self._poses.append(self.pose)
            self._steps.append((0.0, 0.0))

    def _progress(self, points: list[tuple[float, float]], way: list[float], nearest: int) -> int:
        """The last of the nearest points within a lookahead's way: where a path turns back, beyond the turn."""
        best, best_distance = nearest, math.inf
        index = nearest
        while index < len(points) and way[index] - way[nearest] <= LOOKAHEAD:
            distance = math.hypot(points[index][0] - self._x, points[index][1] - self._y)
            if distance < best_distance + 0.02:
                best, best_distance = index, min(distance, best_distance)
            index += 1
        return best

    def _safe_speed(self) -> float:
        """Slower where it is narrow."""
        return max(0.1, 0.1 + 1.0 * (self._grid.at(self._x, self._y) - 0.2))

    def _step(self, speed: float, turn: float) -> None:
        """One step towards the wanted speed [m/s] and turn rate [rad/s], within the accelerations."""
        braking = abs(speed) < abs(self._speed)
        limit = (BRAKING if braking else ACCELERATION) * STEP
        self._speed += max(-limit, min(limit, speed - self._speed))
        limit = TURN_ACCELERATION * STEP
        self._turn += max(-limit, min(limit, turn - self._turn))
        way, angle = self._speed * STEP, self._turn * STEP
        middle = self._heading + 0.5 * angle
        self._x += way * math.cos(middle)
        self._y += way * math.sin(middle)
        self._heading += angle
        self._poses.append((self._x, self._y, self._heading))
        self._steps.append((way, angle))
        if self.elapsed > LONGEST:
            raise RuntimeError(f"the driver lost its way near x={self._x:.2f}, y={self._y:.2f}")


def _wrap(angle: float) -> float:
    return (angle + math.pi) % (2.0 * math.pi) - math.pi
