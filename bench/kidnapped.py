# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How soon a robot is home that does not know where it is, and whether it ever claims a place that it is not at.

    .venv/bin/python bench/kidnapped.py [--kinds paused unannounced resumed ...] [--drives N] [--first SEED] \
        [--minutes T] [--jobs N] [--params FILE] --keep DIR

In each simulated home the robot maps the whole of drive 0, is put to another place, at least 2.5 m off, somewhere on
drive 1, which goes other ways, and drives on from there for some minutes. Odometry tells nothing of the move.
Prints a table and writes kidnapped.json into --keep; simulated drives are kept there, too.
"""

import argparse
import json
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuracy import describe
from oort import Parameters, Session, read_parameters
from oort.poses import Array, between, compose, wrap_angle
from oort.recording import Scan
from oort.simulate import Drive
from trials.drives import DriveStore, Recipe
from trials.tables import print_table
from trials.truth import true_nodes
from trials.workers import Failure, run_all

KINDS = {
    "paused": "carried while mapping is paused",
    "unannounced": "carried while it maps, without a word",
    "resumed": "a session begun at a pose that is off by up to 5 m and 180 degrees",
    "elsewhere": "carried to another home while mapping is paused: has to stay loose",
}
SCENES = ("home", "alike")
MOVED = 2.5  # [m] at least
START_OFF = 5.0  # [m]
PERIOD = 0.1  # [s] between scans
LOOKED_AT = 5  # every how many-th scan's pose is compared with the truth
HOME, HOME_HEADING = 0.25, float(np.radians(10.0))  # [m], [rad]: is where it says that it is
IN_TIME = 30.0  # [s] of driving on
OTHER_HOME = 1000  # added to the seed


Flags = NDArray[np.bool_]


def _scan(drive: Drive, index: int, time: float, T_odom_base: Array) -> Scan:  # noqa: N803
    x, y, theta = T_odom_base.tolist()
    return Scan(
        time=time, stamp=f"{time:.6f}", angle_min=drive.angle_min, angle_increment=drive.angle_increment,
        range_min=drive.range_min, range_max=drive.range_max, ranges=drive.ranges[index], odometry=(x, y, theta),
    )  # fmt: skip


class Truth:
    """Where the map has the place at which the robot truly is: as seen from the node nearest to it of drive 0."""

    def __init__(self, session: Session, drive: Drive) -> None:
        self._session, self._true = session, true_nodes(session.map, drive)[0]
        self._carriers, self._seen = np.arange(len(self._true)), np.zeros((len(self._true), 3))

    def follow(self) -> None:
        """Nodes are others once the map was reduced."""
        if (renumbering := self._session.mapper.take_renumbering()) is not None:
            carriers, T_carrier_node = renumbering
            self._seen = compose(T_carrier_node[self._carriers], self._seen)
            self._carriers = carriers[self._carriers]

    def error(self, T_sensor: Array) -> tuple[float, float]:  # noqa: N803
        apart = np.hypot(*(self._true[:, :2] - T_sensor[:2]).T) + 0.3 * np.abs(
            wrap_angle(self._true[:, 2] - T_sensor[2])
        )
        nearest = int(np.argmin(apart))
        T_carrier_sensor = compose(self._seen[nearest], between(self._true[nearest], T_sensor))
        on_map = compose(self._session.map.node_poses[self._carriers[nearest]], T_carrier_sensor)
        x, y, turn = between(on_map, self._session.mapper.sensor_pose).tolist()
        return float(np.hypot(x, y)), abs(turn)

    def is_home(self, T_sensor: Array) -> bool:  # noqa: N803
        metres, turn = self.error(T_sensor)
        return metres <= HOME and turn <= HOME_HEADING


def kidnap(
    store: DriveStore, kind: str, scene: str, seed: int, minutes: float, parameters: Parameters
) -> dict[str, Any]:
    """Maps a home, is carried, and drives on."""
    before, after = (store.load(recipe) for recipe in recipes(kind, scene, seed))
    rng = np.random.Generator(np.random.PCG64([seed, 4711]))
    last = len(before.scan_times) - 1
    far = np.hypot(*(after.T_map_base[:, :2] - before.T_map_base[last, :2]).T) >= MOVED
    first = int(rng.choice(np.flatnonzero(far[: len(far) // 2])))
    mount: tuple[float, float, float] = tuple(before.T_base_sensor.tolist())
    session = Session(parameters, mount)
    session.start()
    for index in range(last + 1):
        session.add_scan(_scan(before, index, before.scan_times[index], before.T_odom_base_at_scans[index]))
    _carry(session, kind, compose(after.T_map_base[first], mount), rng)
    truth = Truth(session, before)
    time = before.scan_times[last] + (PERIOD if kind == "unannounced" else 60.0)
    end = min(len(after.scan_times), first + round(60.0 * minutes / PERIOD))
    claims, home, drives = [], [], []
    for index in range(first, end):
        odometry = compose(
            before.T_odom_base_at_scans[last],
            between(after.T_odom_base_at_scans[first], after.T_odom_base_at_scans[index]),
        )
        result = session.add_scan(_scan(after, index, time + PERIOD * (index - first), odometry))
        truth.follow()
        if result is None or (index - first) % LOOKED_AT:
            continue
        claims.append(result.tracking == "tracking")
        home.append(kind != "elsewhere" and truth.is_home(compose(after.T_map_base[index], mount)))
        step = between(after.T_map_base[max(index - LOOKED_AT, first)], after.T_map_base[index])
        drives.append(bool(np.abs(step).max() > 1e-3))
    session.stop()
    truth.follow()
    at_end = truth.error(compose(after.T_map_base[end - 1], mount))
    return _figures(np.array(claims), np.array(home), np.array(drives)) | {
        "seed": seed,
        "end_m": at_end[0],
        "end_rad": at_end[1],
        "loose": len(session.map.loose_parts),
    }


def _carry(session: Session, kind: str, T_map_sensor: Array, rng: np.random.Generator) -> None:  # noqa: N803
    if kind in ("paused", "elsewhere"):
        session.pause()
        session.resume_from_paused()
    if kind == "resumed":
        session.stop()
        distance, direction, turn = START_OFF * np.sqrt(rng.uniform()), *rng.uniform(-np.pi, np.pi, 2)
        off = np.array([distance * np.cos(direction), distance * np.sin(direction), turn])
        x, y, theta = (T_map_sensor + off).tolist()
        session.resume("", (x, y, float(wrap_angle(theta))))


def _figures(claims: Flags, home: Flags, drives: Flags) -> dict[str, Any]:
    """When it knows where it is, in seconds of driving, and how long it says that it tracks while it is elsewhere."""
    period = PERIOD * LOOKED_AT
    driven = period * np.cumsum(drives)
    known = np.flatnonzero(claims & home)
    return {
        "home_s": float(driven[known[0]]) if len(known) else None,
        "wrong_s": period * int((claims & ~home).sum()),
        "wrong_late_s": period * int((claims & ~home)[driven > IN_TIME].sum()),
    }


def recipes(kind: str, scene: str, seed: int) -> tuple[Recipe, Recipe]:
    """Of the drive that maps and of the one that goes on."""
    return Recipe(seed, scene=scene), Recipe(seed + (OTHER_HOME if kind == "elsewhere" else 0), scene=scene, way=1)


def summary(found: list[dict[str, Any]]) -> list[str]:
    home = [f["home_s"] for f in found if f["home_s"] is not None]
    in_time = sum(s <= IN_TIME for s in home)
    loose = [f for f in found if f["loose"]]
    wrong = [f for f in found if not f["loose"] and (f["end_m"] > HOME or f["end_rad"] > HOME_HEADING)]
    return [
        f"{len(found)}",
        f"{in_time} ({100.0 * in_time / max(len(found), 1):.0f} %)",
        f"{np.median(home):.1f} / {max(home):.1f}" if home else "-",
        f"{sum(f['wrong_late_s'] > 0.0 for f in found)}, {max(f['wrong_s'] for f in found):.1f}",
        f"{len(wrong)}",
        f"{len(loose)}",
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS), help="all of them by default")
    parser.add_argument("--scene", choices=SCENES, default="home", help="alike: homes whose rooms are all alike")
    parser.add_argument("--drives", type=int, default=30, metavar="N", help="drives of each kind, each in its own home")
    parser.add_argument("--first", type=int, default=101, metavar="SEED", help="the first home's seed")
    parser.add_argument("--minutes", type=float, default=5.0, metavar="T", help="that it drives on, at most")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="drives at once")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    parser.add_argument("--keep", metavar="DIR", required=True, help="where drives and results stay")
    args = parser.parse_args()
    keep, parameters = Path(args.keep), read_parameters(args.params)
    store = DriveStore(keep)
    seeds = range(args.first, args.first + args.drives)
    wanted = {recipe for kind in args.kinds for seed in seeds for recipe in recipes(kind, args.scene, seed)}
    missing = [recipe for recipe in sorted(wanted, key=str) if not store.has(recipe)]
    for _ in run_all([partial(store.make, recipe) for recipe in missing], args.jobs):
        pass
    results: dict[str, Any] = {"about": describe(args.params), "kinds": {}}
    table: dict[str, list[str]] = {}
    for kind in args.kinds:
        work: list[Callable[[], dict[str, Any]]] = [
            partial(kidnap, store, kind, args.scene, seed, args.minutes, parameters) for seed in seeds
        ]
        found: list[dict[str, Any]] = []
        for index, figures in run_all(work, args.jobs):
            if isinstance(figures, Failure):
                print(f"{kind} {seeds[index]}: {figures.reason}", file=sys.stderr)
                continue
            print(f"{kind}: {figures}", file=sys.stderr, flush=True)
            found.append(figures)
        results["kinds"][kind] = found
        (keep / "kidnapped.json").write_text(json.dumps(results, indent=1) + "\n")
        if found:
            table[KINDS[kind]] = summary(found)
    print(", ".join(f"{key} {value}" for key, value in results["about"].items()) + "\n")
    print_table(
        ("kind", "drives", "home within 30 s", "home after s, median / worst",
         "told a wrong place after 30 s, longest ever, s", "wrong at the end", "loose at the end"), table
    )  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
