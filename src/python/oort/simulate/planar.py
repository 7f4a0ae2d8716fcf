# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Points in the plane, beside the poses of `oort.poses`."""

import numpy as np
from numpy.typing import ArrayLike

from oort.poses import Array


def transform(T_a_b: ArrayLike, points: ArrayLike) -> Array:  # noqa: N803
    """Points (..., 2) of frame b in frame a; the pose (3,) is x [m], y [m], theta [rad]."""
    x, y, theta = np.asarray(T_a_b, dtype=np.float64).tolist()
    p = np.asarray(points, dtype=np.float64)
    cosine, sine = np.cos(theta), np.sin(theta)
    return np.stack([x + cosine * p[..., 0] - sine * p[..., 1], y + sine * p[..., 0] + cosine * p[..., 1]], axis=-1)
