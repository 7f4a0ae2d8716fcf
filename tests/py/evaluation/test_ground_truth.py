# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Relations from the closures of a solved map, on the golden map: 63 nodes, two chains, a closure that is off."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from oort import Map, load_map
from oort.cli.evaluate import main
from oort.errors import InputError
from oort.evaluation.ground_truth import RelationLimits, autogenerate_relations, write_relations
from oort.evaluation.trajectories import evaluate_relations
from oort.export import Trajectory, write_tum
from oort.poses import between, compose

GOLDEN = ROOT / "tests/py/data/maps/format_1/home"
SENSOR = (0.1, 0.02, 0.3)  # T_base_sensor
LOOSE = RelationLimits(min_covered_distance=0.0, outlier_threshold_meters=10.0, outlier_threshold_radians=3.2)


@pytest.fixture(scope="module")
def map_() -> Map:
    return load_map(str(GOLDEN))


def base_trajectory(map_: Map) -> Trajectory:
    stamps = tuple(f"{time:.6f}" for time in map_.cloud_times.tolist())
    return Trajectory(stamps, compose(map_.node_poses, between(SENSOR, np.zeros(3))))


def driven(map_: Map, i: int, j: int) -> float:
    """By hand: step by step, but for the step from one chain to the next."""
    results = map_.incremental_results
    starts = results["id"][results["id"] == results["target"]].tolist()
    steps = itertools.pairwise(range(i, j + 1))
    return sum(float(np.hypot(*(map_.node_poses[b] - map_.node_poses[a])[:2])) for a, b in steps if b not in starts)


def test_relations_are_the_solutions_own(map_: Map, tmp_path: Path) -> None:
    truth = autogenerate_relations(map_, SENSOR, LOOSE)
    edges = map_.switchable_edges
    off = int((edges["switch"] < 0.5).sum())
    assert (truth.closures, truth.switched_off) == (len(edges["i"]), off)
    assert len(truth.relations) + truth.repeated == truth.closures - off > 0
    assert (truth.too_short, truth.outliers) == (0, 0)
    assert (truth.relations[:, 0] < truth.relations[:, 1]).all()
    write_relations(tmp_path / "a.relations", truth.relations)
    result = evaluate_relations(base_trajectory(map_), tmp_path / "a.relations")
    assert (result.n, result.missing) == (len(truth.relations), 0)
    assert max(result.translation_max, result.rotation_max) < 1e-9


def test_only_long_ways_count(map_: Map) -> None:
    edges = map_.switchable_edges
    on = edges["switch"] >= 0.5
    pairs = {tuple(sorted(pair)) for pair in zip(edges["i"][on].tolist(), edges["j"][on].tolist(), strict=True)}
    ways = {pair: driven(map_, *pair) for pair in pairs}
    limit = float(np.median(list(ways.values()))) + 1e-6
    truth = autogenerate_relations(map_, SENSOR, RelationLimits(limit, 10.0, 3.2))
    times = map_.cloud_times
    expected = sorted([times[i], times[j]] for (i, j), way in ways.items() if way >= limit)
    assert truth.relations[:, :2].tolist() == expected
    assert truth.too_short > 0


def test_outliers_are_left_out(map_: Map) -> None:
    edges, poses = map_.switchable_edges, map_.node_poses
    off_by = between(edges["pose"], between(poses[edges["i"]], poses[edges["j"]]))[edges["switch"] >= 0.5]
    distances, angles = np.hypot(off_by[:, 0], off_by[:, 1]), np.abs(off_by[:, 2])
    limits = RelationLimits(0.0, float(np.median(distances)), float(np.median(angles)))
    truth = autogenerate_relations(map_, SENSOR, limits)
    fits = (distances <= limits.outlier_threshold_meters) & (angles <= limits.outlier_threshold_radians)
    assert 0 < truth.outliers == int((~fits).sum())
    assert len(truth.relations) + truth.repeated == int(fits.sum())


def test_a_map_without_such_closures(map_: Map) -> None:
    with pytest.raises(InputError, match=r"0 closures gives a relation"):
        autogenerate_relations(Map())
    with pytest.raises(InputError, match=r"1 are switched off, .* over less than 1e\+06 m"):
        autogenerate_relations(map_, limits=RelationLimits(min_covered_distance=1e6))


def test_command_line(map_: Map, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    relations, trajectory = str(tmp_path / "a.relations"), tmp_path / "a.tum"
    options = ["--min-covered-distance", "1", "--outlier-threshold-meters", "1", "--outlier-threshold-radians", "1"]
    mount = ["--sensor-on-base", *map(str, SENSOR)]
    assert main(["autogenerate", str(GOLDEN), relations, *options, *mount]) == 0
    assert re.match(r"relations    \d+ of 7 closures\nleft out     1 switched off", capsys.readouterr().out)
    base = base_trajectory(map_)
    write_tum(trajectory, base.stamps, base.poses)
    assert main(["relations", str(trajectory), relations]) == 0
    assert "translation  mean 0.0000 m" in capsys.readouterr().out
    assert main(["autogenerate", str(tmp_path / "none"), relations]) == 2
    assert capsys.readouterr().err.startswith(f"oort evaluate: {tmp_path / 'none'}")
