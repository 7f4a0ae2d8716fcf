# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A map for life: many drives through one simulated home, each resumed on the last one's map.

    .venv/bin/python bench/lifelong.py [--days N] [--first DAY] [--home SEED] [--out DIR]

Each day has another way, another person and other noise; from --moves on furniture stands elsewhere and doors stand at
other angles every so many days. Prints a row for each day and writes days.json and days.png to --out, with the first
map and the last; in the end, how a robot that drives on the day after is found and followed on these two. Each day
runs in a process of its own, so that its memory is its own.
"""

import argparse
import json
import multiprocessing
import resource
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import numpy as np

from oort import Map, Session, load_map, render_map, save_map
from oort.export.chart import Panel, write_chart
from oort.offline.trajectory import TrajectoryRecorder
from oort.parameters import read_parameters
from oort.poses import Array, between, compose
from oort.recording import Scan
from oort.report.stopwatch import without_garbage_pauses
from oort.simulate import Drive, SimulationConfig, simulate_drive
from relocalisation import find_anywhere
from trials.drives import recording_of
from trials.jobs import ate_of

STARTS = 80  # of searches for the robot in the end
PLACES = 8  # named on the first day, spread over its drive
NEAR = 0.075  # m between an occupied cell's middle and a surface that it stands for: a cell and a half
SPACING = 0.05  # m between points of the true surfaces


@dataclass(frozen=True)
class Day:
    """The figures of a day."""

    day: int
    nodes: int
    closures: int
    cpu_s: float
    longest_ms: float
    """CPU time of the longest scan in the thread that takes scans"""
    file_mb: float
    memory_mb: float
    ate_m: float
    places_m: float
    """how far the place that moved most lies from where it was on the first day"""
    places_off_m: float
    """how far the places lie from where they truly are, on average"""
    dock_m: float
    precision: float
    """share of the occupied cells that lie on a true surface of the day"""
    recall: float
    """share of the true surfaces' points that an occupied cell lies on"""
    fresh_precision: float
    """the same of a map of this drive alone; NaN on days on which none was made"""
    fresh_recall: float


def simulate_day(home: int, day: int, moves: int, every: int, minutes: float) -> Drive:
    """The drive of a day, counted from 0."""
    arrangement = max(0, (day + 1 - moves) // every + 1) if moves else 0
    config = SimulationConfig(odometry_error=2.0, minutes=minutes, way=day + 1)
    if arrangement:
        config = replace(config, moved=3, doors=True, arrangement=arrangement)
    return simulate_drive(home, config)


def run_day(day: int, drive: Drive, folder: Path, compare: bool) -> Day:
    """Resumes yesterday's map, drives and saves; ``compare``: with a map of this drive alone, too."""
    parameters = read_parameters()
    recording = recording_of(drive, f"day {day}")
    target = folder / f"map{day % 2}"
    cpu = time.process_time()
    session = Session(parameters, recording.sensor_on_base)
    if day == 0:
        session.start(str(target))
    else:
        session.load(str(folder / f"map{(day - 1) % 2}"))
        session.resume(str(target), (0.0, 0.0, 0.0))
    recorder = TrajectoryRecorder(recording.sensor_on_base)
    longest = _drive(session, recorder, drive, recording.scans(), day == 0)
    session.stop()
    recorder.follow(session.mapper.take_renumbering())
    cpu = time.process_time() - cpu
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    map_ = session.map
    if day == 0:
        save_map(str(folder / "first"), map_)
    places = {f"{space}/{id}": compose(map_.node_poses[node], pose) for space, id, node, pose in map_.locations}
    if day == 0:
        (folder / "places.json").write_text(json.dumps({name: pose.tolist() for name, pose in places.items()}))
        (folder / "truth.json").write_text(json.dumps(true_places(drive)))
    apart = distances(places, json.loads((folder / "places.json").read_text()))
    off = distances(places, json.loads((folder / "truth.json").read_text()))
    fresh_right = (np.nan, np.nan)
    if compare:
        fresh = Session(parameters, recording.sensor_on_base)
        fresh.start()
        _drive(fresh, TrajectoryRecorder(recording.sensor_on_base), drive, recording.scans(), False)
        fresh.stop()
        fresh_right = cells_right(fresh.map, drive)
    return Day(
        day + 1,
        len(map_),
        len(map_.switchable_edges["i"]),
        cpu,
        1e3 * longest,
        sum(path.stat().st_size for path in folder.glob(f"{target.name}.*")) / 1e6,
        memory,
        ate_of(drive, recorder.base_poses(map_)).position_rmse,
        max(distance for name, distance in apart.items() if not name.startswith("dock")),
        float(np.mean(list(off.values()))),
        apart["dock/dock"],
        *cells_right(map_, drive),
        *fresh_right,
    )


def distances(places: Mapping[str, Array], others: Mapping[str, Sequence[float]]) -> dict[str, float]:
    """How far each of the others' places is from where it is among the first ones [m]."""
    return {name: float(np.hypot(*np.subtract(places[name], pose)[:2])) for name, pose in others.items()}


def named_scans(drive: Drive) -> list[int]:
    """The scans at which a place is named."""
    return [int(k) for k in np.linspace(0, len(drive.scan_stamps) - 1, PLACES + 2)[1:-1]]


def true_places(drive: Drive) -> dict[str, list[float]]:
    """Where the sensor truly was at them, on the map."""
    T_map_sensor = compose(drive.T_map_base, drive.T_base_sensor)
    return {f"place/{k}": T_map_sensor[k].tolist() for k in named_scans(drive)}


@without_garbage_pauses()
def _drive(
    session: Session, recorder: TrajectoryRecorder, drive: Drive, scans: Iterable[Scan], name_places: bool
) -> float:
    """All scans of a drive with its calls; CPU seconds of the longest scan."""
    marked, docked = (event.t for event in drive.events)
    named = named_scans(drive)
    longest, was_docked = 0.0, False
    before = -np.inf
    for number, scan in enumerate(scans):
        if name_places and before <= marked < scan.time:
            session.create_location("dock", "dock")
        if not was_docked and docked < scan.time:
            session.notify_docked()
            was_docked = True
        started = time.thread_time()
        result = session.add_scan(scan)
        longest = max(longest, time.thread_time() - started)
        recorder.follow(session.mapper.take_renumbering())
        recorder.add(scan.stamp, scan.odometry, result)
        if name_places and number in named:
            session.create_location("place", str(number))
        before = scan.time
    return longest


def cells_right(map_: Map, drive: Drive) -> tuple[float, float]:
    """Precision and recall of the occupied cells, by the true home of the day."""
    grid = render_map(map_, read_parameters())[0]
    rows, columns = np.nonzero(grid.cells == 100)
    cells = np.column_stack([columns, rows]) * grid.resolution + np.array(grid.origin) + 0.5 * grid.resolution
    x, y, theta = between(drive.home.dock, drive.T_map_base[0])
    assert abs(x) + abs(y) + abs(theta) < 1e-6  # the map's frame is the truth's
    surfaces = _surface_points(drive)
    return _share_near(cells, surfaces), _share_near(surfaces, cells)


def _surface_points(drive: Drive) -> Array:
    points = []
    for x0, y0, x1, y1 in drive.home.segments:
        count = max(2, int(np.hypot(x1 - x0, y1 - y0) / SPACING))
        points.append(np.linspace((x0, y0), (x1, y1), count))
    points += [drive.home.discs[:, :2]]
    return np.vstack(points)


def _share_near(points: Array, others: Array) -> float:
    near = 0
    for begin in range(0, len(points), 500):
        apart = points[begin : begin + 500, None] - others[None]
        near += int((np.einsum("ijk,ijk->ij", apart, apart).min(axis=1) <= NEAR**2).sum())
    return near / len(points)


def _child(arguments: argparse.Namespace, day: int, queue: "multiprocessing.Queue[Day]") -> None:
    drive = simulate_day(arguments.home, day, arguments.moves, arguments.every, arguments.minutes)
    queue.put(run_day(day, drive, arguments.out, day % arguments.compare == 0))


def _panel(name: str, days: Sequence[float], values: Sequence[float]) -> Panel:
    """Lengths in millimetres: a bar of a chart reaches at least to 1."""
    days, values = zip(
        *((day, value) for day, value in zip(days, values, strict=True) if not np.isnan(value)), strict=True
    )
    if name.endswith("_m"):
        return Panel(f"{name}m", days, [1e3 * value for value in values])
    return Panel(name, days, values)


def _row(values: Sequence[object]) -> str:
    return "| " + " | ".join(f"{v:.3f}" if isinstance(v, float) else str(v) for v in values) + " |"


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, default=10)
    parser.add_argument("--first", type=int, default=1, metavar="DAY", help="go on with the run in --out from here")
    parser.add_argument("--home", type=int, default=3, metavar="SEED")
    parser.add_argument("--minutes", type=float, default=4.0, help="of each drive, at least")
    parser.add_argument("--moves", type=int, default=4, metavar="DAY", help="the first day with moves; 0: none")
    parser.add_argument("--every", type=int, default=10, metavar="DAYS", help="between moves")
    parser.add_argument("--compare", type=int, default=1, metavar="DAYS", help="between maps of a drive alone")
    parser.add_argument("--out", type=Path, default=Path("oort-out/lifelong"), metavar="DIR")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    names = [field.name for field in fields(Day)]
    print(_row(names), _row(["---"] * len(names)), sep="\n", flush=True)
    days: list[Day] = []
    if arguments.first > 1:
        days = [Day(**day) for day in json.loads((arguments.out / "days.json").read_text())][: arguments.first - 1]
    context = multiprocessing.get_context("spawn")
    for day in range(len(days), arguments.days):
        queue: multiprocessing.Queue[Day] = context.Queue()
        child = context.Process(target=_child, args=(arguments, day, queue))
        child.start()
        while child.is_alive() and queue.empty():
            child.join(0.1)
        if queue.empty():
            raise SystemExit(f"day {day + 1} failed")
        days.append(queue.get())
        child.join()
        print(_row(list(asdict(days[-1]).values())), flush=True)
        (arguments.out / "days.json").write_text(json.dumps([asdict(d) for d in days], indent=1) + "\n")
    drive = simulate_day(arguments.home, arguments.days, arguments.moves, arguments.every, arguments.minutes)
    for name in ("first", f"map{(arguments.days - 1) % 2}"):
        print(name, find_anywhere(load_map(str(arguments.out / name)), drive, read_parameters(), STARTS), flush=True)
    numbers = [float(d.day) for d in days]
    panels = [_panel(name, numbers, [float(getattr(d, name)) for d in days]) for name in names[1:]]
    write_chart(arguments.out / "days.png", panels)


if __name__ == "__main__":
    main()
