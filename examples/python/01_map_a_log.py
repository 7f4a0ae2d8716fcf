# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""01: maps a recording, saves the map and renders it."""

import sys

import oort


def map_a_log(log_path: str, map_path: str) -> None:
    """Any recording that oort.open_recording() knows: a CARMEN log, a ROS 1 bag or a ROS 2 bag."""
    recording = oort.open_recording(log_path)
    config = oort.Config()  # the defaults; oort.Config.read(path) reads a file
    config.linear_update = 0.3
    mapper = oort.Mapper(config, recording.sensor_on_base)

    uncertain = 0
    for scan in recording.scans():
        result = mapper.add_scan(scan, scan.odometry)
        uncertain += result.tracking is not oort.TrackingState.TRACKING
    mapper.finish()
    map_ = mapper.map()
    map_.save(map_path)

    grid = map_.render(config).map_cleaned
    print(f"{recording.num_scans} scans, {uncertain} of them uncertain")
    print(f"{len(map_)} nodes, {grid.width} x {grid.height} cells")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 01_map_a_log.py LOG MAP")
    try:
        map_a_log(*sys.argv[1:])
    except oort.OortError as error:
        sys.exit(str(error))
