# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""02: maps while a robot drives: odometry and scans come from another thread, the pose can be asked for at any time."""

import sys
import threading
import time

import oort
from oort.recording import Recording


def drive(recording: Recording, live: oort.LiveMapper) -> None:
    """The drivers of a robot, which in this example play a recording."""
    for scan in recording.scans():
        live.push_scan(scan)
        live.push_odometry(scan.time, scan.odometry)
        time.sleep(0.001)


def live_loop(log_path: str, map_path: str) -> None:
    """A scan waits in the mapper until the odometry at its stamp is known."""
    recording = oort.open_recording(log_path)
    with oort.LiveMapper(sensor_on_base=recording.sensor_on_base, save_to=map_path) as live:
        robot = threading.Thread(target=drive, args=(recording, live))
        robot.start()
        robot.join()  # a planner would ask for live.pose() meanwhile
        live.save()  # the map with all that was pushed
        pose = live.pose()
    if pose is None:
        raise oort.InputError(f"{log_path}: no scan could be mapped")
    print(f"at the end the base is at {pose[0]:.2f} {pose[1]:.2f}")
    print(f"{len(live.map())} nodes")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 02_live_loop.py LOG MAP")
    try:
        live_loop(*sys.argv[1:])
    except oort.OortError as error:
        sys.exit(str(error))
