# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The options and events of a replay, and going on with a map in a second drive."""

import csv
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from oort import load_map
from oort.cli.replay import main
from oort.export import write_picture
from oort.export.tum import read_tum
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag
from oort.simulate.writers import write_carmen, write_events, write_truth

START = 1_600_000_000.0  # of simulated drives [s]
SUFFIXES = (".map_capnp", ".map_meta_capnp", ".md5")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with the files of two drives through one small home: first and second."""
    folder = tmp_path_factory.mktemp("drives")
    for name, config in (
        ("first", SimulationConfig(minutes=0.0)),
        ("second", SimulationConfig(minutes=0.0, odometry_error=2.0, person=False)),
    ):
        drive = simulate_drive(2, config)
        write_carmen(drive, folder / f"{name}.clf")
        write_truth(drive, folder / f"{name}.truth.tum")
        write_events(drive, folder / f"{name}.events.json")
        if name == "first":
            write_bag(drive, folder / f"{name}.bag")
    return folder


def run(recording: Path, out: Path, *options: object) -> int:
    return main([str(recording), "--out", str(out), "--quiet", *map(str, options)])


def report_of(out: Path) -> dict[str, Any]:
    report: dict[str, Any] = json.loads((out / "report.json").read_text())
    return report


def write_calls(path: Path, calls: Sequence[tuple[float, str, list[Any]]]) -> Path:
    """An events file; times are seconds after the first scan."""
    path.write_text(json.dumps([{"t": START + t, "call": call, "args": args} for t, call, args in calls]))
    return path


def test_until_stops_after_so_many_seconds(files: Path, tmp_path: Path) -> None:
    assert run(files / "first.clf", tmp_path, "--until", 12.5) == 0
    times = read_tum(tmp_path / "trajectory.tum").times
    assert times[0] == START
    assert times[-1] == pytest.approx(START + 12.5)
    assert len(times) == 126
    assert report_of(tmp_path)["recorded_seconds"] == pytest.approx(12.5)


def test_closures_tells_of_each_attempt(files: Path, tmp_path: Path) -> None:
    assert run(files / "first.clf", tmp_path / "plain") == 0
    assert run(files / "first.clf", tmp_path, "--closures") == 0
    assert not (tmp_path / "plain/closures.csv").exists()
    assert (tmp_path / "map.map_capnp").read_bytes() == (tmp_path / "plain/map.map_capnp").read_bytes()
    with (tmp_path / "closures.csv").open(encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    told = Counter(row["verdict"] for row in rows)
    report = report_of(tmp_path)
    assert len(rows) == report["loops"]["tried"] > 0
    refused = {reason: count for reason, count in report["loops"]["rejected"].items() if count}
    assert {reason: told[reason] for reason in set(told) - {"accepted", "contradicted"}} == refused
    accepted = [row for row in rows if row["verdict"] in ("accepted", "contradicted")]
    assert len(accepted) == report["loops"]["accepted"] > 0
    edges = load_map(str(tmp_path / "map")).switchable_edges
    switches = dict(zip(zip(edges["i"].tolist(), edges["j"].tolist(), strict=True), edges["switch"], strict=True))
    for row in accepted:
        switch = float(row["switch"])
        assert switch == pytest.approx(switches[int(row["query"]), int(row["candidate"])], abs=1e-4)
        assert (row["verdict"] == "accepted") == (switch >= 0.5)
        assert 0.0 < float(row["hit_fraction"]) <= 1.0
    with Image.open(tmp_path / "closures.png") as image:
        colours = {colour for _, colour in image.convert("RGB").getcolors(1 << 20) or []}
    assert (0, 150, 60) in colours  # the accepted


def test_max_range_takes_away_returns(files: Path, tmp_path: Path) -> None:
    for recording in ("first.clf", "first.bag"):
        for limit in (3.0, 1.4):
            assert run(files / recording, tmp_path, "--until", 10, "--max-range", limit) == 0
            map_ = load_map(str(tmp_path / "map"))
            clouds = np.vstack([map_.cloud(k) for k in range(len(map_))])
            returns = clouds[clouds[:, 2] == 1.0]
            assert limit - 0.2 < np.hypot(returns[:, 0], returns[:, 1]).max() < limit


def test_map_option_says_where_the_map_goes(files: Path, tmp_path: Path) -> None:
    out, base = tmp_path / "out", tmp_path / "maps" / "home"
    base.parent.mkdir()
    assert run(files / "first.clf", out, "--until", 5, "--map", base) == 0
    assert len(load_map(str(base))) == report_of(out)["nodes"]
    assert not list(out.glob("*capnp"))


def test_default_folder_is_named_after_the_recording(
    files: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([str(files / "first.clf"), "--until", "2", "--quiet"]) == 0
    assert (tmp_path / "oort-out" / "first" / "report.json").is_file()


def test_quiet_prints_nothing(files: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert run(files / "first.bag", tmp_path, "--until", 2) == 0
    assert capfd.readouterr() == ("", "")
    assert main([str(files / "first.bag"), "--until", "2", "--out", str(tmp_path)]) == 0
    printed = capfd.readouterr()
    assert "nodes" in printed.out
    assert "note: " in printed.err
    assert "scans" in printed.err  # the progress


def test_calls_take_effect_before_the_first_scan_that_reaches_their_time(files: Path, tmp_path: Path) -> None:
    """While paused no scan is mapped, yet each has its line in the trajectory."""
    events = write_calls(
        tmp_path / "events.json",
        [(5.0, "map/pause", []), (5.05, "graph_loc/delete", ["a", "b"]), (8.0, "map/resume_from_paused", [])],
    )
    assert run(files / "first.clf", tmp_path / "out", "--until", 20, "--events", events) == 0
    report = report_of(tmp_path / "out")
    assert report["scans"] == 201 - 30  # 5.0 to 7.9 s are not mapped
    assert len(read_tum(tmp_path / "out" / "trajectory.tum").times) == 201
    map_ = load_map(str(tmp_path / "out" / "map"))
    assert START + 8.0 in map_.cloud_times  # the first scan after a pause makes a node
    assert not ((map_.cloud_times > START + 4.95) & (map_.cloud_times < START + 7.95)).any()
    assert map_.edges["covariance"][:, 0, 0].max() == pytest.approx(0.1 * 40.0**2)


def test_calls_after_the_last_scan_are_done_too(files: Path, tmp_path: Path) -> None:
    events = write_calls(
        tmp_path / "events.json", [(1e6, "graph_loc/create_points", [["p"], [[0.5, 0.25, 0.0]], ["q"]])]
    )
    assert run(files / "first.clf", tmp_path, "--events", events) == 0
    ((name_space, name, *_),) = load_map(str(tmp_path / "map")).locations
    assert (name_space, name) == ("p", "q")


def test_mapping_may_be_started_by_a_call(files: Path, tmp_path: Path) -> None:
    events = write_calls(tmp_path / "events.json", [(3.0, "map/start", [str(tmp_path / "map")])])
    assert run(files / "first.clf", tmp_path, "--until", 10, "--events", events) == 0
    map_ = load_map(str(tmp_path / "map"))
    assert map_.cloud_times[0] == pytest.approx(START + 3.0)
    # The map begins there, and the scans before it are led back by odometry.
    poses = read_tum(tmp_path / "trajectory.tum").poses
    assert len(poses) == 101
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() < 0.1


def test_locations_are_drawn_and_saved(files: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[tuple[str, tuple[float, float, float]]] = []

    def spy(*args: Any, **kwargs: Any) -> None:
        drawn.extend(kwargs["locations"])
        write_picture(*args, **kwargs)

    monkeypatch.setattr("oort.offline.results.write_picture", spy)
    events = write_calls(
        tmp_path / "events.json",
        [(1.05, "graph_loc/create", ["dock", "dock"]), (6.0, "graph_loc/create", ["place", "sofa"])],
    )
    assert run(files / "first.clf", tmp_path, "--until", 10, "--events", events) == 0
    assert [name for name, _ in drawn] == ["dock/dock", "place/sofa"]
    poses = read_tum(tmp_path / "trajectory.tum").poses
    sensor = poses[59, :2] + 0.109 * np.array([np.cos(poses[59, 2]), np.sin(poses[59, 2])])
    assert drawn[1][1][:2] == pytest.approx(sensor, abs=0.03)  # of the last scan before the call
    assert {location[:2] for location in load_map(str(tmp_path / "map")).locations} == {
        ("dock", "dock"),
        ("place", "sofa"),
    }


def test_second_drive_goes_on_with_the_map_of_the_first(files: Path, tmp_path: Path) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    assert run(files / "first.clf", first, "--events", files / "first.events.json") == 0
    old = {suffix: (first / f"map{suffix}").read_bytes() for suffix in SUFFIXES}
    old_map = load_map(str(first / "map"))

    start = ("--resume", first / "map", "--pose", 0.15, -0.1, 0.08)  # the truth is 0, 0, 0
    events = write_calls(tmp_path / "events.json", [(1e6, "map/notify_docked", [])])
    assert run(files / "second.clf", second, *start, "--events", events) == 0
    for suffix in SUFFIXES:
        assert (first / f"map{suffix}").read_bytes() == old[suffix]
    new_map = load_map(str(second / "map"))
    n = len(old_map)
    assert len(new_map) > 1.5 * n
    np.testing.assert_allclose(new_map.node_poses[:n, :2], old_map.node_poses[:, :2], atol=0.1)
    assert new_map.locations[0][:2] == ("dock", "dock")
    assert report_of(second)["docks"]["accepted"] == 1
    across = (new_map.switchable_edges["i"] >= n) != (new_map.switchable_edges["j"] >= n)
    assert across.sum() > 10
    # The second drive's poses are in the first map's frame, whatever the start was said to be.
    poses = read_tum(second / "trajectory.tum").poses
    truth = read_tum(files / "second.truth.tum").poses
    assert len(poses) == len(truth)
    assert np.sqrt(np.mean(np.sum((poses - truth)[:, :2] ** 2, axis=1))) < 0.1


def test_a_pose_is_of_a_map_to_resume(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main([str(files / "first.clf"), "--pose", "0", "0", "0"])
    assert stopped.value.code == 2
    assert "--resume" in capsys.readouterr().err
    assert main([str(files / "first.clf"), "--resume", "somewhere"]) == 2
    assert "somewhere" in capsys.readouterr().err


def test_the_report_as_json(files: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    args = [str(files / "first.clf"), "--until", "5", "--out", str(tmp_path / "out"), "--json"]
    assert main(args) == 0
    told = capsys.readouterr()
    assert json.loads(told.out) == json.loads((tmp_path / "out" / "report.json").read_text())
    assert told.err == ""
