# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort tune RECORDING...``: searches parameters with which a set of recordings maps better."""

import argparse
import json
import time
from collections.abc import Generator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from oort._core import Parameters
from oort.cli.tool import Parser, add_json_argument, add_worker_arguments, number, print_steps, run_tool
from oort.errors import InputError
from oort.export.files import write_atomically
from oort.offline.progress import time_left
from oort.offline.scoring import Score
from oort.offline.search_space import parse_axis
from oort.offline.tune import Search, Task, Tried
from oort.offline.workers import open_pool
from oort.parameters import read_parameters
from oort.parameters.writer import to_json

_UNITS = {"truth": "m off the truth", "relations": "m of the relations", "agreement": "of contradiction with itself"}


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort tune",
        description="Searches values of some parameters with which a set of recordings maps better: nearer to the "
        "truth beside a recording (NAME.truth.tum), to its relations (NAME.relations), or with fewer contradictions of "
        "the map with itself. Interrupted, it goes on where it was when called again. Example: oort tune "
        "fleet/*.bag --search linear_update --search switchable_constraint_scale=1..20 --check other/*.bag",
    )
    parser.add_argument("recordings", metavar="RECORDING", nargs="+", help="paths, or URLs that fsspec knows")
    parser.add_argument(
        "--search",
        metavar="KEY[=LOW..HIGH]",
        action="append",
        required=True,
        help="a key of docs/parameters.md to search, by default between a quarter and four times its value; "
        "KEY=ONE,OTHER of a choice; may be given often",
    )
    parser.add_argument("--params", metavar="FILE", help="where to start from (default: the packaged params.json)")
    parser.add_argument("--trials", metavar="N", type=int, default=40, help="sets of values to try (default: 40)")
    parser.add_argument(
        "--check", metavar="RECORDING", nargs="+", default=[], help="recordings that only judge what was found"
    )
    parser.add_argument("--out", metavar="DIR", default="oort-tune", help="where all goes (default: oort-tune)")
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="of the search's random numbers")
    parser.add_argument("--at-once", metavar="N", type=number, default=1, help="trials in a round (default: 1)")
    add_worker_arguments(parser)
    add_json_argument(parser)
    return parser


def _search(args: argparse.Namespace) -> Generator[str, None, dict[str, Any]]:
    """Yields what to print on the way and returns what tune.json holds."""
    if args.trials < 1:
        raise InputError(f"--trials {args.trials}: a search takes one trial or more")
    start = read_parameters(args.params)
    axes = tuple(parse_axis(text, start) for text in args.search)
    task = Task(tuple(args.recordings), start, axes, args.seed, args.at_once)
    out = Path(args.out)
    with open_pool(args.jobs, args.cluster) as pool:
        search = Search(task, out, pool)
        if all(score.kind == "failed" for score in search.start_scores.values()):
            yield "no recording can be mapped with the parameters to start from"
        tried: list[Tried] = []
        started = time.monotonic()
        for one in search.run(args.trials):
            tried.append(one)
            best = min(tried, key=lambda t: t.error)
            left = time_left(started, len(tried), args.trials)
            yield f"[{len(tried)}/{args.trials}] error {one.error:.3f} of the start's, best {best.error:.3f}{left}"
        best = min(tried, key=lambda t: t.error)
        if best.error >= 1.0:
            raise InputError(
                f"none of {len(tried)} trials is better than the start; nothing was written but the trials"
            )
        parameters = search.with_values(best.values)
        names = [*args.recordings, *args.check]
        before, after = search.scores(names, start), search.scores(names, parameters)
    lines = _found(best, tried, (before, after), args.check)
    yield from lines
    told = _write(out, parameters, best, tried, (before, after), args.check, lines)
    yield f"wrote {out / 'params.json'}: use it with --params; {out / 'tune.json'} has every trial"
    return told


Scores = tuple[Mapping[str, Score], Mapping[str, Score]]
"""before and after"""


def _found(best: Tried, tried: Sequence[Tried], scores: Scores, check: Sequence[str]) -> list[str]:
    """What was found, as lines."""
    before, after = scores
    lines = [f"found by oort tune in {len(tried)} trials: {best.error:.3f} of the error of the start"]
    for name in before:
        role = " (not searched on)" if name in check else ""
        lines.append(f"{Path(name).name}{role}: {_said(before[name])} before, {_said(after[name])} with these values")
    return lines


def _write(
    out: Path,
    parameters: Parameters,
    best: Tried,
    tried: Sequence[Tried],
    scores: Scores,
    check: Sequence[str],
    lines: Sequence[str],
) -> dict[str, Any]:
    """Writes params.json, whose comments are the lines, and tune.json; returns what that holds."""
    before, after = scores
    changed = {path: value for path, value in parameters.to_dict().items() if value != Parameters().get(path)}
    comments = "".join(f"# {line}\n" for line in lines)
    write_atomically(out / "params.json", (comments + to_json(changed)).encode())
    told: dict[str, Any] = {
        "best": asdict(best),
        "recordings": [
            {"recording": name, "searched_on": name not in check, "before": asdict(one), "after": asdict(after[name])}
            for name, one in before.items()
        ],
        "trials": [asdict(one) for one in tried],
    }
    write_atomically(out / "tune.json", (json.dumps(told, indent=1) + "\n").encode())
    return told


def _said(score: Score) -> str:
    if score.kind == "failed":
        return f"not mapped ({score.why})"
    return f"{score.error:.4f} {_UNITS[score.kind]}"


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort tune", lambda: print_steps(args, _search(args)))
