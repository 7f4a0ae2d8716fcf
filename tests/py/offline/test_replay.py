# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The replay of a simulated drive through a home, from its files to all that it leaves."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from oort import load_map, read_parameters, render_map
from oort.cli.replay import main
from oort.evaluation.trajectories import evaluate_ate
from oort.export import read_map_server
from oort.export.tum import Trajectory, read_tum
from oort.parameters import packaged_path
from oort.simulate import Drive
from oort.simulate.bag import write_bag
from oort.simulate.writers import write_carmen, write_events, write_truth

RESULTS = {
    "trajectory.tum",
    "map.pgm",
    "map.yaml",
    "map.png",
    "histograms.png",
    "graph.g2o",
    "report.json",
    "report.html",
    "map.map_capnp",
    "map.map_meta_capnp",
    "map.md5",
}


@dataclass(frozen=True)
class Replayed:
    """A replay's folder and what it printed."""

    out: Path
    stdout: str = ""

    @property
    def report(self) -> dict[str, Any]:
        report: dict[str, Any] = json.loads((self.out / "report.json").read_text())
        return report

    @property
    def trajectory(self) -> Trajectory:
        return read_tum(self.out / "trajectory.tum")


@pytest.fixture(scope="module")
def files(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with the drive's files: home.bag, .clf, .truth.tum and .events.json."""
    folder = tmp_path_factory.mktemp("drive")
    write_bag(drive, folder / "home.bag")
    write_carmen(drive, folder / "home.clf")
    write_truth(drive, folder / "home.truth.tum")
    write_events(drive, folder / "home.events.json")
    return folder


@pytest.fixture(scope="module")
def of_bag(files: Path, tmp_path_factory: pytest.TempPathFactory) -> Replayed:
    """The whole drive from its bag, by a process of its own."""
    cwd = tmp_path_factory.mktemp("bag")
    done = subprocess.run(
        [sys.executable, "-m", "oort.replay", files / "home.bag", "--events", files / "home.events.json"],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return Replayed(cwd / "oort-out" / "home", done.stdout)


@pytest.fixture(scope="module")
def of_log(files: Path, tmp_path_factory: pytest.TempPathFactory) -> Replayed:
    """The whole drive from its CARMEN log."""
    out = tmp_path_factory.mktemp("log")
    events = str(files / "home.events.json")
    assert main([str(files / "home.clf"), "--events", events, "--out", str(out), "--quiet"]) == 0
    return Replayed(out)


def truth_of(files: Path) -> Trajectory:
    return read_tum(files / "home.truth.tum")


def test_all_results_are_there_and_the_table_is_printed(of_bag: Replayed) -> None:
    assert {path.name for path in of_bag.out.iterdir()} == RESULTS
    rows = dict(line.split("  ", 1) for line in of_bag.stdout.splitlines() if "  " in line)
    report = of_bag.report
    assert rows["scans"].split()[0] == str(report["scans"])
    assert rows["nodes"].split()[0] == str(report["nodes"])
    assert rows["dock closures"].strip() == "1 tried, 1 accepted"
    for row in ("loop closures", "ms per scan", "times real time", "CPU seconds", "peak memory"):
        assert row in rows
    assert str(of_bag.out.name) in of_bag.stdout.splitlines()[-1]


def test_home_is_mapped_and_the_dock_found_again(of_bag: Replayed, of_log: Replayed, files: Path) -> None:
    for replayed in (of_bag, of_log):
        ate = evaluate_ate(replayed.trajectory, truth_of(files))
        assert ate.missing == 0
        assert ate.position_rmse < 0.05
        assert ate.position_max < 0.15
        assert ate.heading_rmse < 1.5
        assert replayed.report["docks"] == {"tried": 1, "accepted": 1, "rejected": {}}


def test_map_frame_is_that_of_the_first_sensor_pose(of_bag: Replayed, files: Path) -> None:
    """Without any alignment: the truth is given in that frame too."""
    errors = of_bag.trajectory.poses[:, :2] - truth_of(files).poses[:, :2]
    assert np.hypot(*errors.T).max() < 0.2


def test_one_trajectory_line_per_scan_in_the_recordings_order(of_bag: Replayed, of_log: Replayed, drive: Drive) -> None:
    stamps = drive.scan_stamps.tolist()
    assert list(of_bag.trajectory.stamps) == [f"{s // 10**9}.{s % 10**9:09d}" for s in stamps]
    assert list(of_log.trajectory.stamps) == [f"{s // 10**9}.{s % 10**9 // 1000:06d}" for s in stamps]


def test_trajectory_does_not_jump(of_bag: Replayed, files: Path) -> None:
    steps = np.hypot(*np.diff(of_bag.trajectory.poses[:, :2], axis=0).T)
    true_steps = np.hypot(*np.diff(truth_of(files).poses[:, :2], axis=0).T)
    assert np.abs(steps - true_steps).max() < 0.05


def test_bag_and_log_give_the_same_map(of_bag: Replayed, of_log: Replayed) -> None:
    """The log holds the same numbers, rounded to nanometres; what follows from them parts by far less than it errs."""
    bag, log = of_bag.report, of_log.report
    assert (bag["kind"], log["kind"]) == ("ROS 1 bag", "CARMEN log")
    assert bag["scans"] == log["scans"]
    assert bag["nodes"] == log["nodes"]
    assert bag["recorded_seconds"] == pytest.approx(log["recorded_seconds"])
    differences = np.hypot(*(of_bag.trajectory.poses - of_log.trajectory.poses)[:, :2].T)
    assert differences[:100].max() < 0.01
    assert evaluate_ate(of_bag.trajectory, of_log.trajectory).position_rmse < 0.03
    one, other = (load_map(str(replayed.out / "map")) for replayed in (of_bag, of_log))
    np.testing.assert_allclose(one.cloud_times, other.cloud_times, atol=1e-6)
    for k in range(0, len(one), 50):
        np.testing.assert_array_equal(one.cloud(k)[:, 2], other.cloud(k)[:, 2])
        returns = one.cloud(k)[:, 2] == 1.0
        np.testing.assert_allclose(one.cloud(k)[returns], other.cloud(k)[returns], atol=1e-6)


def test_replaying_twice_gives_the_same_bytes(of_bag: Replayed, files: Path, tmp_path: Path) -> None:
    events = str(files / "home.events.json")
    assert main([str(files / "home.bag"), "--events", events, "--out", str(tmp_path), "--quiet"]) == 0
    again = Replayed(tmp_path)
    for name in sorted(RESULTS - {"report.json", "report.html"}):
        assert (tmp_path / name).read_bytes() == (of_bag.out / name).read_bytes(), name
    one, other = of_bag.report, again.report
    assert one.pop("timings").keys() == other.pop("timings").keys()
    assert json.dumps(one) == json.dumps(other)  # in the same order, too


def test_report_holds_the_figures_and_the_parameters(of_bag: Replayed, drive: Drive) -> None:
    report = of_bag.report
    assert report["input"] == "home"
    assert report["scans"] == len(drive.scan_stamps)
    assert report["recorded_seconds"] == pytest.approx(drive.duration)
    assert report["parameters"] == read_parameters().to_dict()
    for closures in (report["loops"], report["docks"]):
        assert closures["accepted"] + sum(closures["rejected"].values()) == closures["tried"]
    assert report["loops"]["accepted"] + report["docks"]["accepted"] == report["map"]["switchable_edges"]
    assert sum(report["match_rejections"].values()) == report["odometry_links"]
    timings = report["timings"]
    per_scan = timings["ms_per_scan"]
    assert 0.0 < per_scan["p50"] <= per_scan["p95"] <= per_scan["p99"] <= per_scan["max"]
    assert timings["cpu_seconds"] > 0.0
    assert timings["times_real_time"] > 1.0
    assert timings["peak_memory_mb"] > 1.0


def test_saved_map_is_what_the_pictures_show(of_bag: Replayed) -> None:
    map_ = load_map(str(of_bag.out / "map"))
    report = of_bag.report
    assert len(map_) == report["nodes"]
    ((name_space, name, _, pose),) = map_.locations
    assert (name_space, name) == ("dock", "dock")
    assert np.hypot(*pose[:2]) < 0.2
    grid = render_map(map_, read_parameters())[0]
    saved = read_map_server(of_bag.out / "map.yaml")
    np.testing.assert_array_equal(saved.cells, grid.cells)
    assert saved.resolution == grid.resolution
    assert saved.origin[:2] == grid.origin
    assert saved.cells.shape == (report["map"]["height"], report["map"]["width"])
    with Image.open(of_bag.out / "map.png") as picture:
        assert picture.width >= report["map"]["width"]
        assert picture.height >= report["map"]["height"]


def test_graph_file_holds_the_solved_graph(of_bag: Replayed) -> None:
    map_ = load_map(str(of_bag.out / "map"))
    lines = [line.split() for line in (of_bag.out / "graph.g2o").read_text().splitlines()]
    vertices = np.array([line[2:5] for line in lines if line[0] == "VERTEX_SE2"], dtype=np.float64)
    np.testing.assert_allclose(vertices, map_.node_poses, atol=1e-9)
    edges = [line for line in lines if line[0] == "EDGE_SE2"]
    assert len(edges) == len(map_.edges["id"]) + len(map_.switchable_edges["id"])


def test_map_covers_the_home(of_bag: Replayed, drive: Drive) -> None:
    cells = read_map_server(of_bag.out / "map.yaml").cells
    free = float((cells == 0).sum()) * 0.05**2
    assert 0.6 * drive.home.area < free < 1.1 * drive.home.area


def test_documented_parameters_map_the_home_too(files: Path, tmp_path: Path) -> None:
    arguments = ["--params", str(packaged_path("kuri_original")), "--until", "50", "--out", str(tmp_path), "--quiet"]
    assert main([str(files / "home.clf"), *arguments]) == 0
    replayed = Replayed(tmp_path)
    assert replayed.report["parameters"]["incremental_graph_builder.frsm_matcher.meters_per_pixel"] == 0.01
    assert evaluate_ate(replayed.trajectory, truth_of(files)).position_rmse < 0.1
