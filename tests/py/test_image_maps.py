# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A robot is found and followed on a map_server picture."""

from pathlib import Path

import numpy as np
import pytest

from oort import Localizer
from oort.errors import InputError
from oort.export.map_server import GridMap
from oort.image_maps import map_of_image, open_reference_map
from oort.offline.replay import replay
from oort.offline.results import write_results
from oort.poses import between
from oort.recording import open_recording
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen


def test_a_drive_is_followed_on_the_picture_of_another(tmp_path: Path) -> None:
    write_carmen(simulate_drive(7, SimulationConfig()), tmp_path / "first.clf")
    write_results(replay(open_recording(tmp_path / "first.clf")), tmp_path / "out", str(tmp_path / "out" / "map"))
    drive = simulate_drive(7, SimulationConfig(minutes=0.5, way=3))
    write_carmen(drive, tmp_path / "second.clf")
    recording = open_recording(tmp_path / "second.clf")
    localizer = Localizer(open_reference_map(str(tmp_path / "out" / "map.yaml")), None, recording.sensor_on_base)
    errors = []
    for scan, truth in zip(recording.scans(), drive.T_map_base, strict=True):
        localizer.add_scan(scan, scan.odometry)
        if localizer.T_map_base is not None:
            errors.append(float(np.hypot(*between(truth, localizer.T_map_base)[:2])))
    assert localizer.state == "tracking"
    assert len(errors) > 0.8 * len(drive.T_map_base)
    assert np.median(errors) < 0.05
    assert max(errors) < 0.3


def test_the_frame_is_the_picture_s() -> None:
    cells = np.zeros((40, 60), dtype=np.int8)
    cells[[0, -1]], cells[:, [0, -1]] = 100, 100
    map_ = map_of_image(GridMap(cells, 0.1, (5.0, -2.0, np.pi / 2)))
    cloud, pose = map_.clouds[0], map_.node_poses[0]
    x = pose[0] + np.cos(pose[2]) * cloud[:, 0] - np.sin(pose[2]) * cloud[:, 1]
    y = pose[1] + np.sin(pose[2]) * cloud[:, 0] + np.cos(pose[2]) * cloud[:, 1]
    assert (x.min(), x.max()) == pytest.approx((1.0, 5.0), abs=0.11)
    assert (y.min(), y.max()) == pytest.approx((-2.0, 4.0), abs=0.11)


@pytest.mark.parametrize(("value", "message"), [(100, "no free cell"), (0, "no occupied cell in view")])
def test_a_picture_of_nothing_is_refused(value: int, message: str) -> None:
    with pytest.raises(InputError, match=message):
        map_of_image(GridMap(np.full((20, 20), value, dtype=np.int8), 0.1, (0.0, 0.0, 0.0)))
