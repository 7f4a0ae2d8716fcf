# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Planar poses."""

import math

import numpy as np
import pytest

from oort.poses import between, compose, wrap_angle


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [(0.0, 0.0), (math.pi, -math.pi), (-math.pi, -math.pi), (3.5 * math.pi, -0.5 * math.pi), (-7.0, -7.0 + math.tau)],
)
def test_wrap_angle(angle: float, wrapped: float) -> None:
    assert float(wrap_angle(angle)) == pytest.approx(wrapped)


def test_wrap_angle_is_half_open() -> None:
    angles = np.concatenate([np.nextafter([math.pi, -math.pi], -9.0), [-1e-300, 1e-300]])
    assert np.all(wrap_angle(angles) >= -math.pi)
    assert np.all(wrap_angle(angles) < math.pi)


def test_compose_by_hand() -> None:
    np.testing.assert_allclose(compose((1, 2, math.pi / 2), (3, 1, 0.25)), (0, 5, math.pi / 2 + 0.25), atol=1e-12)


def test_between_undoes_compose_for_whole_arrays() -> None:
    generator = np.random.Generator(np.random.PCG64(1))
    a, b = generator.uniform(-3, 3, (2, 50, 3))
    np.testing.assert_allclose(between(a, compose(a, b)), b, atol=1e-12)
    np.testing.assert_allclose(between(a[0], compose(a[0], b)), b, atol=1e-12)  # one against many
