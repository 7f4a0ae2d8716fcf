# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Replays of real recordings with the default parameters. The whole logs are slow."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from oort import load_map
from oort.cli.replay import main
from oort.evaluation.trajectories import RelationsResult, evaluate_relations
from oort.export import read_map_server
from oort.export.tum import Trajectory, read_tum


def replay(recording: Path, out: Path, *options: object) -> tuple[dict[str, Any], Trajectory]:
    """The report and the trajectory."""
    if not recording.is_file():
        pytest.skip(f"{recording} not found (set OORT_DATASETS)")
    assert main([str(recording), "--out", str(out), "--quiet", *map(str, options)]) == 0
    return json.loads((out / "report.json").read_text()), read_tum(out / "trajectory.tum")


def relations_within(trajectory: Trajectory, relations: Path, out: Path) -> RelationsResult:
    """Of the relations, those between times that the trajectory reaches."""
    known = {round(time, 6) for time in trajectory.times.tolist()}
    lines = relations.read_text().splitlines()
    kept = [line for line in lines if {round(float(t), 6) for t in line.split()[:2]} <= known]
    assert len(kept) > 100
    (out / "some.relations").write_text("\n".join(kept) + "\n")
    return evaluate_relations(trajectory, out / "some.relations")


def test_first_minutes_of_freiburg(datasets: Path, tmp_path: Path) -> None:
    report, trajectory = replay(datasets / "radish" / "fr079.clf.bz2", tmp_path, "--until", 200)
    assert report["kind"] == "CARMEN log"
    assert len(trajectory.stamps) == report["scans"] > 800
    assert report["scans_matched"] > 0.95 * report["scans"]
    errors = relations_within(trajectory, datasets / "radish" / "fr079.relations", tmp_path)
    assert errors.translation_mean < 0.035
    assert errors.translation_max < 0.3
    assert errors.rotation_mean < 0.6


def test_odometry_alone_would_not_pass(datasets: Path, tmp_path: Path) -> None:
    """What the bounds above are worth: matches that are never believed leave odometry."""
    params = tmp_path / "params.json"
    filtering = {"min_accept_score": 1.0, "y_abs_accept": 0.0, "theta_abs_accept": 0.0}
    loops = {"candidate_search": {"knearest_neighbors": 0}}
    params.write_text(
        json.dumps(
            {
                "incremental_graph_builder": {"frsm_matcher": {"match_filtering": filtering}},
                "loop_closure_graph_builder": loops,
                "final_refinement": False,  # it matches scans, too
            }
        )
    )
    options = ("--until", 200, "--params", params)
    report, trajectory = replay(datasets / "radish" / "fr079.clf.bz2", tmp_path, *options)
    assert report["odometry_links"] > 0.95 * report["nodes"]
    errors = relations_within(trajectory, datasets / "radish" / "fr079.relations", tmp_path)
    assert errors.translation_mean > 0.05
    assert errors.translation_max > 1.0
    assert errors.rotation_mean > 1.2


@pytest.mark.parametrize("when", ["before", "after"])
def test_bags_of_a_small_robot(datasets: Path, tmp_path: Path, when: str) -> None:
    report, trajectory = replay(datasets / "bags" / f"2018_dec13_target_{when}.bag", tmp_path)
    assert report["kind"] == "ROS 1 bag"
    assert len(trajectory.stamps) == report["scans"] > 100
    assert report["scans_matched"] > 0.9 * report["scans"]
    map_ = load_map(str(tmp_path / "map"))
    assert len(map_) == report["nodes"] > 3
    saved = read_map_server(tmp_path / "map.yaml")
    free = float((saved.cells == 0).sum()) * saved.resolution**2
    assert 5.0 < free < 100.0  # [m^2]; a room or two
    width, height = saved.resolution * np.array(saved.cells.shape)
    assert min(width, height) > 3.0
    assert max(width, height) < 25.0


@pytest.mark.slow
@pytest.mark.parametrize(("log", "bound"), [("fr079", 0.045), ("intel", 0.030)])
def test_whole_logs(datasets: Path, tmp_path: Path, log: str, bound: float) -> None:
    report, trajectory = replay(datasets / "radish" / f"{log}.clf.bz2", tmp_path)
    assert len(trajectory.stamps) == report["scans"]
    errors = evaluate_relations(trajectory, datasets / "radish" / f"{log}.relations")
    assert errors.missing == 0
    assert errors.translation_mean <= bound
    assert errors.rotation_mean < 1.0
