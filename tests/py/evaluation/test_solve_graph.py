# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Solving pose graphs from g2o files: `oort graph solve`."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from oort.cli.main import main
from oort.errors import InputError
from oort.evaluation.graph import METHODS, chi_squared, find_closures, position_rmse, read_truth, solve_graph
from oort.export import PoseGraph, read_g2o, write_g2o
from oort.poses import between, compose

TURNS, SIDE = 3, 5  # rounds of a square, and nodes on a side
HONEST = 16.0  # the scale for covariances that are what the noise is


def ring() -> tuple[PoseGraph, np.ndarray]:
    """A square driven three times with noisy steps, a closure to each earlier visit, and the truth.

    The ids are not consecutive, and the nodes are not in their order.
    """
    rng = np.random.Generator(np.random.PCG64(7))
    count, lap = 4 * SIDE * TURNS, 4 * SIDE
    step = np.array([1.0, 0.0, 0.0])
    truth = [np.zeros(3)]
    for k in range(1, count):
        truth.append(compose(truth[-1], step if k % SIDE else np.array([1.0, 0.0, np.pi / 2])))
    true = np.array(truth)
    pairs = [(k, k + 1) for k in range(count - 1)] + [(k, k + lap) for k in range(count - lap)]
    edges = np.array(pairs)
    sigmas = np.where((edges[:, 1] - edges[:, 0] == 1)[:, None], [0.05, 0.03, 0.02], [0.02, 0.03, 0.01])
    measured = between(true[edges[:, 0]], true[edges[:, 1]]) + rng.normal(size=(len(edges), 3)) * sigmas
    poses = [true[0]]
    for k in range(count - 1):
        poses.append(compose(poses[-1], measured[k]))
    ids, order = 5 * np.arange(count) + 3, rng.permutation(count)
    graph = PoseGraph(
        ids[order], np.array(poses)[order], ids[edges], measured, np.stack([np.diag(s**2) for s in sigmas])
    )
    return graph, true[order]


def spoilt(graph: PoseGraph) -> PoseGraph:
    """With two false closures, the last edges."""
    return replace(
        graph,
        edges=np.concatenate([graph.edges, [[3, 3 + 5 * 27], [3 + 5 * 8, 3 + 5 * 51]]]),
        measurements=np.concatenate([graph.measurements, [[0.3, 0.2, 1.0], [0.0, 0.5, 0.0]]]),
        covariances=np.concatenate([graph.covariances, np.stack([np.diag([4e-4, 9e-4, 1e-4])] * 2)]),
    )


def test_false_closures_are_switched_off() -> None:
    graph, truth = ring()
    clean, solution = solve_graph(graph, scale=HONEST), solve_graph(spoilt(graph), scale=HONEST)
    assert clean.believed.all()
    assert np.flatnonzero(~solution.believed).tolist() == [len(graph.edges), len(graph.edges) + 1]
    assert position_rmse(graph.poses, truth) > 0.2
    assert position_rmse(solution.graph.poses, truth) < 0.1
    np.testing.assert_allclose(solution.graph.poses, clean.graph.poses, atol=0.01)


def test_plain_believes_everything() -> None:
    graph, truth = ring()
    solution = solve_graph(spoilt(graph), "plain")
    assert solution.believed.all()
    assert position_rmse(solution.graph.poses, truth) > 1.0
    assert solution.chi_squared.sum() == pytest.approx(2.0 * solution.summary.final_cost, rel=1e-9)


def test_switch_is_the_optimum_of_the_switches() -> None:
    graph = spoilt(ring()[0])
    solution = solve_graph(graph, "switch", scale=3.0)
    chi2 = solution.chi_squared[solution.closures]
    np.testing.assert_allclose(solution.switches[solution.closures], 3.0 / (3.0 + chi2), atol=1e-6)
    assert solution.believed.tolist() == (solution.switches >= 0.5).tolist()


def test_the_order_of_nodes_does_not_matter() -> None:
    graph, _ = ring()
    order = np.argsort(graph.ids)
    tidy = replace(graph, ids=graph.ids[order], poses=graph.poses[order])
    np.testing.assert_array_equal(find_closures(graph), find_closures(tidy))
    assert find_closures(graph).sum() == 2 * 4 * SIDE
    np.testing.assert_allclose(chi_squared(graph), chi_squared(tidy))
    a, b = solve_graph(graph, "plain").graph.poses[order], solve_graph(tidy, "plain").graph.poses
    np.testing.assert_allclose(between(a[0], a), between(b[0], b), atol=1e-5)


def test_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    graph, truth = ring()
    source, target, true = (tmp_path / name for name in ("in.g2o", "out.g2o", "truth.txt"))
    write_g2o(source, spoilt(graph))
    np.savetxt(true, truth)
    assert main(["graph", "solve", str(source), str(target), "--truth", str(true), "--json", "--scale", "16"]) == 0
    figures = json.loads(capsys.readouterr().out)
    off = [(edge["i"], edge["j"]) for edge in figures["switched_off"]]
    assert off == [(3, 138), (43, 258)]
    assert figures["rmse"] < 0.1 < figures["rmse_before"]
    assert figures["chi2_believed"] < figures["chi2"] < figures["chi2_before"]
    solved = read_g2o(target)
    assert len(solved.edges) == figures["edges"] - len(off)
    assert chi_squared(solved).sum() == pytest.approx(figures["chi2_believed"], rel=1e-6)
    for method in METHODS:
        options = ["--scale", "16", "--method", method, "--truth", str(source)]
        assert main(["graph", "solve", str(source), str(target), *options]) == 0
        text = capsys.readouterr().out
        assert f"edges         {figures['edges']}, {2 * 4 * SIDE + 2} of them closures" in text
        assert ("  3 -> 138  chi2 " in text) == (method != "plain")
        assert "RMSE          0.0000 m before" in text


def test_truths_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    graph, truth = ring()
    path = tmp_path / "truth.txt"
    np.savetxt(path, truth[:-1])
    with pytest.raises(InputError, match="59 poses, but the graph has 60 nodes"):
        read_truth(path, graph)
    path.write_text("1 2\n")
    with pytest.raises(InputError, match="line 1: expected x y theta, but there are 2 fields"):
        read_truth(path, graph)
    other = tmp_path / "truth.g2o"
    write_g2o(other, replace(graph, ids=graph.ids + 1, edges=graph.edges + 1))
    with pytest.raises(InputError, match="has no vertex 3"):
        read_truth(other, graph)


def test_errors_of_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bad = tmp_path / "bad.g2o"
    bad.write_text("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 7 1 0 0 1 0 0 1 0 1\n")
    assert main(["graph", "solve", str(bad), str(tmp_path / "out.g2o")]) == 2
    assert (
        capsys.readouterr().err
        == f"oort graph: {bad}: line 2: the edge has the vertex 7, which the file does not hold\n"
    )
    assert main(["graph", "solve", str(tmp_path / "none.g2o"), str(tmp_path / "out.g2o")]) == 2
    assert "cannot be read" in capsys.readouterr().err
    write_g2o(bad, ring()[0])
    assert main(["graph", "solve", str(bad), str(tmp_path / "out.g2o"), "--scale", "-1"]) == 2
    assert main(["graph", "solve", str(bad), str(tmp_path / "no" / "out.g2o")]) == 2
    assert not (tmp_path / "out.g2o").exists()


def test_manhattan(datasets: Path, tmp_path: Path) -> None:
    source = datasets / "posegraphs/manhattanOlson3500.g2o"
    graph = read_g2o(source)
    truth = read_truth(datasets / "posegraphs/manhattan_nodes_groundTruth.dat", graph)
    solution = solve_graph(graph)
    assert solution.believed.all()
    assert solution.chi_squared.sum() == pytest.approx(146.2, abs=1.0)
    assert position_rmse(solution.graph.poses, truth) < 0.25 * position_rmse(graph.poses, truth)
