# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Accuracy, closures, calibration and cost on real logs and simulated drives with the truth at hand, row by row.

    .venv/bin/python bench/accuracy.py [--rows NAME ...] [--homes N] [--jobs N] [--params FILE] [--keep DIR]
    .venv/bin/python bench/accuracy.py --compare OLD.json NEW.json

Prints tables and writes results.json into --keep; simulated drives are kept there too and made only once. The logs are
found through OORT_DATASETS. --worst K leaves maps and pictures of the K worst simulated drives of each row.
"""

import argparse
import hashlib
import json
import os
import platform
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

from oort import _core, read_parameters
from trials.drives import DriveStore, Recipe, simulator_state
from trials.jobs import ROOT, Bench, Figures
from trials.rows import ROWS, Row
from trials.tables import comparison, tables
from trials.workers import Failure, run_all


def measure_row(bench: Bench, row: Row, homes: int, at_once: int) -> dict[str, Any]:
    """Runs all drives of a row; what went wrong is told and left out."""
    jobs = row.jobs(homes)
    missing = [job.source for job in jobs if isinstance(job.source, Recipe) and not bench.store.has(job.source)]
    for done, (index, made) in enumerate(run_all([partial(bench.store.make, r) for r in missing], at_once), start=1):
        _say(f"simulated {done} of {len(missing)}: {missing[index].name}", made)
    drives: dict[str, Figures] = {}
    failed: dict[str, str] = {}
    for done, (index, result) in enumerate(run_all([partial(bench.run, job) for job in jobs], at_once), start=1):
        name = jobs[index].name
        if isinstance(result, Failure):
            failed[name] = result.reason
            _say(f"{done} of {len(jobs)}: {name}", result)
        else:
            drives[name] = result
            _say(f"{done} of {len(jobs)}: {name}: {row.rank} {result[row.rank]:.4f}, {result['cpu_s']:.1f} CPU s", None)
    drives = {job.name: drives[job.name] for job in jobs if job.name in drives}
    return {"summary": row.summarise(drives) if drives else {}, "drives": drives, "failed": failed}


def draw_worst(bench: Bench, row: Row, drives: dict[str, Figures], homes: int, count: int, at_once: int) -> None:
    """Leaves maps and pictures of the worst simulated drives of a row."""
    jobs = {job.name: job for job in row.jobs(homes) if isinstance(job.source, Recipe)}
    worst = sorted(jobs.keys() & drives.keys(), key=lambda name: (-drives[name][row.rank], name))[:count]
    for index, drawn in run_all([partial(bench.draw, jobs[name]) for name in worst], at_once):
        _say(f"drawn: {bench.keep / worst[index]}", drawn)


def _say(what: str, result: object) -> None:
    print(f"{what}: {result.reason}" if isinstance(result, Failure) else what, file=sys.stderr, flush=True)


def describe(parameters: str | None) -> dict[str, str]:
    """What was measured, and on what."""

    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()

    assert _core.__file__
    return {
        "commit": git("rev-parse", "--short", "HEAD") + (" with changes" if git("status", "--porcelain") else ""),
        "engine": hashlib.sha256(Path(_core.__file__).read_bytes()).hexdigest()[:12],
        "simulator": simulator_state(),
        "parameters": parameters or "params.json",
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }


def compare(old_path: str, new_path: str) -> None:
    """Prints what differs between two results files."""
    old, new = (json.loads(Path(path).read_text()) for path in (old_path, new_path))
    for key, value in new["about"].items():
        print(f"{key}: {old['about'].get(key)} -> {value}")
    print(*comparison(old["rows"], new["rows"], {row.name: row.rank for row in ROWS}), sep="\n")


def _parser() -> argparse.ArgumentParser:
    names = [row.name for row in ROWS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", nargs="+", choices=names, default=names, metavar="ROW", help=", ".join(names))
    parser.add_argument("--homes", type=int, default=50, metavar="N", help="seeds 1 to N of simulated drives")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="drives at once")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    parser.add_argument("--keep", metavar="DIR", help="where results and simulated drives stay (default: nowhere)")
    parser.add_argument("--worst", type=int, default=0, metavar="K", help="draw the K worst drives of each row")
    parser.add_argument("--compare", nargs=2, metavar=("OLD", "NEW"), help="two results files")
    return parser


def main() -> int:
    args = _parser().parse_args()
    if args.compare:
        compare(*args.compare)
        return 0
    with tempfile.TemporaryDirectory() as scratch:
        keep = Path(args.keep or scratch)
        bench = Bench(DriveStore(keep), read_parameters(args.params), keep)
        results: dict[str, Any] = {"about": describe(args.params), "rows": {}}
        for row in ROWS:
            if row.name not in args.rows:
                continue
            measured = results["rows"][row.name] = measure_row(bench, row, args.homes, args.jobs)
            (keep / "results.json").write_text(json.dumps(results, indent=1) + "\n")
            draw_worst(bench, row, measured["drives"], args.homes, args.worst, args.jobs)
    print(", ".join(f"{key} {value}" for key, value in results["about"].items()))
    print(*tables(results["rows"]), sep="\n")
    return int(any(row["failed"] for row in results["rows"].values()))


if __name__ == "__main__":
    sys.exit(main())
