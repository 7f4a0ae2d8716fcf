# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A cheap gyro: noise, a bias that wanders, and a scale that is a little off."""

import numpy as np

from oort.poses import Array

NOISE = 0.005  # rad/s, of each reading
BIAS = 0.01  # rad/s, standard deviation over gyros
BIAS_WALK = 5e-5  # rad/s per sqrt(s)
SCALE = 0.003  # standard deviation over gyros


def simulate_gyro(turns: Array, step: float, rng: np.random.Generator) -> Array:
    """Yaw rates (n + 1,) [rad/s] at the ends of steps of ``step`` s, by true ``turns`` (n,) [rad]."""
    true = np.concatenate([[0.0], turns]) / step
    n = len(true)
    bias = BIAS * float(rng.standard_normal()) + BIAS_WALK * np.sqrt(step) * np.cumsum(rng.standard_normal(n))
    scale = 1.0 + SCALE * float(rng.standard_normal())
    return np.asarray(scale * true + bias + NOISE * rng.standard_normal(n))
