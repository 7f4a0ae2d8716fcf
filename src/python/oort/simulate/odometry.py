# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry that errs: by scale, by noise that grows with way and turn, by a drifting heading and by slipping wheels.

The sizes below are those of a good base (factor 1): per drive a scale error of up to 2 % of way and of turn, noise of
1 cm and 0.35 degrees per square root of a metre and 0.35 degrees per square root of a radian, a heading that drifts by
about half a degree a minute while the base moves, and every 25 m or so a slip.
"""

import numpy as np

from oort.poses import Array

WAY_SCALE, TURN_SCALE = 0.02, 0.02  # a drive's scale errors are drawn evenly up to these, either way
WAY_NOISE = 0.01  # m per sqrt(m)
TURN_NOISE_PER_WAY = 0.006  # rad per sqrt(m)
TURN_NOISE_PER_TURN = 0.006  # rad per sqrt(rad)
DRIFT = 1.5e-4  # rad/s while moving
SLIPS_PER_METRE = 0.04
SLIP_STEPS = 15  # a slip's duration in steps
SLIP_WAY = (0.01, 0.04)  # m that the wheels turn too much
SLIP_TURN = 0.02  # rad


def simulate_odometry(
    steps: Array, step: float, start: Array, error: float, rng: np.random.Generator, turn_error: float = 1.0
) -> Array:
    """Poses T_odom_base (n + 1, 3) of odometry from the true steps (n, 2) of way [m] and turn [rad].

    ``step`` is a step's duration [s], ``start`` the first pose, ``error`` a factor on all errors (0: none) and
    ``turn_error`` one more on those of turns.
    The heading is continuous, not wrapped, and a robot at rest is seen at rest.
    """
    way, turn = steps[:, 0], steps[:, 1]
    n = len(steps)
    way_scale, turn_scale = rng.uniform(-1.0, 1.0, 2) * [WAY_SCALE, TURN_SCALE]
    drift = DRIFT * float(rng.standard_normal())
    moving = (way != 0.0) | (turn != 0.0)
    way_error = way_scale * way + WAY_NOISE * np.sqrt(np.abs(way)) * rng.standard_normal(n)
    turn_wrong = turn_scale * turn + moving * drift * step
    turn_wrong += TURN_NOISE_PER_WAY * np.sqrt(np.abs(way)) * rng.standard_normal(n)
    turn_wrong += TURN_NOISE_PER_TURN * np.sqrt(np.abs(turn)) * rng.standard_normal(n)
    slips = rng.random(n) < SLIPS_PER_METRE * np.abs(way)
    spread = np.ones(SLIP_STEPS) / SLIP_STEPS
    way_slip = np.convolve(slips * np.sign(way) * rng.uniform(*SLIP_WAY, n), spread)[:n]
    turn_slip = np.convolve(slips * rng.normal(0.0, SLIP_TURN, n), spread)[:n]
    way_seen = way + error * (way_error + moving * way_slip)
    turn_seen = turn + error * turn_error * (turn_wrong + moving * turn_slip)
    heading = start[2] + np.concatenate([[0.0], np.cumsum(turn_seen)])
    middle = heading[:-1] + 0.5 * turn_seen
    x = start[0] + np.concatenate([[0.0], np.cumsum(way_seen * np.cos(middle))])
    y = start[1] + np.concatenate([[0.0], np.cumsum(way_seen * np.sin(middle))])
    return np.column_stack([x, y, heading])
