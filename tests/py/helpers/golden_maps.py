# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The golden maps of tests/py/data/maps: what a map says, and how they are made.

python tests/py/helpers/golden_maps.py FOLDER    writes FOLDER/format_<version>, in the newest format
python tests/py/helpers/golden_maps.py FOLDER --original    writes FOLDER/format_0, in that of the original Oort
"""

import hashlib
import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from oort import Map, Session, _core, read_parameters, save_map
from oort.recording import open_recording
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.sensor import Sensor
from oort.simulate.writers import write_carmen

SEED = 2
BEAMS = 24
PAUSE_AFTER = 0.6  # of the scans: the robot is carried a little, which makes a second chain


def describe(map_: Map) -> dict[str, Any]:
    """All that a map says. Arrays as their shape and a checksum of their numbers, poses and places in full."""
    tables = {
        "edges": map_.edges,
        "switchable_edges": map_.switchable_edges,
        "incremental_results": map_.incremental_results,
        "loop_results": map_.loop_results,
    }
    arrays = {
        f"{table}.{name}": _digest(column) for table, columns in tables.items() for name, column in columns.items()
    }
    arrays["cloud_times"] = _digest(map_.cloud_times)
    arrays["clouds"] = _digest(np.concatenate([map_.cloud(k) for k in range(len(map_))]))
    arrays["cloud_sizes"] = _digest([len(map_.cloud(k)) for k in range(len(map_))])
    return {
        "node_poses": map_.node_poses.tolist(),
        "switches": map_.switchable_edges["switch"].tolist(),
        "locations": [[space, id, node, list(pose)] for space, id, node, pose in map_.locations],
        "arrays": arrays,
    }


def _digest(values: ArrayLike) -> list[Any]:
    numbers = np.asarray(values, dtype="<f8")
    plain = np.where(np.isnan(numbers), np.nan, numbers)  # there are many nan, which are all the same here
    return [list(plain.shape), hashlib.sha256(np.ascontiguousarray(plain).tobytes()).hexdigest()]


def make_map() -> Map:
    """A drive through a small home with a pause, places and a dock closure, coarse so that the files stay small."""
    config = SimulationConfig(sensor=Sensor(beams=BEAMS), minutes=0.0)
    parameters = read_parameters()
    parameters.set("linear_update", 0.5)
    parameters.set("angular_update", 1.2)
    with tempfile.TemporaryDirectory() as scratch:
        write_carmen(simulate_drive(SEED, config), Path(scratch) / "home.clf")
        recording = open_recording(Path(scratch) / "home.clf")
        scans = list(recording.scans())
    session = Session(parameters, recording.sensor_on_base)
    session.start()
    for number, scan in enumerate(scans):
        if number == int(PAUSE_AFTER * len(scans)):
            session.create_location("rooms", "Küche")
            session.pause()
            session.resume_from_paused()
        session.add_scan(scan)
        if number == 0:
            session.create_location("dock", "dock")
    session.notify_docked()
    session.stop()
    return session.map


def main() -> None:
    """Writes a golden map, and what it says."""
    original = "--original" in sys.argv
    folder = Path(sys.argv[1]) / f"format_{0 if original else _core.FORMAT_VERSION}"
    folder.mkdir(parents=True)
    map_ = make_map()
    save_map(str(folder / "home"), map_, as_original=original)
    expected = json.dumps(describe(map_), indent=1, ensure_ascii=False)
    (folder / "expected.json").write_text(expected + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
