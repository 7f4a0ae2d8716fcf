# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs and calls that a replay refuses: exit code 2, a message that says what, and nothing half-written."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.recording_files import Bag, flaser
from oort.cli.replay import main

RANGES: list[float] = np.linspace(1.0, 2.0, 180).tolist()


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A short log: a robot that goes straight on for two seconds."""
    path = tmp_path / "log.clf"
    poses = [(0.05 * k, 0.0, 0.0) for k in range(21)]
    path.write_text("".join(flaser(f"{0.1 * k:.6f}", RANGES, pose) + "\n" for k, pose in enumerate(poses)))
    return path


def refuse(capsys: pytest.CaptureFixture[str], tmp_path: Path, *arguments: object) -> str:
    """Replays what must be refused; returns the message."""
    out = tmp_path / "out"
    code = main(["--out", str(out), "--map", str(out / "map"), *map(str, arguments)])
    message = capsys.readouterr().err.strip().splitlines()[-1]
    assert code == 2
    assert message.startswith("oort replay: ")
    assert not out.exists() or not list(out.iterdir())
    return message


def events(tmp_path: Path, *entries: Any) -> Path:
    path = tmp_path / "events.json"
    path.write_text(json.dumps(list(entries)))
    return path


def test_missing_file(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert "nowhere.bag" in refuse(capsys, tmp_path, tmp_path / "nowhere.bag")


@pytest.mark.parametrize("name", ["empty.bag", "empty.clf", "empty.mcap"])
def test_empty_file(capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str) -> None:
    (tmp_path / name).touch()
    assert "empty" in refuse(capsys, tmp_path, tmp_path / name)


def test_truncated_bag(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    bag = Bag()
    for k in range(50):
        bag.tf(0.1 * k, "odom", "laser", (0.01 * k, 0, 0)).scan(0.1 * k, ranges=RANGES)
    path = tmp_path / "cut.bag"
    bag.ros1(path)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])
    message = refuse(capsys, tmp_path, path)
    assert "cut.bag" in message


def test_truncated_log(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    log.write_text(log.read_text()[:-60])
    assert "line 21" in refuse(capsys, tmp_path, log)


def test_no_odometry(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    bag = Bag()
    for k in range(5):
        bag.scan(0.1 * k, ranges=RANGES)
    bag.ros1(tmp_path / "scans.bag")
    assert "odometry" in refuse(capsys, tmp_path, tmp_path / "scans.bag")


def test_no_scans(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    bag = Bag()
    for k in range(5):
        bag.odometry(0.1 * k, (0.0, 0.0, 0.0))
    bag.ros1(tmp_path / "odometry.bag")
    assert "scan" in refuse(capsys, tmp_path, tmp_path / "odometry.bag")
    (tmp_path / "odometry.clf").write_text("ODOM 0 0 0 0 0 0 1.0 host 1.0\n")
    assert "no laser scans" in refuse(capsys, tmp_path, tmp_path / "odometry.clf")


def test_scan_topic_that_is_not_there(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    assert "/front" in refuse(capsys, tmp_path, log, "--scan-topic", "/front")


@pytest.mark.parametrize("limit", ["0", "-1", "nan"])
def test_max_range_that_cannot_be(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path, limit: str) -> None:
    assert "max_range" in refuse(capsys, tmp_path, log, "--max-range", limit)


def test_bad_parameters(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    params = tmp_path / "mine.json"
    assert "mine.json" in refuse(capsys, tmp_path, log, "--params", params)
    params.write_text('{"linear_updat": 0.3}')
    message = refuse(capsys, tmp_path, log, "--params", params)
    assert "linear_updat" in message
    assert "linear_update" in message  # the nearest known key
    params.write_text('{"linear_update": "far"}')
    assert "linear_update" in refuse(capsys, tmp_path, log, "--params", params)
    params.write_text('{"output_map": {"threshold": {"max_free": 60, "min_occupied": 50}}}')
    assert "max_free" in refuse(capsys, tmp_path, log, "--params", params)


def test_unknown_call(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    calls = events(tmp_path, {"t": 0.5, "call": "map/pause"}, {"t": 1.0, "call": "map/dance", "args": []})
    message = refuse(capsys, tmp_path, log, "--events", calls)
    assert "map/dance" in message
    assert "event 1" in message
    assert "map/notify_docked" in message  # what there is


def test_call_that_the_state_does_not_allow(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    calls = events(tmp_path, {"t": 1.0, "call": "map/pause"}, {"t": 1.5, "call": "map/notify_docked"})
    message = refuse(capsys, tmp_path, log, "--events", calls)
    assert "event 1" in message
    assert "map/notify_docked" in message
    assert "paused" in message


@pytest.mark.parametrize(
    ("call", "args"),
    [
        ("map/pause", ["now"]),
        ("graph_loc/create", ["dock"]),
        ("graph_loc/create_points", [["p"], [], []]),
        ("graph_loc/create_points", [["p"], 5, ["q"]]),
        ("map/load", ["nowhere"]),
    ],
)
def test_call_with_arguments_that_do_not_fit(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path, call: str, args: list[Any]
) -> None:
    message = refuse(capsys, tmp_path, log, "--events", events(tmp_path, {"t": 1.0, "call": call, "args": args}))
    assert call in message


def test_events_file_that_cannot_be_read(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    assert "nothing.json" in refuse(capsys, tmp_path, log, "--events", tmp_path / "nothing.json")
    assert "event 0" in refuse(capsys, tmp_path, log, "--events", events(tmp_path, {"call": "map/stop"}))


def test_map_to_go_on_with_that_is_not_there(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    message = refuse(capsys, tmp_path, log, "--resume", tmp_path / "old", "--pose", 0, 0, 0)
    assert "old" in message


def test_until_before_the_first_scan(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    with pytest.raises(SystemExit):
        refuse(capsys, tmp_path, log, "--until", "-1")
    assert "--until: -1: choose a number of seconds from 0" in capsys.readouterr().err


def test_map_path_that_cannot_be_written(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    (tmp_path / "file").touch()
    message = refuse(capsys, tmp_path, log, "--map", tmp_path / "file" / "map")
    assert "file" in message


def test_results_folder_that_cannot_be_made(capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path) -> None:
    (tmp_path / "file").touch()
    assert main([str(log), "--out", str(tmp_path / "file")]) == 2
    assert "file" in capsys.readouterr().err


def test_old_results_stay_when_a_replay_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, log: Path
) -> None:
    out = tmp_path / "kept"
    assert main([str(log), "--out", str(out), "--quiet"]) == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    calls = events(tmp_path, {"t": 1.0, "call": "map/dance"})
    assert main([str(log), "--out", str(out), "--quiet", "--events", str(calls)]) == 2
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
