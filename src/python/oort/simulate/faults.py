# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What goes wrong with odometry now and then, each once in a drive, somewhere in its middle half."""

import numpy as np
import numpy.typing as npt

from oort.poses import Array, between, compose

FROZEN = 2.0  # s without news, then a jump to where the odometry would be
FROZEN_WAY = 0.5  # m driven meanwhile, at least
SLIP_WAY, SLIP_TURN = 0.2, np.radians(20.0)  # m and rad of a bump
MOVING = 0.15  # m/s at which a bump happens, at least

Steps = tuple[int, int]


def freeze(T_odom_base: Array, steps: Array, step: float, rng: np.random.Generator) -> tuple[Array, Steps]:  # noqa: N803
    """Odometry (n + 1, 3) that stands still for a while, and from which pose to which.

    ``steps`` (n, 2) are the true way [m] and turn [rad] of each step of ``step`` seconds.
    """
    length = round(FROZEN / step)
    way = np.concatenate([[0.0], np.cumsum(np.abs(steps[:, 0]))])
    begin = _choose(way[length:] - way[:-length] >= FROZEN_WAY, len(steps), rng)
    seen = T_odom_base.copy()
    seen[begin : begin + length] = T_odom_base[begin]
    return seen, (begin, begin + length)


def bump(T_odom_base: Array, steps: Array, step: float, rng: np.random.Generator) -> tuple[Array, Steps]:  # noqa: N803
    """Odometry (n + 1, 3) that jumps while the robot does not, and between which poses: see ``freeze``."""
    before = _choose(np.abs(steps[:, 0]) >= MOVING * step, len(steps), rng)
    direction, side = float(rng.uniform(-np.pi, np.pi)), float(rng.choice([-1.0, 1.0]))
    slip = np.array([SLIP_WAY * np.cos(direction), SLIP_WAY * np.sin(direction), side * SLIP_TURN])
    here, after = T_odom_base[before], T_odom_base[before + 1 :]
    seen = np.vstack([T_odom_base[: before + 1], compose(compose(here, slip), between(here, after))])
    return seen, (before, before + 1)


def _choose(possible: npt.NDArray[np.bool_], count: int, rng: np.random.Generator) -> int:
    """One of the possible steps in the middle half of ``count``. Raises ValueError if there is none."""
    middle = np.flatnonzero(possible[: 3 * count // 4])
    middle = middle[middle >= count // 4]
    if not len(middle):
        raise ValueError("the drive has no moment at which the odometry could fail so: choose another seed")
    return int(rng.choice(middle))
