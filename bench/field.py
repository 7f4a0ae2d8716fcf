# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Runs cases from public reports of robots' owners, a row for each: is it mapped, or its trouble named?

    OORT_CASES=/path/to/cases/field .venv/bin/python bench/field.py [CASE ...]

The cases are small recordings and scripts that spoil simulated drives; bench/README.md tells of them. A row passes by
its criterion alone: an error against the truth, a code in report.json's troubles, or words in what the tool prints.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

CASES = Path(os.environ.get("OORT_CASES", ""))


@dataclass
class Run:
    """What a tool left."""

    code: int
    text: str
    out: Path

    @property
    def report(self) -> dict[str, Any]:
        """report.json, or nothing."""
        path = self.out / "report.json"
        return json.loads(path.read_text()) if path.is_file() else {}

    @property
    def troubles(self) -> list[str]:
        """Codes of the trouble list."""
        return [trouble["code"] for trouble in self.report.get("troubles", [])]


Judge = Callable[[Run], tuple[bool, str]]
"""Whether a run passes, and the figure or the words that say so."""


@dataclass(frozen=True)
class Row:
    """One input of a case."""

    case: str
    name: str
    criterion: str
    tool: Sequence[str]
    judge: Judge
    prepare: Sequence[Sequence[str]] = field(default_factory=list)
    """commands that make the input, in the working folder"""


def python(*args: str) -> list[str]:
    """A command of this interpreter."""
    return [sys.executable, *args]


def ate(truth: str, most: float) -> Judge:
    """The position's RMSE [m] against a truth."""

    def judge(run: Run) -> tuple[bool, str]:
        told = subprocess.run(
            python("-m", "oort.evaluate", "ate", str(run.out / "trajectory.tum"), str(run.out.parent / truth)),
            capture_output=True,
            text=True,
            check=False,
        ).stdout
        found = re.search(r"position\s+rmse (\S+) m", told)
        return (found is not None and float(found[1]) <= most), (f"{found[1]} m" if found else "no map")

    return judge


def says(words: str) -> Judge:
    """Words (a regular expression) in what is printed."""
    return lambda run: (
        (found := re.search(words, run.text)) is not None,
        found[0] if found else run.text[-80:].strip(),
    )


def names(code: str) -> Judge:
    """A code of the trouble list."""
    return lambda run: (code in run.troubles, ", ".join(run.troubles) or "nothing")


def both(first: Judge, second: Judge) -> Judge:
    """Two criteria."""

    def judge(run: Run) -> tuple[bool, str]:
        (a, told), (b, also) = first(run), second(run)
        return a and b, f"{told}; {also}"

    return judge


def replay(path: str, *options: str) -> list[str]:
    """A replay into the folder "out"."""
    return python("-m", "oort.replay", path, "--out", "out", *options)


def spoiled(fault: str, seed: int = 7) -> list[list[str]]:
    """A simulated drive, edited."""
    script = str(CASES / "body_returns" / "edit_clf.py")
    return [["sh", "-c", f"{sys.executable} {script} {fault} < ../home_{seed}.clf > {fault}.clf"]]


def bag(name: str, case: str = "no_mount") -> list[list[str]]:
    """A bag of a simulated drive, spoiled."""
    return [python(str(CASES / case / "make_bag.py"), "../home_7.bag", name)]


def rows() -> list[Row]:
    """All rows."""
    truth = "../home_7.truth.tum"
    made = []
    for seed in (7, 1, 3):
        sweep = python(str(CASES / "rplidar_sweep" / "make.py"), f"../lds_{seed}.bag", f"../lds_{seed}.truth.tum")
        judge = both(ate("driver.truth.tum", 0.02), names("beam_order"))
        made.append(
            Row("rplidar_sweep", f"driver {seed}", "RMSE <= 0.02 m, told", replay("driver.bag"), judge, [sweep])
        )
    for name, judge in (("turtlebot4", names("beam_order")), ("turtlebot4_reversed", _nothing_of("beam_order"))):
        path = str(CASES / "rplidar_sweep" / f"{name}.bag")
        made.append(Row("rplidar_sweep", name, "the order is told, if wrong", replay(path), judge))
    for fault in ("body5", "body10", "body20"):
        judge = both(ate(truth, 0.03), names("body_in_view"))
        made.append(Row("body_returns", fault, "RMSE <= 0.03 m, told", replay(f"{fault}.clf"), judge, spoiled(fault)))
    for fault, code in (
        ("static", "odometry_static"),
        ("turnsign", "turn_sign"),
        ("mirror", "turn_sign"),
        ("yaw180", "mount_yaw"),
        ("late1", "clock_offset"),
    ):
        row = Row("contradicting_setup", fault, f"{code} is named", replay(f"{fault}.clf"), names(code), spoiled(fault))
        made.append(row)
    for fault in ("reset", "jump3"):
        judge = both(ate(truth, 0.03), names("odometry_jump"))
        made.append(Row("odom_reset", fault, "RMSE <= 0.03 m, told", replay(f"{fault}.clf"), judge, spoiled(fault)))
    judge = both(ate(truth, 0.02), says("taken for no return"))
    made.append(Row("no_return_code", "code51", "RMSE <= 0.02 m, told", replay("code51.clf"), judge, spoiled("code51")))
    for name, words in (
        ("degrees", "radians, but look like degrees"),
        ("millimetres", "look like millimetres"),
        ("millimetres_all", "look like millimetres"),
    ):
        row = Row("bad_scan_fields", name, "the field is named", replay(f"{name}.bag"), says(words), bag(name))
        made.append(row)
    for name in ("increment_0", "range_max_0"):
        judge = both(ate(truth, 0.03), says("note: .*(angle_increment of 0|range_max is 0)"))
        made.append(Row("bad_scan_fields", name, "RMSE <= 0.03 m, told", replay(f"{name}.bag"), judge, bag(name)))
    static = Row(
        "bad_scan_fields",
        "static_odom_ros2",
        "static odometry is named",
        replay("static_odom_ros2"),
        says("static transform"),
        bag("static_odom_ros2"),
    )
    made.append(static)
    for name in ("only_scan_and_odom", "footprint_gap", "empty_child", "two_mounts"):
        row = Row("no_mount", name, "the way on is named", replay(f"{name}.bag"), says("--mount X Y THETA"), bag(name))
        judge = ate(truth, 0.03)
        mounted = replay(f"{name}.bag", "--mount", "0.109", "0", "0")
        made += [row, Row("no_mount", f"{name}, --mount", "RMSE <= 0.03 m", mounted, judge, bag(name))]
    frames = says("scans in 2 frames: front, rear; all lasers are used")
    made.append(
        Row("several_frames", "two_frames", "both are used", replay("two_frames.bag"), frames, bag("two_frames"))
    )
    return made + _files()


def _nothing_of(code: str) -> Judge:
    return lambda run: (run.code == 0 and code not in run.troubles, ", ".join(run.troubles) or "nothing")


def _files() -> list[Row]:
    folder = CASES / "containers"
    made = [
        Row("containers", name, criterion, replay(str(folder / name)), says(words))
        for name, criterion, words in (
            ("rosbag_v12.bag", "the old format is named", "1\\.2"),
            ("lfs.db3", "the pointer is named", "Git LFS"),
            ("mcap_cut", "what is whole is mapped", "note: .*cut|nodes +\\d"),
            ("no_storage_id", "mapped", "nodes +\\d+"),
            ("no_metadata", "mapped", "nodes +\\d+"),
            ("drive.bag.gz", "mapped", "nodes +\\d+"),
        )
    ]
    toro = python("-m", "oort.graph", "solve", str(CASES / "toro_graph" / "triangle.graph"), "out.g2o")
    made.append(Row("toro_graph", "triangle.graph", "solved", toro, says("chi2|edges")))
    image = str(CASES / "map_server_map" / "map.yaml")
    localize = python("-m", "oort.localize", image, str(folder / "drive.bag.gz"), "--out", "out")
    made.append(Row("map_server_map", "map.yaml", "named or used", localize, says("image for map_server|wrote out")))
    pen = CASES / "flipped_pen"
    mapped = replay(str(pen / "left_side.bag"), "--map", str(Path("pen").resolve().name))
    onto = python("-m", "oort.localize", "pen", str(pen / "middle.bag"), "--out", "out")
    made.append(Row("flipped_pen", "middle on left_side", "not half a turn off", onto, _not_flipped, [mapped]))
    return made


def _not_flipped(run: Run) -> tuple[bool, str]:
    path = run.out / "trajectory.tum"
    first = path.read_text().split()[:8] if path.is_file() else []
    if not first:
        return True, "no answer"
    x, y, z, w = float(first[1]), float(first[2]), float(first[6]), float(first[7])
    return abs(z) > abs(w), f"at ({x:.2f}, {y:.2f}), {'turned' if abs(z) > abs(w) else 'flipped'}"


def run_row(row: Row, folder: Path) -> tuple[bool, str]:
    """Prepares a row's input, runs its tool and judges."""
    folder.mkdir()
    for command in row.prepare:
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
    done = subprocess.run(row.tool, cwd=folder, capture_output=True, text=True, check=False)
    return row.judge(Run(done.returncode, done.stdout + done.stderr, folder / "out"))


def main(argv: Sequence[str]) -> int:
    """Prints the table; the exit status is 1 if a row fails."""
    if not (CASES / "rplidar_sweep").is_dir():
        print("OORT_CASES must name the folder of the cases of the field", file=sys.stderr)
        return 2
    chosen = [row for row in rows() if not argv or row.case in argv]
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        simulate = python("-m", "oort.simulate", "--no-picture", "--out", str(root))
        subprocess.run([*simulate, "--seed", "7"], check=True, capture_output=True)
        for seed in (7, 1, 3) if any(row.case == "rplidar_sweep" for row in chosen) else ():
            lidar = ["--fov", "360", "--beams", "360", "--max-range", "8", "--sweep", "0.1", "--name", f"lds_{seed}"]
            subprocess.run([*simulate, "--seed", str(seed), *lidar], check=True, capture_output=True)
        print("| case | input | criterion | verdict | what came |\n| --- | --- | --- | --- | --- |")
        for number, row in enumerate(chosen):
            passed, told = run_row(row, root / str(number))
            failed += not passed
            print(f"| {row.case} | {row.name} | {row.criterion} | {'ok' if passed else 'FAIL'} | {told} |", flush=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
