# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finding and following a robot on maps of earlier drives of the same simulated homes.

    .venv/bin/python bench/relocalisation.py [--homes N] [--queries N] [--first SEED] [--params FILE] [--keep DIR] \
        [--rows NAME ...]

Prints two tables and writes relocalisation.json into --keep; simulated drives and maps are kept there too. The map of a
home is of its drive 0; the robot is looked for, and followed, on its drive 1, which goes other ways.
"""

import argparse
import json
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from accuracy import describe
from oort import Map, Parameters, Session, load_map, read_parameters, save_map
from oort.localization import Localizer, PlacedScan, ReferenceMap, Relocalization, Relocalizer, start_covariance
from oort.poses import Array, between, compose, wrap_angle
from oort.simulate import Drive
from trials.drives import DriveStore, Recipe, recording_of
from trials.tables import print_table
from trials.truth import true_nodes

WRONG, WRONG_HEADING = 0.1, np.radians(5.0)  # [m], [rad]
SILENT, SILENT_HEADING = 0.25, np.radians(10.0)  # a localiser that is off by more and says that it tracks
MOVED = 4  # pieces of furniture
WAY = 1.0  # [m] that a query may take
QUERY_ROWS = ("same home", "consecutive scans", "furniture moved", "home of alike rooms", "another home's map")
FOLLOW_ROWS = ("from a search", "from the dock")


class Homes:
    """The maps of drives 0 and the drives 1 on them."""

    def __init__(self, keep: Path, parameters: Parameters) -> None:
        self._keep, self._store, self.parameters = keep, DriveStore(keep), parameters

    def drive(self, recipe: Recipe) -> Drive:
        if not self._store.has(recipe):
            self._store.make(recipe)
        return self._store.load(recipe)

    def map(self, recipe: Recipe) -> Map:
        path = self._keep / "maps" / recipe.name
        if not path.with_name(path.name + ".map_capnp").is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            drive = self.drive(recipe)
            session = Session(self.parameters, tuple(drive.T_base_sensor.tolist()))
            session.start()
            session.create_location("dock", "dock")
            for scan in recording_of(drive, recipe.name).scans():
                session.add_scan(scan)
            session.notify_docked()
            session.stop()
            save_map(str(path), session.map)
        return load_map(str(path))


class Truth:
    """Where a map puts true poses: relative to the node nearest to them; and where the truth itself does."""

    def __init__(self, map_: Map, drive: Drive) -> None:
        self._nodes, self._true = map_.node_poses, true_nodes(map_, drive)[0]
        self._fit = _alignment(self._true[:, :2], self._nodes[:, :2])

    def on_map(self, T_sensor: Array) -> Array:  # noqa: N803
        apart = np.hypot(*(self._true[:, :2] - T_sensor[:2]).T) + 0.3 * np.abs(
            wrap_angle(self._true[:, 2] - T_sensor[2])
        )
        nearest = int(np.argmin(apart))
        return compose(self._nodes[nearest], between(self._true[nearest], T_sensor))

    def aligned(self, T_sensor: Array) -> Array:  # noqa: N803
        """The true pose after the rigid motion that brings the true nodes nearest to those of the map."""
        return compose(self._fit, T_sensor)


def _alignment(points: Array, onto: Array) -> Array:
    """(3,) the rigid motion of the plane with the least squares of distances (Horn 1987, in the plane)."""
    a, b = points - points.mean(axis=0), onto - onto.mean(axis=0)
    angle = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    turned = compose([0.0, 0.0, angle], [*points.mean(axis=0), 0.0])
    return np.array([*(onto.mean(axis=0) - turned[:2]), angle])


def _recipe(seed: int, row: str) -> tuple[Recipe, Recipe]:
    """Of the map's drive and of the query's."""
    base = Recipe(seed, scene="alike" if row == "home of alike rooms" else "home")
    other = replace(base, way=1, moved=MOVED if row in ("furniture moved", *FOLLOW_ROWS) else 0)
    return base, other


def _views(drive: Drive, first: int, row: str, parameters: Parameters) -> list[int]:
    """The scans of a query, by index: what a localiser keeps while it drives WAY, or five in a row."""
    count = int(parameters.get("localization.relocalizer.max_scans"))
    if row == "consecutive scans":
        return list(range(first, first + count))
    distance, angle = (float(parameters.get(f"localization.relocalizer.scan_{x}")) for x in ("distance", "angle"))
    views, way, odometry = [first], 0.0, drive.T_odom_base_at_scans
    for index in range(first + 1, len(odometry)):
        way += float(np.hypot(*(odometry[index, :2] - odometry[index - 1, :2])))
        if way > WAY or len(views) == count:
            break
        x, y, turn = between(odometry[views[-1]], odometry[index]).tolist()
        if np.hypot(x, y) >= distance or abs(turn) >= angle:
            views.append(index)
    return views


def _placed(drive: Drive, index: int) -> PlacedScan:
    x, y, theta = compose(drive.T_odom_base_at_scans[index], drive.T_base_sensor).tolist()
    ranges = drive.ranges[index]
    return PlacedScan(
        drive.scan_times[index], drive.angle_min, drive.angle_increment, drive.range_min, drive.range_max, ranges,
        (x, y, theta),
    )  # fmt: skip


def off_by(truth: Array, found: Sequence[float] | Array) -> tuple[float, float]:
    """Distance [m] and angle [rad] between two poses."""
    x, y, turn = between(truth, found).tolist()
    return float(np.hypot(x, y)), abs(turn)


def queries(homes: Homes, row: str, seed: int, count: int) -> Iterator[dict[str, Any]]:
    """Random starts on a home's drive 1: scan after scan is added until there is an answer or no scan is left."""
    base, other = _recipe(seed, row)
    drive = homes.drive(other)
    if row == "another home's map":
        base = replace(base, seed=seed + 1)
    map_ = homes.map(base)
    truth = Truth(map_, homes.drive(base))
    relocalizer = Relocalizer(ReferenceMap(map_, homes.parameters), homes.parameters)
    rng = np.random.Generator(np.random.PCG64([seed, 77]))
    for first in rng.choice(len(drive.scan_times) - 60, count, replace=False).tolist():
        views, at_once = _views(drive, first, row, homes.parameters), row == "consecutive scans"
        result, last, milliseconds = ask(relocalizer, drive, views, at_once)
        figures: dict[str, Any] = {"seed": seed, "first": first, "rejection": result.rejection, "ms": milliseconds}
        if result.found and result.best is not None:
            T_sensor = compose(drive.T_map_base[last], drive.T_base_sensor)
            figures["support"] = result.best.support
            figures["off"] = off_by(truth.on_map(T_sensor), result.best.T_map_sensor)
            figures["off_truth"] = off_by(truth.aligned(T_sensor), result.best.T_map_sensor)
        yield figures


def ask(
    relocalizer: Relocalizer, drive: Drive, views: Sequence[int], at_once: bool
) -> tuple[Relocalization, int, list[float]]:
    """Asks with all views, or with one more each time until there is an answer: that, the last view asked with and the
    CPU milliseconds of each search."""
    milliseconds = []
    for length in [len(views)] if at_once else range(1, len(views) + 1):
        started = time.process_time()
        result = relocalizer.find([_placed(drive, index) for index in views[:length]])
        milliseconds.append(1e3 * (time.process_time() - started))
        if result.found:
            break
    return result, views[length - 1], milliseconds


def find_anywhere(map_: Map, drive: Drive, parameters: Parameters, count: int) -> dict[str, float]:
    """How a robot is found on a map from random starts of a drive in the map's own frame, and followed on it from the
    dock: counts, and errors [m] against the truth without an alignment."""
    reference = ReferenceMap(map_, parameters)
    relocalizer = Relocalizer(reference, parameters)
    off = []
    for first in np.random.default_rng(5).choice(len(drive.scan_times) - 60, count, replace=False).tolist():
        result, last, _ = ask(relocalizer, drive, _views(drive, first, "same home", parameters), False)
        if result.found and result.best is not None:
            T_sensor = compose(drive.T_map_base[last], drive.T_base_sensor)
            off.append(off_by(T_sensor, result.best.T_map_sensor))
    localizer = _from_the_dock(reference, drive, parameters)
    followed = [off_by(drive.T_map_base[index], pose)[0] for index, pose, _ in _follow(localizer, drive, [])]
    return {
        "starts": count,
        "found": len(off),
        "wrong": sum(1 for metres, turn in off if metres > WRONG or turn > WRONG_HEADING),
        "off_m": float(np.median([metres for metres, _ in off])),
        "followed_rmse_m": float(np.sqrt(np.mean(np.square(followed)))),
        "followed_most_m": max(followed),
    }


def summarise_queries(found: list[dict[str, Any]], none_is_right: bool) -> list[str]:
    answers = [q for q in found if q["rejection"] is None]
    wrong = [
        sum(none_is_right or q[key][0] > WRONG or q[key][1] > WRONG_HEADING for q in answers)
        for key in ("off", "off_truth")
    ]
    refused = Counter(q["rejection"] for q in found if q["rejection"] is not None)
    milliseconds = [ms for q in found for ms in q["ms"]]
    off = [q["off"][0] for q in answers]
    return [
        f"{len(answers)} of {len(found)}",
        f"{wrong[0]} ({wrong[1]})",
        ", ".join(f"{why} {n}" for why, n in sorted(refused.items())) or "-",
        "-" if none_is_right or not answers else f"{1e3 * np.median(off):.0f} / {1e3 * np.percentile(off, 95):.0f}",
        f"{np.percentile(milliseconds, 50):.0f} / {np.percentile(milliseconds, 99):.0f}",
    ]


def follow(homes: Homes, row: str, seed: int) -> dict[str, Any]:
    """A whole drive 1, with furniture moved, on the map of drive 0."""
    base, other = _recipe(seed, row)
    map_, drive = homes.map(base), homes.drive(other)
    truth = Truth(map_, homes.drive(base))
    reference = ReferenceMap(map_, homes.parameters)
    if row == "from the dock":
        localizer = _from_the_dock(reference, drive, homes.parameters)
    else:
        localizer = Localizer(reference, homes.parameters, _mount(drive))
    milliseconds: list[float] = []
    known = list(_follow(localizer, drive, milliseconds))
    return _follow_figures(seed, drive, truth, known, milliseconds) | {"jumps": localizer.statistics["jumps"]}


def _mount(drive: Drive) -> tuple[float, float, float]:
    x, y, theta = drive.T_base_sensor.tolist()
    return x, y, theta


def _from_the_dock(reference: ReferenceMap, drive: Drive, parameters: Parameters) -> Localizer:
    localizer = Localizer(reference, parameters, _mount(drive))
    localizer.start_at((0.0, 0.0, 0.0), start_covariance())  # the map's origin is its first sensor pose
    return localizer


def _follow(localizer: Localizer, drive: Drive, milliseconds: list[float]) -> Iterator[tuple[int, Array, str]]:
    """Index, pose of the base and state of each scan at which there is a pose; adds each scan's CPU milliseconds."""
    for index, scan in enumerate(recording_of(drive, "followed").scans()):
        started = time.process_time()
        localizer.add_scan(scan, scan.odometry)
        milliseconds.append(1e3 * (time.process_time() - started))
        if localizer.T_map_odom is not None:
            yield index, compose(localizer.T_map_odom, scan.odometry), localizer.state


def _follow_figures(
    seed: int, drive: Drive, truth: Truth, known: list[tuple[int, Array, str]], milliseconds: list[float]
) -> dict[str, Any]:
    true = drive.T_map_base[[index for index, _, _ in known]]
    poses = np.array([pose for _, pose, _ in known])
    fit = _alignment(poses[:, :2], true[:, :2])
    errors = np.hypot(*(compose(fit, poses)[:, :2] - true[:, :2]).T)
    sensors = compose(true, drive.T_base_sensor), compose(poses, drive.T_base_sensor)
    off = [off_by(truth.on_map(where), found) for where, found in zip(*sensors, strict=True)]
    silent = sum(
        state == "tracking" and bool(metres > SILENT or turn > SILENT_HEADING)
        for (_, _, state), (metres, turn) in zip(known, off, strict=True)
    )
    return {
        "seed": seed,
        "ate": float(np.sqrt(np.mean(errors**2))),
        "off_max": max(metres for metres, _ in off),
        "silent": silent,
        "scans": len(milliseconds),
        "first": known[0][0],
        "states": dict(Counter(state for _, _, state in known)),
        "ms": [float(np.percentile(milliseconds, p)) for p in (50, 99)],
    }


def summarise_follow(drives: list[dict[str, Any]]) -> list[str]:
    ate = [d["ate"] for d in drives]
    scans = sum(d["scans"] for d in drives)
    tracking = sum(d["states"].get("tracking", 0) for d in drives) / scans
    lost = sum(d["states"].get("lost", 0) for d in drives) / scans
    return [
        f"{len(drives)}",
        f"{np.median(ate):.3f} / {max(ate):.3f}",
        f"{sum(d['silent'] for d in drives)} of {scans}",
        f"{100.0 * tracking:.1f} % / {100.0 * (1.0 - tracking - lost):.1f} % / {100.0 * lost:.1f} %",
        f"{sum(d['jumps'] for d in drives)}",
        f"{np.median([d['ms'][0] for d in drives]):.2f} / {np.median([d['ms'][1] for d in drives]):.1f}",
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    rows = [*QUERY_ROWS, *FOLLOW_ROWS]
    parser.add_argument("--rows", nargs="+", choices=rows, default=rows, metavar="ROW", help=", ".join(rows))
    parser.add_argument("--homes", type=int, default=20, metavar="N", help="how many homes")
    parser.add_argument("--first", type=int, default=1, metavar="SEED", help="the first one's seed")
    parser.add_argument("--queries", type=int, default=10, metavar="N", help="random starts in each home")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    parser.add_argument("--keep", metavar="DIR", help="where drives, maps and results stay (default: nowhere)")
    args = parser.parse_args()
    results: dict[str, Any] = {"about": describe(args.params), "rows": {}}
    asked: dict[str, list[str]] = {}
    followed: dict[str, list[str]] = {}
    with tempfile.TemporaryDirectory() as scratch:
        keep = Path(args.keep or scratch)
        homes = Homes(keep, read_parameters(args.params))
        for row in args.rows:
            figures: list[dict[str, Any]] = []
            for seed in range(args.first, args.first + args.homes):
                new = [follow(homes, row, seed)] if row in FOLLOW_ROWS else [*queries(homes, row, seed, args.queries)]
                figures += new
                print(f"{row}: home {seed} done", file=sys.stderr, flush=True)
            if row in FOLLOW_ROWS:
                followed[row] = summarise_follow(figures)
            else:
                asked[row] = summarise_queries(figures, row == "another home's map")
            results["rows"][row] = figures
            (keep / "relocalisation.json").write_text(json.dumps(results, indent=1) + "\n")
    print(", ".join(f"{key} {value}" for key, value in results["about"].items()) + "\n")
    print_table(("where", "answers", "wrong", "refused", "off, P50 / P95 mm", "ms, P50 / P99"), asked)
    print_table(
        ("start", "drives", "ATE, median / worst m", "silently off", "tracking / uncertain / lost", "jumps",
         "ms, P50 / P99"), followed
    )  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
