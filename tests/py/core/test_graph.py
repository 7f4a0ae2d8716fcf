# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The pose graph optimiser on real graphs."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from oort import _core
from oort.export.g2o import PoseGraph, read_g2o

Floats = NDArray[np.float64]


@pytest.fixture(scope="module")
def manhattan(datasets: Path) -> PoseGraph:
    return read_g2o(datasets / "posegraphs/manhattanOlson3500.g2o")


@pytest.fixture(scope="module")
def manhattan_truth(datasets: Path) -> Floats:
    return np.loadtxt(datasets / "posegraphs/manhattan_nodes_groundTruth.dat")


def is_closure(graph: PoseGraph) -> NDArray[np.bool_]:
    return np.asarray(np.abs(graph.edges[:, 1] - graph.edges[:, 0]) != 1)


def solve(graph: PoseGraph, switchable: NDArray[np.bool_]) -> tuple[Floats, Floats, _core.OptimizerSummary]:
    """Solves from the graph's own poses."""
    i, j = graph.edges.T
    return _core.optimize_graph(graph.poses, i, j, graph.measurements, graph.covariances, switchable)


def with_false_closures(graph: PoseGraph, count: int, seed: int) -> PoseGraph:
    """The graph and closures between random nodes that claim to be close to each other."""
    random = np.random.Generator(np.random.PCG64(seed))
    i = random.integers(len(graph.poses) - 2, size=count)
    pairs = np.stack([i, random.integers(i + 2, len(graph.poses))], axis=1)
    measured = random.uniform((-1.0, -1.0, -np.pi), (1.0, 1.0, np.pi), size=(count, 3))
    return PoseGraph(
        ids=graph.ids,
        poses=graph.poses,
        edges=np.concatenate([graph.edges, pairs]),
        measurements=np.concatenate([graph.measurements, measured]),
        covariances=np.concatenate([graph.covariances, np.repeat(graph.covariances[:1], count, axis=0)]),
    )


def position_rmse(poses: Floats, truth: Floats) -> float:
    """Root mean square distance after the best rigid motion [m]."""
    a = poses[:, :2] - poses[:, :2].mean(axis=0)
    b = truth[:, :2] - truth[:, :2].mean(axis=0)
    turn = np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    c, s = np.cos(turn), np.sin(turn)
    return float(np.sqrt(np.mean(np.sum((a @ np.array([[c, s], [-s, c]]) - b) ** 2, axis=1))))


def chained(measurements: Floats, first: Floats) -> Floats:
    """Poses from following a chain of measured steps."""
    poses = [first]
    for x, y, theta in measurements:
        x0, y0, theta0 = poses[-1]
        c, s = np.cos(theta0), np.sin(theta0)
        poses.append(np.array([x0 + c * x - s * y, y0 + s * x + c * y, theta0 + theta]))
    return np.array(poses)


def test_genuine_map_is_the_optimum_of_its_own_edges(datasets: Path) -> None:
    stored = _core.load_map(str(datasets / "kuri_oort_map/map"))
    chain, loops = stored.edges, stored.switchable_edges
    i, j, measured, covariances = (np.concatenate([chain[key], loops[key]]) for key in ("i", "j", "pose", "covariance"))
    switchable = np.arange(len(i)) >= len(chain["i"])
    start = chained(chain["pose"], stored.node_poses[0])
    assert np.abs(start - stored.node_poses).max() > 1e-4
    options = _core.OptimizerOptions(whitening=_core.Whitening.ORIGINAL)
    poses, switches, summary = _core.optimize_graph(start, i, j, measured, covariances, switchable, options)
    assert summary.converged
    np.testing.assert_allclose(poses, stored.node_poses, rtol=0, atol=1e-7)
    np.testing.assert_allclose(switches[switchable], loops["switch"], rtol=0, atol=1e-6)


def test_genuine_map_moves_little_when_whitened_correctly(datasets: Path) -> None:
    stored = _core.load_map(str(datasets / "kuri_oort_map/map"))
    before = stored.node_poses
    assert _core.optimize_map(stored).converged
    moved = np.abs(stored.node_poses - before).max()
    assert 1e-6 < moved < 1e-4  # the original's weighting differs by up to 8e-5 m here


def test_solving_a_solved_map_changes_nothing(datasets: Path) -> None:
    stored = _core.load_map(str(datasets / "kuri_oort_map/map"))
    before = stored.node_poses
    summary = _core.optimize_map(stored, _core.OptimizerOptions(whitening=_core.Whitening.ORIGINAL))
    assert summary.converged
    np.testing.assert_allclose(stored.node_poses, before, rtol=0, atol=1e-7)


def test_manhattan_without_switches(manhattan: PoseGraph, manhattan_truth: Floats) -> None:
    poses, switches, summary = solve(manhattan, np.zeros(len(manhattan.edges), dtype=bool))
    assert summary.converged, summary.message
    assert position_rmse(poses, manhattan_truth) == pytest.approx(0.794, abs=0.005)
    assert (switches == 1.0).all()


@pytest.mark.parametrize("count", [0, 10, 100])
def test_manhattan_with_false_closures(manhattan: PoseGraph, manhattan_truth: Floats, count: int) -> None:
    spoilt = with_false_closures(manhattan, count, seed=1)
    poses, switches, summary = solve(spoilt, is_closure(spoilt))
    assert summary.converged, summary.message
    assert position_rmse(poses, manhattan_truth) < 0.82
    genuine = np.arange(len(switches)) < len(manhattan.edges)
    assert (switches[genuine] > 0.5).mean() > 0.999
    assert (switches[~genuine] < 0.5).all()


def test_false_closures_without_switches_spoil_manhattan(manhattan: PoseGraph, manhattan_truth: Floats) -> None:
    """Else the test above would show nothing."""
    spoilt = with_false_closures(manhattan, 10, seed=1)
    poses, _, _ = solve(spoilt, np.zeros(len(spoilt.edges), dtype=bool))
    assert position_rmse(poses, manhattan_truth) > 3.0


@pytest.mark.parametrize("switches", [False, True])
def test_intel_converges(datasets: Path, switches: bool) -> None:
    intel = read_g2o(datasets / "posegraphs/intel.g2o")
    _, _, summary = solve(intel, is_closure(intel) & switches)
    assert summary.converged, summary.message
    assert summary.final_cost < summary.initial_cost


def test_false_closures_pull_no_more(manhattan: PoseGraph) -> None:
    """The poses are those of the graph without them."""
    clean, _, _ = solve(manhattan, is_closure(manhattan))
    spoilt = with_false_closures(manhattan, 100, seed=1)
    poses, switches, summary = solve(spoilt, is_closure(spoilt))
    assert position_rmse(poses, clean) < 1e-3
    scale = _core.OptimizerOptions().switchable_constraint_scale
    np.testing.assert_allclose(switches[is_closure(spoilt)], scale / (scale + summary.chi_squared), rtol=1e-9)


def test_switches_of_an_earlier_solution_are_where_the_next_starts(manhattan: PoseGraph) -> None:
    spoilt = with_false_closures(manhattan, 100, seed=1)
    i, j = spoilt.edges.T
    edges = (i, j, spoilt.measurements, spoilt.covariances, is_closure(spoilt))
    poses, switches, first = _core.optimize_graph(spoilt.poses, *edges)
    again, _, second = _core.optimize_graph(poses, *edges, switches=switches)
    assert second.iterations < 5 < first.iterations
    assert position_rmse(again, poses) < 1e-3
    _, _, anew = _core.optimize_graph(poses, *edges)
    assert anew.iterations > second.iterations


def test_only_free_nodes_move(manhattan: PoseGraph) -> None:
    i, j = manhattan.edges.T
    options = _core.OptimizerOptions(first_free_node=3000)
    poses, _, _ = _core.optimize_graph(
        manhattan.poses, i, j, manhattan.measurements, manhattan.covariances, is_closure(manhattan), options
    )
    assert poses[:3000].tobytes() == manhattan.poses[:3000].tobytes()
    assert np.abs(poses[3000:] - manhattan.poses[3000:]).max() > 0.1


def test_same_graph_gives_the_same_bits(manhattan: PoseGraph) -> None:
    spoilt = with_false_closures(manhattan, 10, seed=2)
    first, second = (solve(spoilt, is_closure(spoilt)) for _ in range(2))
    assert first[0].tobytes() == second[0].tobytes()
    assert first[1].tobytes() == second[1].tobytes()


SQUARE: dict[str, Any] = {
    "node_poses": np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.5], [1.0, 1.0, 3.0]]),
    "i": [0, 1, 2],
    "j": [1, 2, 0],
    "measurements": np.array([[1.0, 0.0, 1.5], [1.0, 0.0, 1.5], [1.0, 1.0, -3.0]]),
    "covariances": np.repeat(np.eye(3)[None] * 1e-4, 3, axis=0),
    "switchable": [False, False, True],
}


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("node_poses", np.zeros((3, 2)), r"node_poses must have the shape \(3, 3\), not \(3, 2\)"),
        ("measurements", np.zeros((2, 3)), r"measurements must have the shape \(3, 3\), not \(2, 3\)"),
        ("switchable", [True], "switchable"),
        ("switches", [1.0], r"switches must have the shape \(3\), not \(1\)"),
        ("switches", [1.0, 1.0, 1.5], "outside 0 to 1"),
        ("i", [0, 1, 7], r"edge 2 \(node 7 to 0\)"),
        ("j", [1, -2, 0], r"edge 1 .* names a node that is not in the graph"),
        ("covariances", np.zeros((3, 3, 3)), r"edge 0 .* covariance"),
        ("node_poses", np.full((3, 3), np.nan), "node 0 is not finite"),
    ],
)
def test_bad_arrays_are_refused(name: str, value: object, message: str) -> None:
    with pytest.raises(_core.InputError, match=message):
        _core.optimize_graph(**(SQUARE | {name: value}))


def test_empty_graph_is_solved() -> None:
    none = np.zeros(0, dtype=int)
    poses, switches, summary = _core.optimize_graph(
        np.zeros((0, 3)), none, none, np.zeros((0, 3)), np.zeros((0, 3, 3)), none.astype(bool)
    )
    assert poses.shape == (0, 3) and switches.shape == (0,)
    assert summary.converged


def test_bad_options_are_refused() -> None:
    with pytest.raises(_core.ParameterError, match="switchable_constraint_scale"):
        _core.optimize_graph(**SQUARE, options=_core.OptimizerOptions(switchable_constraint_scale=-1.0))
