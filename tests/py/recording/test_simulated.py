# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated drive reads the same from its bag and from its CARMEN log."""

from pathlib import Path

import numpy as np

from oort.poses import between
from oort.recording import open_recording
from oort.simulate import Drive
from oort.simulate.writers import write_drive


def test_bag_and_carmen_log_agree(drive: Drive, tmp_path: Path) -> None:
    write_drive(drive, tmp_path, "home", picture=False)
    bag, log = open_recording(tmp_path / "home.bag"), open_recording(tmp_path / "home.clf")
    np.testing.assert_allclose(bag.sensor_on_base, log.sensor_on_base, atol=1e-5)
    assert bag.num_scans == log.num_scans == len(drive.scan_stamps)
    for one, other in zip(bag.scans(), log.scans(), strict=True):
        assert round(one.time, 6) == round(other.time, 6)
        np.testing.assert_allclose(between(one.odometry, other.odometry), 0.0, atol=1e-5)
        assert one.angle_min == float(np.float32(other.angle_min))
        assert one.angle_increment == float(np.float32(other.angle_increment))
        seen = one.ranges < one.range_max
        np.testing.assert_array_equal(seen, other.ranges < other.range_max)
        np.testing.assert_allclose(one.ranges[seen], other.ranges[seen], atol=0.006)  # the log has two decimals
