# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Merging maps of two drives through the same simulated home, and sessions that go on with a map."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from oort import InputError, Map, Parameters, Session, load_map, read_parameters, save_map
from oort.cli.merge import main
from oort.evaluation.trajectories import alignment, evaluate_relations
from oort.export.tum import Trajectory
from oort.localization import find_pose
from oort.offline.merge import merge, merge_maps
from oort.offline.trajectory import TrajectoryRecorder
from oort.poses import Array, between, compose
from oort.recording import Scan, open_recording
from oort.simulate import Drive, SimulationConfig, simulate_drive

SUFFIXES = (".map_capnp", ".map_meta_capnp", ".md5")


@dataclass(frozen=True)
class Mapped:
    """A drive, its scans, and its map with the path where it is saved."""

    drive: Drive
    scans: list[Scan]
    map: Map
    path: str

    @property
    def mount(self) -> tuple[float, float, float]:
        x, y, theta = self.drive.T_base_sensor.tolist()
        return x, y, theta


def scans_of(drive: Drive, range_max: float) -> list[Scan]:
    sensor = drive.angle_min, drive.angle_increment, drive.range_min, range_max
    odometry = drive.T_odom_base_at_scans.tolist()
    return [
        Scan(ranges, *sensor, time, stamp=f"{time:.6f}", odometry=(x, y, theta))
        for time, ranges, (x, y, theta) in zip(drive.scan_times.tolist(), drive.ranges, odometry, strict=True)
    ]


def map_scans(scans: Sequence[Scan], mount: tuple[float, float, float]) -> Map:
    session = Session(Parameters(), mount)
    session.start()
    for scan in scans:
        session.add_scan(scan)
    session.stop()
    return session.map


def map_drive(seed: int, way: int, path: Path) -> Mapped:
    drive = simulate_drive(seed, SimulationConfig(minutes=0.0, way=way))
    x, y, theta = drive.T_base_sensor.tolist()
    session = Session(Parameters(), (x, y, theta))
    session.start()
    session.create_location("dock", "dock")
    scans = scans_of(drive, drive.range_max)
    for scan in scans:
        session.add_scan(scan)
    session.stop()
    save_map(str(path), session.map)
    return Mapped(drive, scans, session.map, str(path))


@pytest.fixture(scope="module")
def maps(tmp_path_factory: pytest.TempPathFactory) -> list[Mapped]:
    """Two drives through one home."""
    folder = tmp_path_factory.mktemp("maps")
    return [map_drive(2, way, folder / name) for way, name in ((0, "first"), (1, "second"))]


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory) -> Mapped:
    """A drive through another home."""
    return map_drive(3, 0, tmp_path_factory.mktemp("other") / "other")


def truth_of(map_: Map, drive: Drive) -> Array:
    """T_map_sensor (N, 3) of each node as it is."""
    scans = np.searchsorted(drive.scan_times, map_.cloud_times - 1e-4)
    return compose(drive.T_map_base[scans], drive.T_base_sensor)


def ate(poses: Array, truth: Array) -> float:
    aligned = compose(alignment(poses, truth), poses)
    return float(np.sqrt(np.mean(np.sum((aligned - truth)[:, :2] ** 2, axis=1))))


def files_of(path: str) -> dict[str, bytes]:
    return {suffix: Path(path + suffix).read_bytes() for suffix in SUFFIXES}


def merged_errors(first: Mapped, second: Mapped, map_: Map) -> list[float]:
    truths = [truth_of(mapped.map, mapped.drive) for mapped in (first, second)]
    pairs = ((first.map, truths[0]), (second.map, truths[1]), (map_, np.concatenate(truths)))
    return [ate(map_.node_poses, truth) for map_, truth in pairs]


@pytest.fixture(scope="module")
def merged(maps: list[Mapped]) -> tuple[str, str]:
    """Where the two maps are merged, and what was told of it."""
    path = str(Path(maps[0].path).with_name("both"))
    return path, "\n".join(merge(maps[0].path, maps[1].path, path, Parameters()))


def test_two_maps_become_one(maps: list[Mapped], merged: tuple[str, str]) -> None:
    path, told = merged
    assert "at the dock" in told
    assert "closures across" in told
    assert "place dock/dock: the first map's is kept" in told
    map_ = load_map(path)
    assert [(space, id) for space, id, *_ in map_.locations] == [("dock", "dock")]
    whole = merge_maps(maps[0].map, maps[1].map, Parameters()).map
    of_first, of_second, of_both = merged_errors(maps[0], maps[1], whole)
    assert of_both < max(of_first, of_second) + 0.005


def test_what_both_maps_show_often_is_left_out(maps: list[Mapped], tmp_path: Path) -> None:
    sizes = []
    for views in (0, 3, 1):
        parameters = Parameters()
        parameters.set("keep_views", views)
        path = str(tmp_path / f"views{views}")
        told = list(merge(maps[0].path, maps[1].path, path, parameters))
        map_ = load_map(path)
        assert any(line.startswith("left out") for line in told) == (views > 0)
        assert [(space, id) for space, id, *_ in map_.locations] == [("dock", "dock")]
        sizes.append(len(map_))
    assert sizes[0] == len(maps[0].map) + len(maps[1].map)
    assert sizes[2] < sizes[1] < 0.8 * sizes[0]


def test_the_command_does_the_same_to_the_byte(
    maps: list[Mapped], merged: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, told = merged
    before = files_of(maps[0].path), files_of(maps[1].path)
    assert main([maps[0].path, maps[1].path, str(tmp_path / "home")]) == 0
    assert capsys.readouterr().out.replace(str(tmp_path / "home"), path) == told + "\n"
    assert files_of(str(tmp_path / "home"))[".map_capnp"] == files_of(path)[".map_capnp"]
    assert (tmp_path / "home.png").read_bytes() == Path(path + ".png").read_bytes()
    assert (files_of(maps[0].path), files_of(maps[1].path)) == before


def test_all_is_told_though_the_picture_cannot_be_written(
    maps: list[Mapped], merged: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, told = merged
    (tmp_path / "home.png").mkdir()
    assert main([maps[0].path, maps[1].path, str(tmp_path / "home")]) == 2
    out, err = capsys.readouterr()
    assert out.replace(str(tmp_path / "home"), path).splitlines() == told.splitlines()[:-1]
    assert "home.png cannot be written" in err
    assert files_of(str(tmp_path / "home"))[".map_capnp"] == files_of(path)[".map_capnp"]


def test_what_is_being_done_is_told_before(
    maps: list[Mapped], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("oort.offline.merge.merge_maps", interrupted)
    assert main([maps[0].path, maps[1].path, str(tmp_path / "home")]) == 130
    out, err = capsys.readouterr()
    assert "looking for where the second map lies" in out
    assert err == "oort merge: interrupted\n"
    assert not list(tmp_path.iterdir())


def test_a_merged_map_is_a_map_like_any_other(maps: list[Mapped], merged: tuple[str, str]) -> None:
    second = maps[1]
    map_ = load_map(merged[0])
    found = find_pose(map_, Parameters(), second.scans[250:301], second.mount)
    truth = compose(second.drive.T_map_base[300], second.drive.T_base_sensor)
    assert found.found, found.rejection
    assert found.best is not None
    assert np.hypot(*(np.array(found.best.T_map_sensor) - truth)[:2]) < 0.1
    session = Session(Parameters(), second.mount)
    session.load(merged[0])
    session.resume("", found.best.T_map_sensor)
    begin = session.mapper.num_nodes  # resuming pruned what both maps show
    for scan in second.scans[300:500]:
        session.add_scan(scan)
    session.stop()
    edges = session.map.switchable_edges
    assert np.count_nonzero((edges["i"] >= begin) & (edges["j"] < begin)) > 5


def test_found_without_a_dock_and_in_another_frame(maps: list[Mapped]) -> None:
    first, second = maps
    begin = len(second.scans) // 3
    part = map_scans(second.scans[begin:], second.mount)  # its origin is where it begins
    merged = merge_maps(first.map, part, Parameters())
    assert merged.found_by == "search"
    starts = [
        compose(mapped.drive.T_map_base[scan], mapped.drive.T_base_sensor)
        for mapped, scan in ((first, 0), (second, begin))
    ]
    assert np.hypot(*(np.array(merged.T_a_b) - between(*starts))[:2]) < 0.1
    assert merged_errors(first, Mapped(second.drive, [], part, ""), merged.map)[2] < 0.03


def test_a_sensor_that_sees_less_far_and_an_old_format(maps: list[Mapped], tmp_path: Path) -> None:
    first, second = maps
    near = map_scans(scans_of(second.drive, 2.2)[: len(second.scans) // 2], second.mount)
    save_map(str(tmp_path / "near"), near, as_original=True)
    merged = merge_maps(first.map, load_map(str(tmp_path / "near")), Parameters())
    assert merged_errors(first, Mapped(second.drive, [], near, ""), merged.map)[2] < 0.05


def test_a_map_of_another_home_is_refused(
    maps: list[Mapped], other: Mapped, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([maps[0].path, other.path, str(tmp_path / "home")]) == 2
    told = capsys.readouterr().err
    assert "no place where the second map fits the first" in told
    assert "--at X Y THETA" in told
    assert main([maps[0].path, other.path, str(tmp_path / "home"), "--at", "0", "0", "0"]) == 2
    assert not list(tmp_path.iterdir())


def test_calls_that_cannot_be_used(maps: list[Mapped], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second = maps
    broken, cut = tmp_path / "broken", tmp_path / "cut"
    for suffix in SUFFIXES:
        data = Path(second.path + suffix).read_bytes()
        Path(str(broken) + suffix).write_bytes(data[: len(data) // 2])
        Path(str(cut) + suffix).write_bytes(data[: len(data) // 2] if suffix == ".map_capnp" else data)
    calls: list[tuple[list[str], str]] = [
        ([first.path, first.path + ".map_capnp", str(tmp_path / "x")], "both maps are the same one"),
        ([first.path, second.path, first.path], "would replace one of the two"),
        ([first.path, str(tmp_path / "none"), str(tmp_path / "x")], "none"),
        ([first.path, str(broken), str(tmp_path / "x")], "broken"),
        ([first.path, str(cut), str(tmp_path / "x")], "cut.map_capnp"),
        ([str(cut), second.path, str(tmp_path / "x")], "oort.load_map(path, ignore_checksum=True)"),
        ([first.path, second.path, str(tmp_path / "x"), "--at", "1e7", "-1e-3", "0"], "check X Y THETA"),
    ]
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    for arguments, told in calls:
        assert main(arguments) == 2
        assert told in capsys.readouterr().err
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_maps_that_share_scans_are_refused(maps: list[Mapped]) -> None:
    session = Session(Parameters(), maps[0].mount)
    session.load(maps[0].path)
    session.resume("", (0.0, 0.0, 0.0))
    for scan in maps[1].scans[:100]:
        session.add_scan(scan)
    session.stop()
    with pytest.raises(InputError, match="scans are in the first map, too"):
        merge_maps(maps[0].map, session.map, Parameters())


def halves(mapped: Mapped) -> tuple[list[Scan], list[Scan]]:
    middle = len(mapped.scans) // 2
    return mapped.scans[:middle], mapped.scans[middle:]


def test_two_sessions_are_as_good_as_one(maps: list[Mapped], tmp_path: Path) -> None:
    mapped = maps[0]
    first, second = halves(mapped)
    half = map_scans(first, mapped.mount)
    save_map(str(tmp_path / "half"), half)
    x, y, theta = compose(half.node_poses[-1], (0.3, -0.2, 0.1)).tolist()  # told roughly
    session = Session(Parameters(), mapped.mount)
    session.load(str(tmp_path / "half"))
    session.resume("", (x, y, theta))
    for scan in second:
        session.add_scan(scan)
    session.stop()
    map_ = session.map
    edges = map_.switchable_edges
    across = (edges["i"] >= len(half)) != (edges["j"] >= len(half))
    assert np.count_nonzero(across & (edges["switch"] >= 0.5)) > 10
    whole = ate(mapped.map.node_poses, truth_of(mapped.map, mapped.drive))
    assert ate(map_.node_poses, truth_of(map_, mapped.drive)) < whole + 0.005


def merged_halves(
    scans: tuple[Sequence[Scan], Sequence[Scan]], mount: tuple[float, float, float]
) -> tuple[Trajectory, Map]:
    """The trajectory of a drive whose halves were mapped apart and merged."""
    sessions, recorders = [], []
    for half in scans:
        session, recorder = Session(Parameters(), mount), TrajectoryRecorder(mount)
        session.start()
        for scan in half:
            recorder.add(scan.stamp, scan.odometry, session.add_scan(scan))
        session.stop()
        sessions.append(session)
        recorders.append(recorder)
    merged = merge_maps(sessions[0].map, sessions[1].map, Parameters())
    map_ = merged.map
    poses = [recorders[0].base_poses(map_), recorders[1].base_poses(map_, merged.first_node_b)]
    return Trajectory((*recorders[0].stamps, *recorders[1].stamps), np.concatenate(poses)), map_


def test_merged_halves_are_as_good_as_the_whole(maps: list[Mapped]) -> None:
    mapped = maps[0]
    trajectory, map_ = merged_halves(halves(mapped), mapped.mount)
    whole = ate(mapped.map.node_poses, truth_of(mapped.map, mapped.drive))
    assert ate(map_.node_poses, truth_of(map_, mapped.drive)) < whole + 0.005
    assert len(trajectory.stamps) == len(mapped.scans)
    assert ate(trajectory.poses, mapped.drive.T_map_base) < whole + 0.01


@pytest.mark.slow
def test_maps_of_different_homes_are_never_joined(tmp_path: Path) -> None:
    homes = [map_drive(seed, 0, tmp_path / str(seed)) for seed in range(1, 6)]
    for a in homes:
        for b in homes:
            if a is not b:
                with pytest.raises(InputError, match="place"):
                    merge_maps(a.map, b.map, Parameters())


@pytest.mark.slow
def test_merged_halves_of_a_log(datasets: Path) -> None:
    recording = open_recording(datasets / "radish/fr079.clf.bz2")
    scans = list(recording.scans())
    middle = len(scans) // 2
    trajectory, _ = merged_halves((scans[:middle], scans[middle:]), recording.sensor_on_base)
    result = evaluate_relations(trajectory, datasets / "radish/fr079.relations")
    assert result.translation_mean < 0.031  # of the whole drive 0.0302
    assert result.rotation_mean < 0.45


@pytest.mark.slow
def test_every_shipped_matcher_merges(maps: list[Mapped]) -> None:
    for name in ("kuri_original", "cartographer"):
        parameters = read_parameters(str(ROOT / "params" / f"{name}.json"))
        merged = merge_maps(maps[0].map, maps[1].map, parameters)
        assert merged.closures_kept > 10
        assert merged_errors(maps[0], maps[1], merged.map)[2] < 0.1
