# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps that grow over sessions: pruned when they are gone on with, and by ``oort prune``."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from oort import Map, Parameters, Session
from oort.cli.main import main
from oort.evaluation.trajectories import evaluate_ate
from oort.export.tum import Trajectory
from oort.offline.trajectory import TrajectoryRecorder
from oort.recording import Scan, open_recording
from oort.saved_maps import open_map
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen


@pytest.fixture(scope="module")
def home() -> Drive:
    return simulate_drive(2, SimulationConfig(minutes=2.0))


@pytest.fixture(scope="module")
def scans(home: Drive, tmp_path_factory: pytest.TempPathFactory) -> list[Scan]:
    path = tmp_path_factory.mktemp("drive") / "home.clf"
    write_carmen(home, path)
    return list(open_recording(path).scans())


def mapped(session: Session, scans: Iterable[Scan], recorder: TrajectoryRecorder | None = None) -> None:
    for scan in scans:
        result = session.add_scan(scan)
        if recorder is not None:
            recorder.add(scan.stamp, scan.odometry, result)
    session.stop()


def grown(home: Drive, scans: list[Scan], keep_views: int) -> tuple[Session, TrajectoryRecorder]:
    """The same drive three times, each gone on with on the dock; the trajectory is of the first."""
    parameters = Parameters()
    parameters.set("keep_views", keep_views)
    mount = tuple(home.T_base_sensor.tolist())
    session, recorder = Session(parameters, mount), TrajectoryRecorder(mount)
    session.start()
    mapped(session, scans, recorder)
    session.create_location("place", "dock", (0.0, 0.0, 0.0))
    for _ in range(2):
        session.resume("", (0.0, 0.0, 0.0))
        recorder.follow(session.mapper.take_renumbering())
        mapped(session, scans)
    return session, recorder


@pytest.fixture(scope="module")
def unpruned(home: Drive, scans: list[Scan]) -> Map:
    return grown(home, scans, keep_views=0)[0].map


def ate_of(poses: np.ndarray, home: Drive) -> float:
    stamps = tuple(f"{time:.6f}" for time in home.scan_times.tolist())
    return evaluate_ate(Trajectory(stamps, poses), Trajectory(stamps, home.T_map_base)).position_rmse


def test_a_map_that_is_gone_on_with_stays_small_and_right(home: Drive, scans: list[Scan], unpruned: Map) -> None:
    session, recorder = grown(home, scans, keep_views=3)
    assert len(session.map) < 0.75 * len(unpruned)
    assert len(session.map.switchable_edges["i"]) < 0.75 * len(unpruned.switchable_edges["i"])
    assert np.hypot(*session.mapper.locate("place", "dock")[:2]) < 0.02  # type: ignore[index]
    assert ate_of(recorder.base_poses(session.map), home) < 0.02  # of the first drive, whose nodes were renumbered


def test_oort_prune(unpruned: Map, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from oort import save_map

    old, new = str(tmp_path / "old"), str(tmp_path / "new")
    save_map(old, unpruned)
    assert main(["prune", old, new]) == 0
    assert f"{old}: {len(unpruned)} nodes" in capsys.readouterr().out
    pruned = open_map(new)
    assert len(pruned) < 0.6 * len(unpruned)
    assert [place[:2] for place in pruned.locations] == [place[:2] for place in unpruned.locations]
    assert main(["prune", new, str(tmp_path / "again")]) == 0
    assert len(open_map(str(tmp_path / "again"))) == len(pruned)
    for wrong in (["prune", new, f"{new}.map_capnp"], ["prune", str(tmp_path / "none"), old]):
        assert main(wrong) == 2
        assert "oort prune: " in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["prune", old, new, "--views", "0"])
