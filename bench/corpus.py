# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Every recording of a folder with one parameter set: does it become a whole map, and does it say so if not?

    .venv/bin/python bench/corpus.py [--only WORD ...] [--max-range M] [--view DEGREES] [--keep DIR] [--jobs N]

Takes the folder that OORT_DATASETS names, or --folder. A recording is judged by the relations or the truth beside it
(NAME.relations; NAME.truth with lines `t x y theta`; NAME.truth.tum), and all by whether the map agrees with itself
(oort.evaluation.consistency). Milliseconds are CPU time of the thread that takes the scans. --keep leaves results.json
and what a replay leaves of each recording.
"""

import argparse
import dataclasses
import datetime
import json
import math
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

from oort import Parameters, read_parameters
from oort.evaluation.consistency import consistency
from oort.evaluation.trajectories import evaluate_ate, evaluate_relations
from oort.export import Trajectory, read_tum
from oort.offline.results import write_results
from oort.poses import Array
from oort.recording import Recording, Scan, open_recording
from oort.recording.open import recording_name
from trials.datasets import datasets
from trials.jobs import Figures
from trials.replays import Replayed, cost, counts, replay
from trials.tables import print_table
from trials.workers import Failure, run_all

_SUFFIXES = (".clf", ".clf.gz", ".clf.bz2", ".bag", ".bag.gz", ".bag.bz2", ".mcap", ".db3")
_HEAD = (
    "recording",
    "scans",
    "error (odometry alone)",
    "uncertain or lost, %",
    "agrees with itself, % (right after)",
    "pairs that contradict",
    "untied nodes",
    "closures on / off",
    "CPU s",
    "ms/scan P50 / P99 / worst",
    "MB",
)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, help="instead of OORT_DATASETS")
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD", help="only recordings with it in their path")
    parser.add_argument("--max-range", type=float, metavar="M", help="drop readings from there on")
    parser.add_argument("--view", type=float, metavar="DEGREES", help="keep only beams so far around straight ahead")
    parser.add_argument("--params", help="another parameter file")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="leave all results there")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="recordings at once")
    arguments = parser.parse_args()
    folder = arguments.folder or datasets()
    parameters = read_parameters(arguments.params) if arguments.params else read_parameters()
    recordings = [path for path in find(folder) if not arguments.only or any(w in str(path) for w in arguments.only)]
    if not recordings:
        raise SystemExit(f"{folder}: no recording{' of these names' if arguments.only else ''}; see docs/datasets.md")
    names = [str(path.relative_to(folder)) for path in recordings]
    work = [
        partial(
            measure, path, parameters, arguments.max_range, arguments.view, arguments.keep and arguments.keep / name
        )
        for path, name in zip(recordings, names, strict=True)
    ]
    results: dict[str, Figures] = {}
    failed: dict[str, str] = {}
    for index, result in run_all(work, arguments.jobs):
        if isinstance(result, Failure):
            failed[names[index]] = result.reason
        else:
            results[names[index]] = result
        print_rows({names[index]: result})
    print(f"\nTaken on {datetime.date.today()}\n")
    print_table(_HEAD, {name: cells(results[name]) for name in names if name in results})
    for name, reason in failed.items():
        print(f"- {name}: failed: {reason}")
    if arguments.keep:
        arguments.keep.mkdir(parents=True, exist_ok=True)
        text = json.dumps({"recordings": results, "failed": failed}, indent=1)
        (arguments.keep / "results.json").write_text(text + "\n")


def find(folder: Path) -> list[Path]:
    """The recordings below a folder; a directory with metadata.yaml is one of them."""
    bags = [path.parent for path in folder.rglob("metadata.yaml")]
    files = [path for path in folder.rglob("*") if path.is_file() and path.name.lower().endswith(_SUFFIXES)]
    return sorted([*bags, *(path for path in files if path.parent not in bags)])


def measure(
    path: Path, parameters: Parameters, max_range: float | None, view: float | None, out: Path | None
) -> Figures:
    """Maps one recording and judges what came of it."""
    recording = narrowed(open_recording(path, max_range=max_range), view)
    replayed = replay(recording, parameters)
    states = replayed.states
    figures = cost(replayed) | counts(replayed)
    agreement = dataclasses.asdict(consistency(replayed.drive.map))
    figures |= {name: float(value) for name, value in agreement.items()}
    figures["unsure"] = sum(state in ("uncertain", "lost") for state in states) / len(states)
    figures |= errors(path, replayed)
    if out is not None:
        write_results(replayed.drive, out, str(out.absolute() / "map"))
    return figures


def narrowed(recording: Recording, view: float | None) -> Recording:
    """The recording as a sensor with a narrower view would have made it; ``view`` in degrees."""
    if view is None:
        return recording
    half = math.radians(view) / 2.0

    def scans() -> Iterator[Scan]:
        for scan in recording.scans():
            bearings = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
            kept = np.flatnonzero(np.abs(bearings) <= half + 1e-6)
            first = float(bearings[kept[0]]) if len(kept) else scan.angle_min
            fields = {f.name: getattr(scan, f.name) for f in dataclasses.fields(scan)}
            yield Scan(**(fields | {"ranges": scan.ranges[kept], "angle_min": first}))

    return dataclasses.replace(recording, source=scans)


def errors(path: Path, replayed: Replayed) -> Figures:
    """Against what lies beside the recording, of the map and of odometry alone; empty if there is nothing."""
    base = path.with_name(recording_name(path))
    recorder = replayed.drive.recorder
    odometry = np.array([scan.odometry for scan in replayed.drive.recording.scans()])
    ours, theirs = (Trajectory(tuple(recorder.stamps), poses) for poses in (replayed.T_map_base, odometry))
    if (relations := base.with_name(f"{base.name}.relations")).exists():
        one, two = evaluate_relations(ours, relations), evaluate_relations(theirs, relations)
        return {
            "error": one.translation_mean,
            "degrees": one.rotation_mean,
            "error_max": one.translation_max,
            "error_odometry": two.translation_mean,
        }
    truth = truth_of(base)
    if truth is None:
        return {}
    ate, raw = evaluate_ate(ours, truth), evaluate_ate(theirs, truth)
    return {"ate": ate.position_rmse, "ate_max": ate.position_max, "ate_odometry": raw.position_rmse}


def truth_of(base: Path) -> Trajectory | None:
    """True poses of the robot's base beside a recording."""
    if (path := base.with_name(f"{base.name}.truth.tum")).exists():
        return read_tum(path)
    if not (path := base.with_name(f"{base.name}.truth")).exists():
        return None
    rows: Array = np.loadtxt(path, ndmin=2)
    return Trajectory(tuple(f"{time:.6f}" for time in rows[:, 0].tolist()), rows[:, 1:4])


def cells(f: Figures) -> list[str]:
    """The row of one recording."""
    error = "-"
    if "error" in f:
        error = f"{f['error']:.4f} m, {f['degrees']:.2f}°, worst {f['error_max']:.2f} ({f['error_odometry']:.2f})"
    elif "ate" in f:
        error = f"ATE {f['ate']:.3f} m, worst {f['ate_max']:.2f} ({f['ate_odometry']:.2f})"
    overlap, contradict = "-", "no scans overlap"
    if f["pairs"]:
        overlap = f"{100.0 * f['agreement']:.0f} ({100.0 * f['agreement_near']:.0f})"
        contradict = f"{100.0 * f['contradicting']:.1f} % of {f['pairs']:.0f}"
    return [
        f"{f['scans']:.0f}",
        error,
        f"{100.0 * f['unsure']:.1f}",
        overlap,
        contradict,
        f"{f['untied_nodes']:.0f} of {f['nodes']:.0f}",
        f"{f['closures_on']:.0f} / {f['closures_off']:.0f}",
        f"{f['cpu_s']:.1f}",
        f"{f['ms_p50']:.2f} / {f['ms_p99']:.1f} / {f['ms_max']:.1f}",
        f"{f['memory_mb']:.0f}",
    ]


def print_rows(results: dict[str, Figures | Failure]) -> None:
    """Tells of recordings as they end."""
    for name, result in results.items():
        what = f"failed: {result.reason}" if isinstance(result, Failure) else " | ".join(cells(result))
        print(f"{name}: {what}", flush=True)


if __name__ == "__main__":
    main()
