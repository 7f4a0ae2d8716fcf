# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""05: finds a robot on a saved map without a guess and follows it; the map does not change."""

import sys

import numpy as np

import oort


def localise(log_path: str, map_path: str) -> None:
    """The map is one that was saved before, as by 01_map_a_log.py."""
    recording = oort.open_recording(log_path)
    map_ = oort.load_map(map_path)
    localizer = oort.Localizer(map_, sensor_on_base=recording.sensor_on_base)

    known = 0
    for scan in recording.scans():
        state = localizer.add_scan(scan, scan.odometry)
        known += state is oort.LocalizationState.TRACKING
    print(f"{recording.num_scans} scans, {known} of them tracked")
    if localizer.T_map_base is None:
        raise oort.InputError("the robot was not found on the map")
    x, y, _ = localizer.T_map_base
    spread = np.sqrt(localizer.covariance[0, 0] + localizer.covariance[1, 1])
    print(f"{localizer.state}: the base is at {x:.2f} {y:.2f}, give or take {spread:.2f} m")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 05_localise.py LOG MAP")
    try:
        localise(*sys.argv[1:])
    except oort.OortError as error:
        sys.exit(str(error))
