# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finding and following a robot on the map of another drive through the same simulated home."""

import json
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from helpers.scenes import room_scan
from oort import InputError, Map, Parameters, Session, load_map, save_map
from oort.cli.localize import main
from oort.cli.replay import main as replay
from oort.export.tum import read_tum
from oort.localization import find_pose, find_start, start_pose
from oort.offline.follow import follow
from oort.poses import Array, between, compose
from oort.recording import Recording, Scan, open_recording
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.drive import first_seconds
from oort.simulate.writers import write_carmen


@dataclass(frozen=True)
class Home:
    """A mapped home with two of its drives as files: home.clf, of which the map is made, and later.clf."""

    folder: Path
    map: Map
    later: Drive

    @property
    def base(self) -> str:
        return str(self.folder / "home")


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Home:
    folder = tmp_path_factory.mktemp("home")
    first = simulate_drive(2, SimulationConfig(minutes=0.0))
    later = simulate_drive(2, SimulationConfig(minutes=0.0, way=1, moved=1))
    write_carmen(first, folder / "home.clf")
    write_carmen(later, folder / "later.clf")
    recording = open_recording(folder / "home.clf")
    session = Session(Parameters(), recording.sensor_on_base)
    session.start()
    session.create_location("dock", "dock")
    for scan in recording.scans():
        session.add_scan(scan)
    session.notify_docked()
    session.stop()
    save_map(str(folder / "home"), session.map)
    return Home(folder, session.map, later)


def scans_of(home: Home) -> tuple[Recording, list[Scan]]:
    recording = open_recording(home.folder / "later.clf")
    return recording, list(recording.scans())


def off(truth: Array, pose: Array | tuple[float, ...]) -> float:
    return float(np.hypot(*between(truth, pose)[:2]))


def test_a_pose_is_found_without_a_guess(home: Home) -> None:
    recording, scans = scans_of(home)
    found = 0
    for last in range(100, len(scans), 150):
        result = find_pose(home.map, Parameters(), scans[last - 50 : last + 1], recording.sensor_on_base)
        if not result.found:
            continue
        assert result.best is not None
        truth = compose(home.later.T_map_base[last], home.later.T_base_sensor)
        assert off(truth, result.best.T_map_sensor) < 0.1
        assert result.best.covariance.shape == (3, 3)
        assert result.best.support > 0.85
        found += 1
    assert found >= 0.7 * len(range(100, len(scans), 150))


def test_what_is_not_on_the_map_is_refused(home: Home) -> None:
    scans = [room_scan(-1.0 + 0.25 * step, 0.0, 0.0, 100.0 + step) for step in range(5)]
    assert not find_pose(home.map, Parameters(), scans).found
    with pytest.raises(InputError, match="where on the map it begins was not found"):
        find_start(home.map, Parameters(), Recording("room", "made up", (0.0, 0.0, 0.0), 5, (), lambda: iter(scans)))


def test_a_drive_is_followed(home: Home) -> None:
    recording, scans = scans_of(home)
    drive = follow(recording, scans, home.map, Parameters(), start_pose(home.map, Parameters(), "dock"))
    assert len(drive.stamps) == len(scans)
    errors = np.hypot(*(np.array(drive.base_poses) - home.later.T_map_base)[:, :2].T)
    assert np.median(errors) < 0.05
    tracking = np.array(drive.states) == "tracking"
    assert np.count_nonzero(tracking) > 0.8 * len(scans)
    assert errors[tracking].max() < 0.2
    assert sum(stretch.scans for stretch in drive.stretches) == len(scans)


def test_a_drive_with_two_lasers_is_followed(home: Home) -> None:
    """Each sees a half of what the one saw."""
    recording, scans = scans_of(home)
    mount, halves = recording.sensor_on_base, []
    for scan in scans[:300]:
        for hidden, place in ((slice(None, None, 2), mount), (slice(1, None, 2), None)):
            ranges = scan.ranges.copy()
            ranges[hidden] = np.inf
            halves.append(replace(scan, ranges=ranges, mount=place))
    drive = follow(recording, halves, home.map, Parameters(), start_pose(home.map, Parameters(), "dock"))
    errors = np.hypot(*(np.array(drive.base_poses) - home.later.T_map_base[: len(drive.base_poses)])[:, :2].T)
    assert len(drive.stamps) == 300
    assert np.median(errors) < 0.05


def test_the_same_scans_give_the_same_poses(home: Home) -> None:
    recording, scans = scans_of(home)
    first, second = (follow(recording, scans[:300], home.map, Parameters()) for _ in range(2))
    assert first.base_poses == second.base_poses
    assert first.deviations == second.deviations


def test_starts(home: Home) -> None:
    assert start_pose(home.map, Parameters(), "dock") == pytest.approx((0.0, 0.0, 0.0), abs=0.1)
    assert start_pose(home.map, Parameters(), "last") == pytest.approx(tuple(home.map.node_poses[-1]))
    session = Session(Parameters())
    session.start()
    session.add_scan(room_scan(0.0, 0.0, 0.0, 100.0))
    with pytest.raises(InputError, match="no dock"):
        start_pose(session.map, Parameters(), "dock")


def test_an_empty_map_is_an_error() -> None:
    with pytest.raises(InputError, match="empty"):
        find_pose(Session(Parameters()).map, Parameters(), [room_scan(0.0, 0.0, 0.0, 1.0)])


def test_command_line(home: Home, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {path: path.read_bytes() for path in home.folder.glob("home.*") if path.suffix != ".clf"}
    assert main([home.base, str(home.folder / "later.clf"), "--start", "dock", "--out", str(tmp_path)]) == 0
    assert "states" in capsys.readouterr().out
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["scans"] == report["scans_with_pose"] == len(home.later.scan_stamps)
    assert report["states"]["tracking"] > 0.8 * report["scans"]
    assert sum(stretch["scans"] for stretch in report["stretches"]) == report["scans"]
    trajectory = read_tum(tmp_path / "trajectory.tum")
    assert np.median(np.hypot(*(trajectory.poses - home.later.T_map_base)[:, :2].T)) < 0.05
    assert (tmp_path / "map.png").is_file()
    assert {path: path.read_bytes() for path in files} == files  # the map stays as it is


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--start", "pose"], "--start pose and --pose go together"),
        (["--pose", "0", "0", "0"], "--start pose and --pose go together"),
    ],
)
def test_wrong_calls(home: Home, options: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main([home.base, str(home.folder / "later.clf"), *options])
    assert caught.value.code == 2
    assert told in capsys.readouterr().err


def test_a_robot_that_is_not_found_is_told(home: Home, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    elsewhere = first_seconds(simulate_drive(40, SimulationConfig(minutes=0.5)), 8.0)
    write_carmen(elsewhere, tmp_path / "other.clf")
    assert main([home.base, str(tmp_path / "other.clf"), "--out", str(tmp_path)]) == 3
    told = capsys.readouterr()
    assert "the robot was not found on" in told.err and "--start pose" in told.err
    assert re.search("^deviation  +-$", told.out, re.MULTILINE)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["scans_with_pose"] == 0 and report["position_deviation"] == {"median": None, "max": None}


def test_missing_files(home: Home, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path / "no_map"), str(home.folder / "later.clf")]) == 2
    assert main([home.base, str(tmp_path / "none.clf")]) == 2
    assert capsys.readouterr().err.count("oort localize: ") == 2


def test_mapping_goes_on_from_a_found_pose(home: Home, tmp_path: Path) -> None:
    recording = str(home.folder / "later.clf")
    assert replay([recording, "--resume", home.base, "--out", str(tmp_path), "--quiet", "--until", "40"]) == 0
    map_ = load_map(str(tmp_path / "map"))
    assert len(map_) > len(home.map)
    trajectory = read_tum(tmp_path / "trajectory.tum").poses
    assert np.median(np.hypot(*(trajectory - home.later.T_map_base[: len(trajectory)])[:, :2].T)) < 0.1
