# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A day of a robot in fast time, in one process: it drives, docks, stands, saves, loads, is localised, and goes on.

    .venv/bin/python bench/soak.py [--hours N] [--home SEED] [--out DIR]

Each hour the last map is loaded and gone on with: a drive of some minutes through one simulated home, ten scans a
second, then the dock for the rest of the hour, two scans a second, while a person walks by; then the map is stopped,
and a localiser follows the begin of the next drive on what was saved. The live session draws, and saves every 15 s of
the robot's clock. Prints a row for each hour and writes soak.json and soak.png to --out.
"""

import argparse
import itertools
import json
import os
import time
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from oort import load_map
from oort.export.chart import Panel, write_chart
from oort.live import Listener, LiveSession
from oort.localization import Localizer
from oort.parameters import read_parameters
from oort.recording import Scan
from oort.simulate import Drive, SimulationConfig, simulate_drive
from parked import RATE, memory_mb, parked_scans
from trials.drives import recording_of

WAYS = 4  # drives, one after another
THINNED = 5  # of the scans at the dock one in so many
AHEAD = 100  # scans that may wait in the queue
FOLLOWED = 300  # scans for the localiser


@dataclass(frozen=True)
class Hour:
    """The figures at the end of an hour."""

    hour: int
    nodes: int
    file_mb: float
    """with the earlier versions that are kept"""
    memory_mb: float
    files: int
    """file handles that are open"""
    threads: int
    p50_ms: float
    """to map a scan, of the last thousand"""
    p99_ms: float
    scans: int
    """since the begin"""
    left_out: int
    localised: str
    """what the localiser says at last"""
    cpu_s: float
    """of the hour"""


class Day:
    """The robot's day."""

    def __init__(self, home: int, folder: Path) -> None:
        self._folder = folder
        self._parameters = read_parameters()
        config = [SimulationConfig(odometry_error=2.0, minutes=3.0, way=way + 1) for way in range(WAYS)]
        self._drives: list[Drive] = [simulate_drive(home, one) for one in config]
        self._now = 0.0
        self.live = LiveSession(self._parameters, Listener(), clock=lambda: self._now)
        self.live.mount_sensor(recording_of(self._drives[0], "drive").sensor_on_base)

    def path(self, hour: int) -> str:
        """Of the map of an hour; the last two are kept."""
        return str(self._folder / f"map{hour % 2}")

    def run(self, hour: int) -> Hour:
        """An hour."""
        started = time.process_time()
        drive = self._drives[hour % WAYS]
        if hour == 0:
            self.live.call("map/start", [self.path(0)])
        else:
            self.live.call("map/load", [self.path(hour - 1)])
            self.live.call("map/resume", [self.path(hour), (0.0, 0.0, 0.0)])
        scans = list(recording_of(drive, "drive").scans())
        self._push(scans)
        self.live.call("map/notify_docked")
        parked = itertools.islice(parked_scans(drive, 1), 0, 3600 * RATE - len(scans), THINNED)
        self._push(parked)
        self.live.call("map/stop")
        localised = self._follow(hour)
        spread, figures = self.live.figures.milliseconds.spread, self.live.figures
        assert spread is not None
        files, threads = (len(os.listdir(f"/proc/self/{kind}")) for kind in ("fd", "task"))
        return Hour(
            hour + 1,
            self.live.snapshot.num_nodes,
            sum(path.stat().st_size for path in self._folder.glob(f"map{hour % 2}.*")) / 1e6,
            memory_mb(),
            files,
            threads,
            spread.p50,
            spread.p99,
            figures.scans_mapped,
            sum(figures.drops.counts.values()),
            localised,
            time.process_time() - started,
        )

    def _push(self, scans: Iterable[Scan]) -> None:
        before = float("nan")
        for scan in scans:
            self._now += max(0.0, scan.time - before) if before == before else 0.1
            before = scan.time
            self.live.add_scan(lambda scan=scan: scan)  # type: ignore[misc]
            while len(self.live.inbox) > AHEAD:
                time.sleep(0.002)

    def _follow(self, hour: int) -> str:
        recording = recording_of(self._drives[(hour + 1) % WAYS], "drive")
        localizer = Localizer(load_map(self.path(hour)), self._parameters, recording.sensor_on_base)
        for scan in itertools.islice(recording.scans(), FOLLOWED):
            localizer.add_scan(scan, scan.odometry)
        return str(localizer.state)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=int, default=24)
    parser.add_argument("--home", type=int, default=3, metavar="SEED")
    parser.add_argument("--out", type=Path, default=Path("oort-out/soak"), metavar="DIR")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    day, hours = Day(arguments.home, arguments.out.absolute()), list[Hour]()
    names = [field.name for field in fields(Hour)]
    print(_row(names), _row(["---"] * len(names)), sep="\n", flush=True)
    for hour in range(arguments.hours):
        hours.append(day.run(hour))
        print(_row(list(asdict(hours[-1]).values())), flush=True)
    day.live.close()
    (arguments.out / "soak.json").write_text(json.dumps([asdict(hour) for hour in hours], indent=1) + "\n")
    shown = {
        "memory [MB]": "memory_mb",
        "file handles": "files",
        "threads": "threads",
        "nodes": "nodes",
        "P50 of mapping a scan [us]": "p50_ms",
        "P99 of mapping a scan [us]": "p99_ms",
    }
    edges = [float(hour.hour) for hour in hours]
    values = {title: [float(getattr(hour, name)) for hour in hours] for title, name in shown.items()}
    panels = [Panel(title, edges, [1e3 * v if "us" in title else v for v in row]) for title, row in values.items()]
    write_chart(arguments.out / "soak.png", panels)


def _row(values: Sequence[object]) -> str:
    return "| " + " | ".join(f"{v:.2f}" if isinstance(v, float) else str(v) for v in values) + " |"


if __name__ == "__main__":
    main()
