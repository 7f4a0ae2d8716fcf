# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Many short drives in one table: `oort batch` here, then on a Dask cluster of two workers, one of them killed.

    .venv/bin/python bench/fleet.py --keep DIR [--drives N] [--seconds S] [--jobs N] [--no-cluster]

Each drive leads through a home of its own for its first S seconds. Told are drives a core hour, how much of that is
mapping (the rest: starting a process, reading the bag, writing results), and whether both ways give the same bytes.
What is in DIR already is not made again.
"""

import argparse
import hashlib
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from oort.offline.batch import make_jobs, run_batch
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.drive import first_seconds
from oort.simulate.writers import write_drive
from trials.workers import Failure, run_all

_MAPS = ("map.map_capnp", "trajectory.tum", "map.pgm")
"""what must be the same bytes; reports tell times"""


def make_drive(folder: Path, seed: int, seconds: float) -> None:
    """One recording, a lone MCAP; none if it is there."""
    name = f"home_{seed:04}"
    if not (folder / f"{name}.mcap").exists():
        drive = first_seconds(simulate_drive(seed, SimulationConfig(minutes=0.0)), seconds)
        write_drive(drive, folder, name, picture=False, formats=("mcap",))


def run(recordings: list[str], out: Path, jobs: int, cluster: str | None, after: dict[int, Any]) -> dict[str, Any]:
    """Maps all; ``after`` has what is done once so many are mapped."""
    started, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    failed, figures, kept = [], [], 0
    for count, outcome in enumerate(run_batch(make_jobs(recordings, out), jobs, cluster), start=1):
        kept += outcome.kept
        if outcome.error is None:
            figures.append(outcome.figures)
        else:
            failed.append(f"{outcome.recording}: {outcome.error}")
        after.pop(count, lambda: None)()
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = spent.ru_utime + spent.ru_stime - before.ru_utime - before.ru_stime
    return {
        "drives": len(recordings),
        "kept": kept,
        "failed": failed,
        "wall_seconds": time.monotonic() - started,
        "cpu_seconds": cpu if cluster is None else None,  # the workers' is not ours to count
        "mapping_cpu_seconds": sum(each["cpu_seconds"] for each in figures),
        "recorded_seconds": sum(each["recorded_seconds"] for each in figures),
        "uncertain": sum(each["uncertain"] > 0.5 for each in figures),
    }


@contextmanager
def two_workers(folder: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler with two worker processes on loopback; the folder is for the scheduler's file."""
    place = folder / "scheduler.json"
    place.unlink(missing_ok=True)

    def start(name: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.{name}", "--scheduler-file", str(place), "--no-dashboard"]
        return subprocess.Popen([*command, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    scheduler = start("dask_scheduler", "--host", "127.0.0.1", "--port", "0")
    workers = [start("dask_worker", "--nthreads", "1", "--no-nanny") for _ in range(2)]
    while not place.is_file() or not place.read_text():
        time.sleep(0.05)
    address = json.loads(place.read_text())["address"]
    try:
        yield address, workers
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()


def digest(folder: Path) -> str:
    """Of what a drive left."""
    content = b"".join((folder / name).read_bytes() for name in _MAPS)
    return hashlib.sha256(content).hexdigest()


def tell(title: str, figures: dict[str, Any]) -> None:
    """A run, in lines."""
    count = figures["drives"] - figures["kept"]
    cpu, mapping = figures["cpu_seconds"], figures["mapping_cpu_seconds"]
    failed, doubtful, kept = len(figures["failed"]), figures["uncertain"], figures["kept"]
    print(f"{title}: {figures['drives']} drives of {figures['recorded_seconds'] / figures['drives']:.0f} s")
    print(f"  failed {failed}, mostly uncertain {doubtful}, kept from before {kept}")
    print(f"  mapping {mapping / figures['drives']:.2f} CPU s each; wall {figures['wall_seconds']:.0f} s")
    if count and cpu:
        print(f"  {count / cpu * 3600:.0f} drives a core hour: {cpu / count:.2f} CPU s each, all counted")
    print(*(f"  {each}" for each in figures["failed"][:10]), sep="\n")


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR", help="where all goes")
    parser.add_argument("--drives", type=int, default=1000, metavar="N", help="default: 1000")
    parser.add_argument("--seconds", type=float, default=45.0, metavar="S", help="of each drive (default: 45)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="at a time (default: cores)")
    parser.add_argument("--cluster", action=argparse.BooleanOptionalAction, default=True, help="on a cluster too")
    args = parser.parse_args()
    bags = args.keep / "bags"
    bags.mkdir(parents=True, exist_ok=True)
    makes = [partial(make_drive, bags, seed, args.seconds) for seed in range(args.drives)]
    for _, made in run_all(makes, args.jobs):
        if isinstance(made, Failure):
            raise SystemExit(made.reason)
    recordings = [str(path) for path in sorted(bags.glob("*.mcap"))[: args.drives]]
    here = run(recordings, args.keep / "here", args.jobs, None, {})
    tell("this machine", here)
    results = {"here": here}
    if args.cluster:
        with two_workers(args.keep) as (address, workers):
            kill = {len(recordings) // 2: workers[0].kill}
            results["cluster"] = run(recordings, args.keep / "cluster", args.jobs, address, kill)
        tell("two Dask workers, one killed in the middle", results["cluster"])
        folders = [Path(recording).stem for recording in recordings]
        same = sum(digest(args.keep / "here" / name) == digest(args.keep / "cluster" / name) for name in folders)
        print(f"same bytes: {same} of {len(folders)}")
    (args.keep / "results.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
