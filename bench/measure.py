# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Accuracy and cost on real logs and made-up homes: prints one table.

    .venv/bin/python bench/measure.py [--logs] [--homes N] [--odometry-error F] [--params FILE] [--keep DIR]

Without a choice it runs both. The logs are found through OORT_DATASETS (default ../shared/datasets).
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from oort.evaluate import evaluate_ate, evaluate_relations
from oort.export import read_tum
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive

ROOT = Path(__file__).resolve().parents[1]


class Log(NamedTuple):
    name: str
    max_range: float | None


LOGS = [Log("fr079", None), Log("intel", None), Log("fr079", 3.0), Log("intel", 3.0)]


def run(recording: Path, out: Path, *options: str) -> dict[str, Any]:
    """Replays one recording into `out`, in a process of its own, and returns its report."""
    command = [sys.executable, "-m", "oort.replay", str(recording), "--out", str(out), "--quiet", *options]
    subprocess.run(command, check=True)
    report: dict[str, Any] = json.loads((out / "report.json").read_text())
    return report


def cost(report: dict[str, Any]) -> str:
    timings, per_scan = report["timings"], report["timings"]["ms_per_scan"]
    return (
        f"{timings['cpu_seconds']:.1f} | {per_scan['mean']:.2f} / {per_scan['p50']:.2f} / {per_scan['p99']:.1f} | "
        f"{timings['peak_memory_mb']:.0f}"
    )


def measure_logs(out: Path, options: list[str]) -> Iterator[str]:
    folder = Path(os.environ.get("OORT_DATASETS", ROOT / "../shared/datasets")) / "radish"
    yield "| log | range, m | error, m | deg | scans | nodes | closures on | CPU s | ms/scan mean / P50 / P99 | MB |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for log in LOGS:
        result = out / f"{log.name}-{log.max_range or 'full'}"
        limit = ["--max-range", str(log.max_range)] if log.max_range else []
        report = run(folder / f"{log.name}.clf.bz2", result, *limit, *options)
        error = evaluate_relations(read_tum(result / "trajectory.tum"), folder / f"{log.name}.relations")
        on = report["map"]["switchable_edges"] - report["map"]["switched_off"]
        yield (
            f"| {log.name} | {log.max_range or 'full'} | {error.translation_mean:.4f} ± {error.translation_std:.4f} | "
            f"{error.rotation_mean:.3f} | {report['scans']} | {report['nodes']} | {on} | {cost(report)} |"
        )


def measure_homes(out: Path, options: list[str], count: int, odometry_error: float) -> Iterator[str]:
    yield "| home | ATE, m | max, m | heading, deg | scans | dock closures | CPU s | ms/scan mean / P50 / P99 | MB |"
    yield "|---|---|---|---|---|---|---|---|---|"
    errors = []
    for seed in range(1, count + 1):
        folder = out / f"home-{seed}"
        write_drive(
            simulate_drive(seed, SimulationConfig(odometry_error=odometry_error)), folder, "home", picture=False
        )
        report = run(folder / "home.clf", folder, "--events", str(folder / "home.events.json"), *options)
        error = evaluate_ate(read_tum(folder / "trajectory.tum"), read_tum(folder / "home.truth.tum"))
        errors.append(error.position_rmse)
        yield (
            f"| {seed} | {error.position_rmse:.4f} | {error.position_max:.4f} | {error.heading_rmse:.3f} | "
            f"{report['scans']} | {report['docks']['accepted']} of {report['docks']['tried']} | {cost(report)} |"
        )
    yield f"ATE over {count} homes: median {statistics.median(errors):.4f} m, worst {max(errors):.4f} m"


def describe_run(parameters: str | None) -> str:
    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()

    changed = " with changes" if git("status", "--porcelain") else ""
    return f"commit {git('rev-parse', '--short', 'HEAD')}{changed}, {parameters or 'params.json'}, {platform.machine()}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--logs", action="store_true", help="only the real logs")
    parser.add_argument("--homes", type=int, metavar="N", help="only made-up homes, this many")
    parser.add_argument(
        "--odometry-error", type=float, default=1.0, metavar="F", help="of the homes' base; 1: a good one"
    )
    parser.add_argument("--params", metavar="FILE")
    parser.add_argument("--keep", metavar="DIR", help="where to leave the results (default: nowhere)")
    args = parser.parse_args()
    options = ["--params", args.params] if args.params else []
    print(describe_run(args.params))
    with tempfile.TemporaryDirectory() as scratch:
        out = Path(args.keep or scratch)
        if args.logs or args.homes is None:
            print(*measure_logs(out, options), sep="\n", flush=True)
        if args.homes is not None or not args.logs:
            print(*measure_homes(out, options, args.homes or 20, args.odometry_error), sep="\n", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
