# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Landmarks that are seen on the way, and Huber's loss instead of switches."""

from itertools import islice

import numpy as np
import pytest
from numpy.typing import NDArray

from oort import Map, Parameters, Session, _core
from oort.errors import InputError
from oort.recording import open_recording
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen

TAG = (1.0, 2.0, 0.5)
"""Where it is in the map [m, rad]."""


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Map:
    """The beginning of a drive through a made-up home."""
    path = tmp_path_factory.mktemp("drive") / "home.clf"
    write_carmen(simulate_drive(2, SimulationConfig(minutes=0.0)), path)
    session = Session(Parameters(), (0.109, 0.0, 0.0))
    session.start()
    for scan in islice(open_recording(path).scans(), 300):
        session.add_scan(scan)
    return session.map


def seen_from(pose: NDArray[np.float64]) -> list[float]:
    """The tag in the frame of a sensor at a pose."""
    dx, dy = TAG[0] - pose[0], TAG[1] - pose[1]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return [c * dx + s * dy, c * dy - s * dx, TAG[2] - pose[2]]


def test_a_landmark_is_found_from_where_it_was_seen(driven: Map) -> None:
    nodes = len(driven.node_poses)
    places = [1, nodes // 2, nodes - 2]
    found, summary = _core.optimize_map_with_landmarks(
        driven,
        driven.cloud_times[places],
        [7] * len(places),
        [seen_from(driven.node_poses[k]) for k in places],
        np.tile(np.diag([1e-4, 1e-4, 1e-4]), (len(places), 1, 1)),
    )
    assert summary.converged
    assert list(found) == [7]
    np.testing.assert_allclose(found[7], TAG, atol=0.02)


def test_an_observation_outside_the_drive_is_refused(driven: Map) -> None:
    before = driven.node_poses
    with pytest.raises(InputError, match="no two nodes"):
        _core.optimize_map_with_landmarks(driven, [1e9], [7], [[0.0, 0.0, 0.0]], [np.eye(3)])
    with pytest.raises(InputError, match="measurements must have the shape"):
        _core.optimize_map_with_landmarks(driven, [1.0], [7], [[0.0, 0.0]], [np.eye(3)])
    np.testing.assert_array_equal(driven.node_poses, before)


def test_huber_keeps_a_false_link_pulling_where_a_switch_lets_go() -> None:
    poses = np.column_stack([np.arange(5.0), np.zeros(5), np.zeros(5)])
    i, j = np.array([0, 1, 2, 3, 0]), np.array([1, 2, 3, 4, 4])
    measurements = np.array([[1.0, 0.0, 0.0]] * 4 + [[4.0, 2.0, 0.0]])
    covariances = np.tile(np.diag([1e-3, 1e-3, 1e-3]), (5, 1, 1))
    bent = {}
    for kernel in (_core.RobustKernel.SWITCHABLE, _core.RobustKernel.HUBER):
        options = _core.OptimizerOptions(robust_kernel=kernel, huber_scale=3.0)
        solved, switches, _ = _core.optimize_graph(poses, i, j, measurements, covariances, i == j - 4, options)
        bent[kernel.name] = abs(solved[4, 1])
        assert switches[4] < 0.5
    assert bent["SWITCHABLE"] < 0.01 < 0.05 < bent["HUBER"]
