# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Pose graphs in the g2o format."""

import math
from pathlib import Path

import numpy as np
import pytest

from oort.errors import InputError
from oort.export import PoseGraph, read_g2o, write_g2o


def graph(covariance: np.ndarray | None = None) -> PoseGraph:
    if covariance is None:
        covariance = np.array([[0.04, 0.01, 0.002], [0.01, 0.09, -0.003], [0.002, -0.003, 0.01]])
    return PoseGraph(
        ids=np.array([3, 5, 9]),
        poses=np.array([[0.0, 0.0, 0.0], [1 / 3, 0.5, 1.0], [-2.0, 1e-9, -3.0]]),
        edges=np.array([[3, 5], [5, 9]]),
        measurements=np.array([[0.3, 0.5, 1.1], [-2.0, 0.0, 2.0]]),
        covariances=np.stack([covariance, 2.0 * covariance]),
    )


def test_round_trip(tmp_path: Path) -> None:
    path = tmp_path / "a.g2o"
    written = graph()
    write_g2o(path, written)
    read = read_g2o(path)
    for name in ("ids", "poses", "edges", "measurements"):
        np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
    np.testing.assert_allclose(read.covariances, written.covariances, rtol=1e-12)
    assert [line.split()[:2] for line in path.read_text().splitlines()[:4]] == [
        ["VERTEX_SE2", "3"],
        ["VERTEX_SE2", "5"],
        ["VERTEX_SE2", "9"],
        ["FIX", "3"],
    ]


def test_information_lies_along_the_axes_of_the_second_node(tmp_path: Path) -> None:
    path = tmp_path / "a.g2o"
    quarter = PoseGraph(
        ids=np.array([0, 1]),
        poses=np.zeros((2, 3)),
        edges=np.array([[0, 1]]),
        measurements=np.array([[1.0, 0.0, math.pi / 2]]),
        covariances=np.diag([0.25, 0.01, 0.04])[None],  # loose along node 0's x, which is node 1's -y
    )
    write_g2o(path, quarter)
    information = [float(field) for field in path.read_text().splitlines()[-1].split()[6:]]
    np.testing.assert_allclose(information, [100.0, 0.0, 0.0, 4.0, 0.0, 25.0], atol=1e-9)


def test_both_conventions_give_the_same_cost(tmp_path: Path) -> None:
    """Oort's e^T S^-1 e with the error along node i equals g2o's with the error along node j."""
    path = tmp_path / "a.g2o"
    written = graph()
    write_g2o(path, written)
    line = next(line for line in path.read_text().splitlines() if line.startswith("EDGE_SE2 3 5"))
    information = np.zeros((3, 3))
    information[np.triu_indices(3)] = [float(field) for field in line.split()[6:]]
    information += np.triu(information, 1).T
    error_i = np.append(written.poses[1, :2], 1.0) - written.measurements[0]  # node 3 is at the origin
    c, s = math.cos(1.1), math.sin(1.1)
    error_j = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ error_i
    expected = error_i @ np.linalg.inv(written.covariances[0]) @ error_i
    assert error_j @ information @ error_j == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "covariance",
    [np.zeros((3, 3)), np.diag([1.0, -1.0, 1.0]), np.full((3, 3), np.nan)],
    ids=["zero", "negative", "nan"],
)
def test_unusable_covariances_are_refused(tmp_path: Path, covariance: np.ndarray) -> None:
    with pytest.raises(InputError, match="edge 3 -> 5: covariance must be finite and positive definite"):
        write_g2o(tmp_path / "a.g2o", graph(covariance))


def test_graphs_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    good = graph()
    path = tmp_path / "a.g2o"
    with pytest.raises(InputError, match=r"nodes that do not exist: \[4\]"):
        write_g2o(
            path,
            PoseGraph(
                good.ids, good.poses, good.edges - np.array([[0, 0], [1, 0]]), good.measurements, good.covariances
            ),
        )
    with pytest.raises(InputError, match="2 edges, 1 measurements"):
        write_g2o(path, PoseGraph(good.ids, good.poses, good.edges, good.measurements[:1], good.covariances))
    with pytest.raises(InputError, match="ids of their own"):
        write_g2o(path, PoseGraph(good.ids * 0, good.poses, good.edges * 0, good.measurements, good.covariances))
    assert not path.exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds no VERTEX_SE2"),
        ("VERTEX_SE2 0 1 2\n", "line 1: VERTEX_SE2 must have 5 fields, but has 4"),
        ("VERTEX_SE2 0 1 2 x\n", "line 1: expected finite numbers"),
        ("EDGE_SE2 0 1 0 0 0 1 0 0 -1 0 1\n", "line 1: information must be finite and positive definite"),
        ("VERTEX_SE2 0 0 0 0\n\nVERTEX_SE2 0 1 2 0\n", "line 3: there is a vertex 0 already"),
        ("VERTEX_SE2 0.5 0 0 0\n", "line 1: ids of vertices are whole numbers, not '0.5'"),
        ("VERTEX_SE2 99999999999999999999 0 0 0\n", "line 1: ids of vertices are whole numbers"),
        ("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", r"is a 3D pose graph \(VERTEX_SE3:QUAT\); only planar ones"),
        ("# x\nODOMETRY 0 1\nLANDMARK 3\nLANDMARK 4\n", "it holds 2 LANDMARK, 1 ODOMETRY"),
        ("EDGE2 0 1 1 0 0 1 0 1 1 0 0\n", "holds 1 edges and no VERTEX_SE2.*the poses to begin with are missing"),
        ("VERTEX2 0 0 0\n", "line 1: VERTEX2 must have 5 fields, but has 4"),
        ("EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1\nVERTEX_SE2 0 0 0 0\n", "line 1: the edge has the vertex 1, which"),
        ("VERTEX_SE2 4 0 0 0\nEDGE_SE2 4 4 0 0 0 1 0 0 1 0 1\n", "line 2: the edge links the vertex 4 to itself"),
        ("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 0 0 0 1 0 0 1 0\n", "line 2: EDGE_SE2 must have 12 fields, but has 11"),
    ],
)
def test_damaged_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.g2o"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_g2o(path)


def test_toros_graphs_are_read_as_the_same_in_g2o(tmp_path: Path) -> None:
    """TORO writes the information in another order: 11 12 22 33 13 23."""
    toro, g2o = tmp_path / "a.graph", tmp_path / "a.g2o"
    toro.write_text("VERTEX2 0 0 0 0\nVERTEX2 1 1 2 0.5\nEDGE2 0 1 1 2 0.5 50 1 60 100 2 3\n")
    g2o.write_text("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 2 0.5\nEDGE_SE2 0 1 1 2 0.5 50 1 2 60 3 100\n")
    a, b = read_g2o(toro), read_g2o(g2o)
    np.testing.assert_array_equal(a.poses, b.poses)
    np.testing.assert_array_equal(a.edges, b.edges)
    np.testing.assert_array_equal(a.measurements, b.measurements)
    np.testing.assert_array_equal(a.covariances, b.covariances)


def test_manhattan(datasets: Path) -> None:
    manhattan = read_g2o(datasets / "posegraphs/manhattanOlson3500.g2o")
    assert (manhattan.poses.shape, manhattan.edges.shape) == ((3500, 3), (5598, 2))
    assert np.all(np.linalg.eigvalsh(manhattan.covariances) > 0.0)
