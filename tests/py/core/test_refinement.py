# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The final refinement on a simulated drive."""

import numpy as np
import pytest

from oort import Parameters, Session
from oort.evaluation.trajectories import alignment
from oort.poses import Array, compose
from oort.recording import Scan
from oort.simulate import Drive, SimulationConfig, simulate_drive


@pytest.fixture(scope="module")
def home() -> Drive:
    return simulate_drive(2, SimulationConfig(minutes=0.0, odometry_error=3.0))


def scans_of(drive: Drive) -> list[Scan]:
    scans = []
    for k in range(0, len(drive.scan_stamps), 2):
        time = float(drive.scan_stamps[k]) / 1e9
        limits = (drive.angle_min, drive.angle_increment, drive.range_min, drive.range_max)
        x, y, theta = drive.T_odom_base_at_scans[k]
        scans.append(Scan(drive.ranges[k], *limits, time, stamp=f"{time:.6f}", odometry=(x, y, theta)))
    return scans


def mapped(drive: Drive, final_refinement: bool) -> Session:
    parameters = Parameters()
    parameters.set("final_refinement", final_refinement)
    session = Session(parameters, (0.109, 0.0, 0.0))
    session.start()
    for scan in scans_of(drive):
        session.add_scan(scan)
    session.stop()
    return session


def node_error(session: Session, drive: Drive) -> float:
    """Root mean square, in metres, of the nodes' positions against the truth."""
    times = np.array([float(stamp) / 1e9 for stamp in drive.scan_stamps])
    truth: Array = compose(
        drive.T_map_base[np.searchsorted(times, session.map.cloud_times - 1e-6)], np.array([0.109, 0.0, 0.0])
    )
    estimate = session.map.node_poses
    errors = compose(alignment(estimate, truth), estimate)[:, :2] - truth[:, :2]
    return float(np.sqrt(np.mean(np.sum(errors**2, axis=1))))


@pytest.fixture(scope="module")
def refined(home: Drive) -> Session:
    return mapped(home, True)


def test_the_map_comes_closer_to_the_truth(home: Drive, refined: Session) -> None:
    plain = mapped(home, False)
    assert plain.mapper.statistics["refinement"]["rounds"] == 0
    assert node_error(refined, home) < node_error(plain, home) < 0.05
    counts = refined.mapper.statistics["refinement"]
    assert counts["kept"]
    assert counts["misfit"] < counts["misfit_before"]
    links = counts["links"]
    assert links["accepted"] > len(refined.map)
    assert links["tried"] == links["accepted"] + sum(links["rejected"].values())
    for edges in ("edges", "switchable_edges"):  # what was measured stays
        np.testing.assert_array_equal(getattr(refined.map, edges)["pose"], getattr(plain.map, edges)["pose"])


def test_the_same_drive_gives_the_same_poses(home: Drive, refined: Session) -> None:
    np.testing.assert_array_equal(mapped(home, True).map.node_poses, refined.map.node_poses)


def test_a_session_goes_on_after_it(home: Drive) -> None:
    session = mapped(home, True)
    before = session.map.node_poses
    session.resume("", (0.0, 0.0, 0.0))
    for scan in scans_of(home)[:100]:
        session.add_scan(scan)
    session.stop()
    after = session.map.node_poses
    assert len(after) > len(before)
    assert np.abs(after[: len(before), :2] - before[:, :2]).max() < 0.05
    assert np.hypot(*after[len(before), :2]) < 0.1
