# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Merged maps, and sessions that go on with a map, beside maps of whole drives.

    .venv/bin/python bench/merge.py [--logs NAME ...] [--homes N] [--first SEED] [--rows NAME ...] [--params FILE] \
        [--keep DIR]

Prints two tables. Logs, cut into halves: the whole drive; its halves mapped apart and merged; the second half as a
session on the map of the first. Homes: the maps of two drives of a simulated home, merged, against the truth.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from accuracy import describe
from oort import InputError, Map, Parameters, Session, read_parameters
from oort.evaluation.trajectories import alignment, evaluate_relations
from oort.export.tum import Trajectory
from oort.offline.merge import Merged, merge_maps
from oort.offline.trajectory import TrajectoryRecorder
from oort.poses import Array, compose
from oort.recording import Recording, Scan, open_recording
from relocalisation import Homes
from trials.closures import ON, false_closures
from trials.datasets import datasets
from trials.drives import Recipe
from trials.tables import print_table
from trials.truth import true_nodes

LOGS = ("fr079", "intel", "fr079:3", "intel:3")
"""Names of logs, and the range beyond which readings are cut [m]."""

ROWS = (
    "homes",
    "no dock",
    "furniture moved",
    "view of 90 degrees",
    "alike rooms",
    "alike rooms, no dock",
    "other home",
    "other home of alike rooms",
)
"""Both maps have a dock unless the row says that they have none. Of other homes everything must be refused."""

RESUMED_AT = (0.3, -0.2, 0.1)
"""By how much a session is told a wrong pose [m, rad]."""


@dataclass(frozen=True)
class Part:
    """Part of a recording, and what came of it."""

    session: Session
    recorder: TrajectoryRecorder

    @classmethod
    def of(cls, recording: Recording, parameters: Parameters) -> "Part":
        session = Session(parameters, recording.sensor_on_base)
        session.start()
        return cls(session, TrajectoryRecorder(recording.sensor_on_base))

    def map_scans(self, scans: Sequence[Scan]) -> None:
        for scan in scans:
            result = self.session.add_scan(scan)
            self.recorder.follow(self.session.mapper.take_renumbering())
            self.recorder.add(scan.stamp, scan.odometry, result)
        self.session.stop()
        self.recorder.follow(self.session.mapper.take_renumbering())


def _resumed(recording: Recording, parameters: Parameters, halves: Sequence[Sequence[Scan]]) -> tuple[Trajectory, str]:
    part = Part.of(recording, parameters)
    part.map_scans(halves[0])
    x, y, theta = compose(part.session.map.node_poses[-1], RESUMED_AT).tolist()
    part.session.resume("", (x, y, theta))
    part.recorder.follow(part.session.mapper.take_renumbering())
    part.map_scans(halves[1])
    return _trajectory([part.recorder], [part.recorder.base_poses(part.session.map)]), ""


def _merged(recording: Recording, parameters: Parameters, halves: Sequence[Sequence[Scan]]) -> tuple[Trajectory, str]:
    parts = [Part.of(recording, parameters) for _ in halves]
    for part, scans in zip(parts, halves, strict=True):
        part.map_scans(scans)
    started = time.process_time()
    merged = merge_maps(parts[0].session.map, parts[1].session.map, parameters)
    seconds = time.process_time() - started
    recorders = [part.recorder for part in parts]
    poses = [
        recorder.base_poses(merged.map, first)
        for recorder, first in zip(recorders, (0, merged.first_node_b), strict=True)
    ]
    about = (
        f"{merged.views_that_fit} / {merged.views_that_contradict} of {merged.views} views, closures "
        f"{merged.closures_kept} of {merged.closures['accepted']} of {merged.closures['tried']}, {seconds:.1f} s"
    )
    return _trajectory(recorders, poses), about


def _whole(recording: Recording, parameters: Parameters, halves: Sequence[Sequence[Scan]]) -> tuple[Trajectory, str]:
    part = Part.of(recording, parameters)
    part.map_scans([*halves[0], *halves[1]])
    return _trajectory([part.recorder], [part.recorder.base_poses(part.session.map)]), ""


def _trajectory(recorders: Sequence[TrajectoryRecorder], poses: Sequence[Array]) -> Trajectory:
    return Trajectory(tuple(stamp for recorder in recorders for stamp in recorder.stamps), np.concatenate(poses))


def _across(relations: Path, halves: Sequence[Sequence[Scan]], folder: Path) -> Path:
    """The relations between a scan of the first half and one of the second, as a file."""
    second = {round(scan.time, 6) for scan in halves[1]}
    lines = [line for line in relations.read_text().splitlines() if line.strip() and not line.startswith("#")]
    ends = [[round(float(field), 6) in second for field in line.split()[:2]] for line in lines]
    path = folder / f"{relations.stem}-across.relations"
    path.write_text("\n".join(line for line, (a, b) in zip(lines, ends, strict=True) if a != b) + "\n")
    return path


def measure_log(log: str, data: Path, parameters: Parameters, folder: Path) -> dict[str, list[str]]:
    name, _, cut = log.partition(":")
    recording = open_recording(data / f"{name}.clf.bz2", max_range=float(cut) if cut else None)
    scans = list(recording.scans())
    halves = scans[: len(scans) // 2], scans[len(scans) // 2 :]
    relations = data / f"{name}.relations"
    across = _across(relations, halves, folder)
    rows = {}
    for way, make in (("whole", _whole), ("merged", _merged), ("two sessions", _resumed)):
        trajectory, about = make(recording, parameters, halves)
        every, between_halves = (evaluate_relations(trajectory, path) for path in (relations, across))
        rows[f"{log} {way}"] = [
            f"{every.translation_mean:.4f} / {every.rotation_mean:.3f}",
            f"{between_halves.translation_mean:.4f} / {between_halves.rotation_mean:.3f} ({between_halves.n})",
            about or "-",
        ]
        print(f"{log} {way}: {rows[f'{log} {way}']}", file=sys.stderr, flush=True)
    return rows


def _recipes(row: str, seed: int) -> tuple[Recipe, Recipe]:
    base = Recipe(seed, scene="alike" if "alike" in row else "home")
    if row == "view of 90 degrees":
        base = replace(base, field_of_view=90)
    other = replace(base, way=1, moved=4 if row == "furniture moved" else 0)
    return base, replace(other, seed=seed + 1) if row.startswith("other") else other


def measure_home(homes: Homes, row: str, seed: int) -> dict[str, Any]:
    """Figures of one pair of maps; ``refused`` is the error where they were not joined."""
    recipes = _recipes(row, seed)
    maps = [homes.map(recipe) for recipe in recipes]
    if "no dock" in row:
        maps[1].locations = []
    started = time.process_time()
    try:
        merged = merge_maps(maps[0], maps[1], homes.parameters)
    except InputError as error:
        return {"refused": str(error), "seconds": time.process_time() - started}
    seconds = time.process_time() - started
    truths = [true_nodes(map_, homes.drive(recipe))[0] for map_, recipe in zip(maps, recipes, strict=True)]
    figures = _closures(merged, np.concatenate(truths))
    names = ("ate", "ate_first", "ate_second")
    pairs = ((merged.map, np.concatenate(truths)), *zip(maps, truths, strict=True))
    return figures | {name: _ate(*pair) for name, pair in zip(names, pairs, strict=True)} | {"seconds": seconds}


def _ate(map_: Map, truth: Array) -> float:
    """Root mean square of the nodes' distances from the truth after the best rigid motion [m]."""
    aligned = compose(alignment(map_.node_poses, truth), map_.node_poses)
    return float(np.sqrt(np.mean(np.sum((aligned - truth)[:, :2] ** 2, axis=1))))


def _closures(merged: Merged, truth: Array) -> dict[str, int]:
    """True and false closures across, kept and off."""
    edges = merged.map.switchable_edges
    across = (edges["i"] < merged.first_node_b) != (edges["j"] < merged.first_node_b)
    false, on = false_closures(merged.map, truth), edges["switch"] >= ON
    kinds = {"true_kept": ~false & on, "true_off": ~false & ~on, "false_kept": false & on, "false_off": false & ~on}
    return {name: int((across & chosen).sum()) for name, chosen in kinds.items()}


def summarise(found: list[dict[str, Any]]) -> list[str]:
    joined = [figures for figures in found if "refused" not in figures]
    counts = [
        sum(figures[f"{kind}_{fate}"] for figures in joined) for kind in ("true", "false") for fate in ("kept", "off")
    ]

    def ate(name: str) -> str:
        values = [figures[name] for figures in joined]
        return f"{np.median(values):.4f} / {max(values):.4f}" if values else "-"

    return [
        f"{len(joined)} of {len(found)}",
        *(ate(name) for name in ("ate", "ate_first", "ate_second")),
        f"{counts[0]} / {counts[1]}",
        f"{counts[2]} / {counts[3]}",
        f"{np.mean([figures['seconds'] for figures in found]):.1f}",
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--logs", nargs="*", choices=LOGS, default=LOGS, metavar="LOG", help=", ".join(LOGS))
    parser.add_argument("--rows", nargs="*", choices=ROWS, default=ROWS, metavar="ROW", help=", ".join(ROWS))
    parser.add_argument("--homes", type=int, default=10, metavar="N", help="how many homes")
    parser.add_argument("--first", type=int, default=1, metavar="SEED", help="the first one's seed")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    parser.add_argument("--keep", metavar="DIR", help="where drives and maps stay (default: nowhere)")
    args = parser.parse_args()
    parameters = read_parameters(args.params)
    logs: dict[str, list[str]] = {}
    rows: dict[str, list[str]] = {}
    with tempfile.TemporaryDirectory() as scratch:
        for log in args.logs:
            logs |= measure_log(log, datasets() / "radish", parameters, Path(scratch))
        homes = Homes(Path(args.keep or scratch), parameters)
        for row in args.rows:
            found = []
            for seed in range(args.first, args.first + args.homes):
                found.append(measure_home(homes, row, seed))
                print(f"{row}: home {seed}: {found[-1]}", file=sys.stderr, flush=True)
            rows[row] = summarise(found)
    print(", ".join(f"{key} {value}" for key, value in describe(args.params).items()) + "\n")
    print_table(
        ("drive", "all relations, m / deg", "across the halves (how many)", "views that fit / contradict"), logs
    )
    print_table(
        ("maps", "joined", "ATE, median / worst m", "first alone", "second alone", "true closures across, kept / off",
         "false", "CPU s"), rows
    )  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
