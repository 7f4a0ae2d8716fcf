# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How well the rooms of simulated homes are found: their number, areas and outlines against the true ones."""

import argparse
import tempfile
from pathlib import Path

import numpy as np
from shapely.geometry import Polygon

from oort import Parameters, open_recording, replay
from oort.offline.export import rooms_of
from oort.simulate import simulate_drive
from oort.simulate.writers import write_carmen


def measure(seed: int) -> tuple[int, int, list[tuple[float, float]]]:
    """How many rooms were found and are true; of each true one, the error of its area (a share) and the overlap."""
    drive = simulate_drive(seed=seed)
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "home.clf"
        write_carmen(drive, log)
        found = [Polygon(named.room.outline) for named in rooms_of(replay(open_recording(log)).map, Parameters())]
    rows = []
    for room in drive.home.rooms:
        true = Polygon(room.corners)
        overlaps = [other.intersection(true).area / other.union(true).area for other in found]
        best = int(np.argmax(overlaps)) if overlaps else -1
        rows.append((found[best].area / true.area - 1.0, overlaps[best]) if overlaps else (-1.0, 0.0))
    return len(found), len(drive.home.rooms), rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", nargs=2, type=int, default=(19, 43), metavar=("FROM", "TO"))
    args = parser.parse_args()
    right, rows = 0, []
    for seed in range(*args.seeds):
        found, true, errors = measure(seed)
        right += found == true
        rows += errors
        print(f"home {seed}: {found} rooms of {true}", flush=True)
    area, overlap = np.abs(np.array(rows)).T
    print(f"right number of rooms in {right} of {args.seeds[1] - args.seeds[0]} homes")
    print(f"of {len(rows)} rooms {(area < 0.03).sum()} within 3 % of the area, {(overlap > 0.9).sum()} overlap by 0.9")


if __name__ == "__main__":
    main()
