# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""04: names places while mapping, takes the dock as an anchor, and shows that places move with the map."""

import sys

import oort


def print_place(when: str, pose: tuple[float, float, float] | None) -> None:
    """Where it is; None would say that there is no such place."""
    assert pose is not None
    print(f"{when} the place is at {pose[0]:.3f} {pose[1]:.3f}")


def places_and_dock(log_path: str, map_path: str) -> None:
    """The drive of the log begins and ends at the dock."""
    recording = oort.open_recording(log_path)
    mapper = oort.Mapper(sensor_on_base=recording.sensor_on_base)
    for k, scan in enumerate(recording.scans()):
        mapper.add_scan(scan, scan.odometry)
        if k == 0:
            mapper.create_location("dock", "dock", mapper.sensor_pose)  # the drive begins at the dock
        if k == recording.num_scans // 2:
            mapper.create_location("places", "middle", mapper.sensor_pose)
    print_place("while driving", mapper.locate("places", "middle"))

    fits = mapper.notify_docked()  # and ends there
    mapper.finish()
    print(f"what is seen at the dock {'fits' if fits else 'does not fit'} the map")
    print_place("at the end", mapper.locate("places", "middle"))

    mapper.map().save(map_path)
    map_ = oort.load_map(map_path)
    print_place("in the saved map", map_.locate("places", "middle"))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 04_places_and_dock.py LOG MAP")
    try:
        places_and_dock(*sys.argv[1:])
    except oort.OortError as error:
        sys.exit(str(error))
