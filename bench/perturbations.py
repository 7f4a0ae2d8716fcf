# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How firmly a log's map stands: the same drive with changes that should do no harm, one after the other.

    .venv/bin/python bench/perturbations.py [--logs NAME ...] [--only WORD ...] [--without-odometry] [--keep DIR]
    .venv/bin/python bench/perturbations.py --logs acapulco edmonton belgioioso --runs 12

Variants are those of trials/perturbed.py; --runs instead makes runs with other noise and another first scan. Logs have
relations, or a truth beside them; of one without, the error is how far its poses are from those of the unchanged log
(RMS), whose map is to be looked at. Poses of scans that a variant leaves out are filled in from those of the unchanged
log, seen from the last scan before. A variant is whole if its error is at most twice that of the unchanged log. Of logs
with relations it must be 0.15 m at most, too, and a thinned one may have as much in any case; without a truth it is
0.5 m.
"""

import argparse
import json
import math
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from corpus import truth_of
from oort import read_parameters
from oort.evaluation.trajectories import evaluate_ate, evaluate_relations
from oort.export import Trajectory
from oort.poses import Array, between, compose
from oort.recording import open_recording
from trials.datasets import datasets
from trials.jobs import Figures
from trials.perturbed import VARIANTS, Variant, chance_runs
from trials.replays import Replayed, counts, replay
from trials.tables import print_table
from trials.workers import Failure, run_all

_MOST = 2.0
"""times the error of the unchanged log up to which a variant is whole"""
_BROKEN = 0.15
"""[m] above which no map with relations is whole; those of sparse logs are judged by twice their own error alone"""
_ELSEWHERE = 0.5
"""[m] from the unchanged log's poses above which the map of a log without a truth is not whole"""


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--logs", nargs="+", default=["fr079", "intel", "mit-csail"], metavar="NAME")
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD", help="only variants with it in their name")
    parser.add_argument("--runs", type=int, default=0, metavar="N", help="only by chance different, instead of these")
    parser.add_argument("--max-range", type=float, metavar="M", help="drop readings from there on")
    parser.add_argument("--without-odometry", action="store_true")
    parser.add_argument("--params", help="another parameter file")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="leave results.json there")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="variants at once")
    arguments = parser.parse_args()
    of_all = chance_runs(arguments.runs) if arguments.runs else VARIANTS[1:]
    variants = [v for v in of_all if not arguments.only or any(w in v.name for w in arguments.only)]
    results = {log: run_log(log, variants, arguments) for log in arguments.logs}
    print_tables(results, (VARIANTS[0], *variants))
    if arguments.keep:
        arguments.keep.mkdir(parents=True, exist_ok=True)
        (arguments.keep / "results.json").write_text(json.dumps(results, indent=1) + "\n")


def run_log(log: str, variants: Sequence[Variant], arguments: argparse.Namespace) -> dict[str, Figures]:
    """The unchanged log, and then its variants; figures by the variant's name."""
    path, first = find(log), VARIANTS[0]
    _, unchanged = next(run_all([partial(measure, path, first, arguments)], 1))
    if isinstance(unchanged, Failure):
        raise SystemExit(f"{log}: {unchanged.reason}")
    results = {first.name: unchanged[0]}
    tell(log, first.name, unchanged[0])
    work = [partial(measure, path, variant, arguments, unchanged[1]) for variant in variants]
    for index, result in run_all(work, arguments.jobs):
        name = variants[index].name
        if isinstance(result, Failure):
            print(f"{log}, {name}: failed: {result.reason}", flush=True)
        else:
            results[name] = result[0]
            tell(log, name, result[0])
    return results


def find(log: str) -> Path:
    """The recording of that name."""
    for folder in ("radish", "sparse"):
        if (path := datasets() / folder / f"{log}.clf.bz2").exists():
            return path
    raise SystemExit(f"{log}: no such log in radish/ or sparse/ of OORT_DATASETS")


def measure(
    path: Path, variant: Variant, arguments: argparse.Namespace, unchanged: Array | None = None
) -> tuple[Figures, Array]:
    """The errors of a variant, and its poses at all scans of the log."""
    parameters = read_parameters(arguments.params) if arguments.params else read_parameters()
    if arguments.without_odometry:
        parameters.set("use_odometry", False)
    for name, factor in variant.factors.items():
        parameters.set(name, factor * float(parameters.get(name)))
    recording = open_recording(path, max_range=arguments.max_range)
    whole = list(recording.scans())
    changed = variant.applied(recording)
    started = time.process_time()
    replayed = replay(changed, parameters)
    seconds = time.process_time() - started
    stamps = [scan.stamp for scan in whole]
    poses = filled(replayed, variant, stamps, unchanged)
    odometry = np.array([scan.odometry for scan in whole])
    figures = counts(replayed) | {
        "cpu_s": seconds,
        "error_odometry": error_of(path, stamps, odometry, unchanged)["error"],
    }
    figures |= error_of(path, stamps, poses, unchanged) | {"thinned": float(variant.is_thinned)}
    if unchanged is not None:
        ours, theirs = (Trajectory(tuple(f"{t}.0" for t in range(len(p))), p) for p in (poses, unchanged))
        figures["apart"] = evaluate_ate(ours, theirs).position_max
    return figures, poses


def filled(replayed: Replayed, variant: Variant, stamps: list[str], unchanged: Array | None) -> Array:
    """Poses (n, 3) at all scans of the log; of those left out from the last before, as the unchanged log has them."""
    known = dict(zip(replayed.drive.recorder.stamps, variant.undo(replayed.T_map_base), strict=True))
    places = [i for i, stamp in enumerate(stamps) if stamp in known]
    poses = np.full((len(stamps), 3), math.nan)
    poses[places] = [known[stamps[i]] for i in places]
    if len(places) == len(stamps):
        return poses
    assert unchanged is not None
    before = np.array(places)[np.maximum(np.searchsorted(places, np.arange(len(stamps)), side="right") - 1, 0)]
    return compose(poses[before], between(unchanged[before], unchanged))


def error_of(path: Path, stamps: list[str], poses: Array, unchanged: Array | None) -> Figures:
    """Of poses at all scans: mean over relations, else the ATE, without a truth against the unchanged log's poses."""
    trajectory = Trajectory(tuple(stamps), poses)
    relations = path.with_name(path.name.replace(".clf.bz2", ".relations"))
    if relations.exists():
        result = evaluate_relations(trajectory, relations)
        return {
            "error": result.translation_mean,
            "degrees": result.rotation_mean,
            "worst": result.translation_max,
            "most": _BROKEN,
        }
    truth = truth_of(path.with_name(path.name.replace(".clf.bz2", "")))
    most = math.inf if truth is not None else _ELSEWHERE
    if truth is None:
        truth = Trajectory(trajectory.stamps, poses if unchanged is None else unchanged)
    ate = evaluate_ate(trajectory, truth)
    return {
        "error": ate.position_rmse,
        "degrees": ate.heading_rmse,
        "worst": ate.position_max,
        "most": most,
    }


def is_whole(figures: Figures, unchanged: Figures) -> bool:
    """Whether a variant's map is as good as one may ask."""
    most = figures["most"]
    if most == _ELSEWHERE or (figures["thinned"] and most == _BROKEN):
        return figures["error"] <= most
    return figures["error"] <= min(most, _MOST * unchanged["error"])


def tell(log: str, name: str, f: Figures) -> None:
    """A line for a variant that is done."""
    print(
        f"{log}, {name}: {f['error']:.4f} m, {f['degrees']:.3f} deg, worst {f['worst']:.2f}, apart "
        f"{f.get('apart', 0.0):.2f}, by odometry {f['odometry_links']:.0f}, closures {f['closures_on']:.0f} / "
        f"{f['closures_off']:.0f}, {f['cpu_s']:.1f} CPU s",
        flush=True,
    )


def print_tables(results: dict[str, dict[str, Figures]], variants: Sequence[Variant]) -> None:
    """Errors of all variants, their median and worst, and how many are whole."""

    def cell(log: str, name: str) -> str:
        if name not in results[log]:
            return "failed"
        f, unchanged = results[log][name], results[log]["as it is"]
        text = f"{f['error']:.3f} m, {f['degrees']:.2f}°"
        return text if is_whole(f, unchanged) else f"**{text}**"

    names = [v.name for v in variants if any(v.name in rows for rows in results.values())]
    print_table(("variant", *results), {name: [cell(log, name) for log in results] for name in names})
    for log, rows in results.items():
        whole = sum(is_whole(f, rows["as it is"]) for f in rows.values())
        errors = [f["error"] for f in rows.values()]
        print(f"{log}: {whole} of {len(rows)} whole, median {np.median(errors):.3f} m, worst {max(errors):.3f}")


if __name__ == "__main__":
    main()
