# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What bench/accuracy.py says of maps is true of maps that are known, and its command runs."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from oort import Parameters
from oort.poses import Array, compose
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive

sys.path.insert(0, str(ROOT / "bench"))

from oort.evaluation.consistency import consistency
from trials.drives import recording_of
from trials.faults import lost_span
from trials.replays import replay
from trials.truth import compose_chain, edge_errors, free_directions, nees
from trials.workers import Failure, run_all


def rng() -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(1))


def test_an_edge_errs_by_what_it_was_given_too_much() -> None:
    truth = np.array([[1.0, 2.0, 0.5], [2.0, -1.0, 3.0]])
    measured = np.array([[0.1, -0.2, 0.05]]) + compose(compose([0.0, 0.0, -0.5], [-1.0, -2.0, 0.0]), truth[1])
    errors = edge_errors({"i": np.array([0]), "j": np.array([1]), "pose": measured}, truth)
    np.testing.assert_allclose(errors, [[0.1, -0.2, 0.05]], atol=1e-12)


def test_nees_of_an_honest_covariance_is_its_dimension() -> None:
    covariance = np.array([[0.04, 0.01, 0.002], [0.01, 0.02, -0.001], [0.002, -0.001, 0.001]])
    errors = rng().multivariate_normal(np.zeros(3), covariance, 20_000)
    assert nees(errors, np.tile(covariance, (len(errors), 1, 1))).mean() == pytest.approx(3.0, abs=0.05)


def test_a_chains_covariance_is_that_of_its_samples() -> None:
    steps = np.array([[0.3, 0.05, 0.4], [0.2, -0.1, -0.9], [0.5, 0.0, 0.2]])
    covariances = np.array([np.diag([1e-4, 4e-5, 2e-4]), np.diag([2e-4, 1e-4, 1e-4]), np.diag([1e-5, 3e-4, 5e-5])])
    pose, covariance = compose_chain(steps, covariances)
    ends = np.zeros((40_000, 3))
    for step, its in zip(steps, covariances, strict=True):
        ends = compose(ends, step + rng_noise(its, len(ends)))
    np.testing.assert_allclose(ends.mean(axis=0), pose, atol=5e-4)
    np.testing.assert_allclose(np.cov(ends.T), covariance, atol=8e-6)


def rng_noise(covariance: Array, count: int) -> Array:
    seed = int(1e7 * covariance[1, 1])
    return np.random.Generator(np.random.PCG64(seed)).multivariate_normal(np.zeros(3), covariance, count)


def test_a_corridor_is_free_along_its_axis_until_its_end_is_seen() -> None:
    drive = simulate_drive(1, SimulationConfig(scene="corridor", odometry_error=0.0))
    scans = np.arange(0, len(drive.scan_stamps), 20)
    directions, free = free_directions(drive, scans)
    x = drive.T_map_base[scans, 0]
    assert np.all(free[x < 27.0])
    assert not np.any(free[x > 28.5])
    along = directions + drive.T_map_base[scans, 2]
    assert np.all(np.abs(np.sin(along[x < 27.0])) < 0.05)


def test_lost_is_from_the_first_error_to_the_first_of_a_steady_row_without() -> None:
    off = np.zeros(100, dtype=bool)
    assert lost_span(off) == (0, 0)
    off[[10, 25]] = True
    assert lost_span(off) == (10, 26)
    off[90:] = True
    assert lost_span(off) == (10, 26)
    off[30:90:10] = True
    assert lost_span(off) == (10, 100)


def test_work_that_fails_or_dies_does_not_end_the_rest() -> None:
    def fail() -> int:
        raise ValueError("no good")

    def die() -> int:
        raise SystemExit(3)

    results = dict(run_all([lambda: 1, fail, die, lambda: 4], at_once=2))
    assert (results[0], results[3]) == (1, 4)
    failure, death = results[1], results[2]
    assert isinstance(failure, Failure)
    assert "no good" in failure.reason
    assert isinstance(death, Failure)


def test_the_command_measures_keeps_and_compares(tmp_path: Path) -> None:
    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(ROOT / "bench/accuracy.py"), *words]
        return subprocess.run(command, capture_output=True, text=True, check=True)

    first = run("--rows", "corridor", "--homes", "1", "--keep", str(tmp_path), "--worst", "1")
    assert "| corridor | 1 |" in first.stdout
    assert "simulated 1 of 1" in first.stderr
    results = json.loads((tmp_path / "results.json").read_text())
    assert list(results["rows"]["corridor"]["drives"]) == ["corridor/1"]
    assert (tmp_path / "corridor/1/truth.png").is_file()
    (tmp_path / "results.json").rename(tmp_path / "old.json")
    assert "simulated" not in run("--rows", "corridor", "--homes", "1", "--keep", str(tmp_path)).stderr
    compared = run("--compare", str(tmp_path / "old.json"), str(tmp_path / "results.json")).stdout
    assert "along_max: 0 drives better, 0 worse, 1 the same or new" in compared


def test_a_map_agrees_with_itself_until_it_is_bent(drive: Drive) -> None:
    map_ = replay(recording_of(drive, "home"), Parameters()).drive.map
    whole = consistency(map_)
    assert whole.pairs > 100
    assert whole.agreement > 0.95
    assert whole.contradicting < 0.05
    assert whole.untied_nodes == 0
    bent = map_.node_poses
    bent[len(bent) // 2 :, 0] += 0.4
    assert consistency(map_, bent).contradicting > 0.2 > whole.contradicting + 0.1


def test_the_corpus_measures_each_recording_and_names_what_it_cannot_read(drive: Drive, tmp_path: Path) -> None:
    write_drive(drive, tmp_path, "home", picture=False)
    (tmp_path / "broken.clf").write_text("no log\n")
    out = tmp_path / "out"
    command = [sys.executable, str(ROOT / "bench/corpus.py"), "--folder", str(tmp_path), "--keep", str(out)]
    done = subprocess.run([*command, "--view", "120"], capture_output=True, text=True, check=True)
    assert "broken.clf: failed: InputError" in done.stdout
    results = json.loads((out / "results.json").read_text())
    assert set(results["failed"]) == {"broken.clf"}
    figures = results["recordings"]["home.clf"]
    assert figures["ate"] < 0.05 < figures["ate_odometry"]
    assert (out / "home.clf/map.png").is_file()


def test_a_kidnapped_robot_is_timed_until_it_says_rightly_where_it_is() -> None:
    from kidnapped import LOOKED_AT, PERIOD, _figures

    claims = np.array([True, True, False, False, True, True])
    home = np.array([False, False, False, True, True, True])
    drives = np.array([False, True, True, True, True, True])
    step = PERIOD * LOOKED_AT
    assert _figures(claims, home, drives) == {"home_s": 4 * step, "wrong_s": 2 * step, "wrong_late_s": 0.0}
    assert _figures(claims[:3], home[:3], drives[:3])["home_s"] is None
