# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What mapping learns of the laser from its scans: the order of its beams, and which of them see the robot."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from oort import Localizer, Mapper, Parameters
from oort.evaluation.trajectories import alignment
from oort.offline.replay import replay
from oort.offline.results import Drive as Replayed
from oort.poses import compose
from oort.recording import open_recording
from oort.simulate import Drive, Sensor, SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag

AROUND = Sensor(field_of_view=2.0 * math.pi, beams=180, range_max=6.0, sweep_seconds=0.1)


def simulated(driver: str = "true", body: float = 0.0, sensor: Sensor = AROUND) -> Drive:
    sensor = Sensor(
        sensor.field_of_view,
        sensor.beams,
        range_max=sensor.range_max,
        sweep_seconds=sensor.sweep_seconds,
        driver=driver,
        body=body,
    )
    return simulate_drive(7, SimulationConfig(sensor, minutes=0.5))


def replayed(drive: Drive, folder: Path, **values: bool | str) -> Replayed:
    path = folder / "drive.bag"
    write_bag(drive, path)
    parameters = Parameters()
    for name, value in values.items():
        parameters.set(name, value)
    return replay(open_recording(path, parameters=parameters), parameters)


def error(drive: Drive, made: Replayed) -> float:
    """RMSE of the position [m] after the best rigid motion."""
    told: NDArray[np.float64] = made.recorder.base_poses(made.map)
    truth = drive.T_map_base[: len(told)]
    off = compose(alignment(told, truth), told)[:, :2] - truth[:, :2]
    return float(np.sqrt((off**2).sum(axis=1).mean()))


# ---- the order of beams ----


def test_a_clockwise_laser_whose_driver_keeps_the_times_is_told_and_mapped(tmp_path: Path) -> None:
    drive = simulated("turned-round")
    made = replayed(drive, tmp_path)
    found = made.session.mapper.statistics["laser"]["beam_order"]
    assert (found["order"], found["decided"]) == ("reversed", True)
    assert found["costs"]["reversed"] < 0.8 * min(found["costs"]["stamped"], found["costs"]["at_once"])
    assert error(drive, made) < 0.02


def test_the_order_can_be_given(tmp_path: Path) -> None:
    drive = simulated("turned-round")
    worst = error(drive, replayed(drive, tmp_path, beam_order="stamped"))
    assert worst > 0.1
    (tmp_path / "drive.bag").unlink()
    assert error(drive, replayed(drive, tmp_path, beam_order="reversed")) < 0.02


def test_a_true_driver_is_believed(tmp_path: Path) -> None:
    drive = simulated()
    made = replayed(drive, tmp_path)
    found = made.session.mapper.statistics["laser"]["beam_order"]
    assert (found["order"], found["decided"]) == ("stamped", True)
    assert error(drive, made) < 0.02


# ---- the robot's own body ----

WIDE = Sensor()


@pytest.mark.parametrize("degrees", [5, 20])
def test_beams_that_see_the_robot_are_found_and_left_out(tmp_path: Path, degrees: int) -> None:
    drive = simulated(body=math.radians(degrees), sensor=WIDE)
    made = replayed(drive, tmp_path)
    right, left = made.session.mapper.statistics["laser"]["body"]
    assert right[:2] == pytest.approx((-math.pi / 2, -math.pi / 2 + math.radians(degrees - 1)), abs=0.01)
    assert left[:2] == pytest.approx((math.pi / 2 - math.radians(degrees), math.pi / 2 - math.radians(1)), abs=0.01)
    assert right[2] == pytest.approx(0.16, abs=0.01)
    assert error(drive, made) < 0.02
    for cloud in made.map.clouds:  # those from before it was known, too
        returns = cloud[cloud[:, 2] == 1.0]
        assert np.hypot(returns[:, 0], returns[:, 1]).min() > 0.2


def test_the_body_can_be_left_in(tmp_path: Path) -> None:
    made = replayed(simulated(body=math.radians(5), sensor=WIDE), tmp_path, find_body=False)
    assert made.session.mapper.statistics["laser"]["body"] == []


def test_a_localiser_leaves_the_body_out_too(tmp_path: Path) -> None:
    clean = replayed(simulated(sensor=WIDE), tmp_path)
    (tmp_path / "drive.bag").unlink()
    drive = simulated(body=math.radians(20), sensor=WIDE)
    write_bag(drive, tmp_path / "body.bag")
    recording = open_recording(tmp_path / "body.bag")
    localizer = Localizer(clean.map, None, recording.sensor_on_base)
    localizer.start_at((0.0, 0.0, 0.0), 0.01 * np.eye(3))
    for scan in recording.scans():
        localizer.add_scan(scan, scan.odometry)
    assert localizer.state == "tracking"
    assert localizer.support > 0.8


def test_walls_along_the_way_are_no_body(tmp_path: Path) -> None:
    corridor = simulate_drive(3, SimulationConfig(scene="corridor-return"))
    made = replayed(corridor, tmp_path)
    assert made.session.mapper.statistics["laser"]["body"] == []


def test_a_new_map_learns_the_laser_anew() -> None:
    mapper = Mapper()
    assert mapper.statistics["laser"] == {
        "beam_order": {
            "order": "stamped",
            "decided": False,
            "tests": 0,
            "costs": {"stamped": 0.0, "reversed": 0.0, "at_once": 0.0},
        },
        "body": [],
        "repeated_scans": 0,
    }
