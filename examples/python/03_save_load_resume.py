# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""03: maps half of a log, saves the map, loads it and goes on with the other half in a new session."""

import sys

import oort


def save_load_resume(log_path: str, map_path: str) -> None:
    """The second session is a trajectory of its own in the same graph."""
    recording = oort.open_recording(log_path)
    scans = list(recording.scans())
    half = len(scans) // 2
    config = oort.Config()

    first = oort.Mapper(config, recording.sensor_on_base)
    for scan in scans[:half]:
        first.add_scan(scan, scan.odometry)
    first.finish()
    last_pose = first.sensor_pose
    first.map().save(map_path)
    print(f"first session: {len(first.map())} nodes")

    second = oort.Mapper(config, recording.sensor_on_base)
    second.set_map(oort.load_map(map_path))
    second.begin_session(last_pose)  # about where the sensor is on the map
    for scan in scans[half:]:
        second.add_scan(scan, scan.odometry)
    second.finish()
    map_ = second.map()
    map_.save(map_path)
    print(f"both sessions: {len(map_)} nodes, {len(map_.switchable_edges['id'])} closures")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 03_save_load_resume.py LOG MAP")
    try:
        save_load_resume(*sys.argv[1:])
    except oort.OortError as error:
        sys.exit(str(error))
