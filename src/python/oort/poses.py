# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Planar poses as numpy arrays: (..., 3) of x [m], y [m], theta [rad]; `T_a_b` takes points of frame b to frame a."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort.errors import InputError

Array = NDArray[np.float64]


def as_pose(values: ArrayLike, what: str) -> tuple[float, float, float]:
    """Three numbers x [m], y [m], theta [rad] from anything that holds them. InputError names ``what`` has none."""
    try:
        pose = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        pose = np.empty(0)
    if pose.shape != (3,):
        raise InputError(f"{what} must be three numbers x, y [m], theta [rad], not {values!r}")
    x, y, theta = pose.tolist()
    return x, y, theta


def wrap_angle(angle: ArrayLike) -> Array:
    """Angles [rad] brought to [-pi, pi)."""
    wrapped = (np.asarray(angle, dtype=np.float64) + np.pi) % (2.0 * np.pi) - np.pi
    return np.where(wrapped >= np.pi, -np.pi, wrapped)  # the sum rounds up for a tiny negative multiple of pi


def compose(T_a_b: ArrayLike, T_b_c: ArrayLike) -> Array:  # noqa: N803
    """T_a_c = T_a_b * T_b_c. Shapes (..., 3), broadcast."""
    a, b = np.broadcast_arrays(np.asarray(T_a_b, dtype=np.float64), np.asarray(T_b_c, dtype=np.float64))
    c, s = np.cos(a[..., 2]), np.sin(a[..., 2])
    x = a[..., 0] + c * b[..., 0] - s * b[..., 1]
    y = a[..., 1] + s * b[..., 0] + c * b[..., 1]
    return np.stack([x, y, wrap_angle(a[..., 2] + b[..., 2])], axis=-1)


def between(T_a_b: ArrayLike, T_a_c: ArrayLike) -> Array:  # noqa: N803
    """T_b_c = inverse(T_a_b) * T_a_c. Shapes (..., 3), broadcast."""
    b, c = np.broadcast_arrays(np.asarray(T_a_b, dtype=np.float64), np.asarray(T_a_c, dtype=np.float64))
    cos, sin = np.cos(b[..., 2]), np.sin(b[..., 2])
    dx, dy = c[..., 0] - b[..., 0], c[..., 1] - b[..., 1]
    return np.stack([cos * dx + sin * dy, -sin * dx + cos * dy, wrap_angle(c[..., 2] - b[..., 2])], axis=-1)
