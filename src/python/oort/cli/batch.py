# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort batch RECORDING...``: maps many recordings in parallel, into one table and one page."""

import argparse
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from oort.cli.tool import Parser, add_json_argument, add_worker_arguments, print_result, run_tool
from oort.errors import InputError
from oort.export.files import write_atomically
from oort.offline.batch import Outcome, make_jobs, run_batch, write_table
from oort.offline.progress import time_left
from oort.parameters import read_parameters
from oort.report.index_page import make_index_page


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort batch",
        description="Maps many recordings, each in a process of its own, and writes a table (batch.json) and a page "
        "(index.html) of them all. Interrupted, it goes on where it was when called again; a recording or parameters "
        "that changed are done anew. Example: oort batch fleet/*.bag --out fleet-maps",
    )
    parser.add_argument(
        "recordings", metavar="RECORDING", nargs="+", help="bags, MCAP files, CARMEN logs; or URLs that fsspec knows"
    )
    parser.add_argument("--out", metavar="DIR", default="oort-batch", help="where all goes (default: oort-batch)")
    add_worker_arguments(parser)
    parser.add_argument("--params", metavar="FILE", help="parameters for all (default: the packaged params.json)")
    add_json_argument(parser)
    return parser


def _tell(outcome: Outcome, done: int, total: int, left: str) -> None:
    what = outcome.error or ("was done before" if outcome.kept else f"{outcome.figures['nodes']} nodes")
    print(f"[{done}/{total}{left}] {Path(outcome.folder).name}: {what}", flush=True)


def _run(args: argparse.Namespace) -> None:
    if args.params:
        read_parameters(args.params)  # an error of theirs is told once, not by each drive
    out = Path(args.out)
    jobs = make_jobs(args.recordings, out, Path(args.params).read_text() if args.params else None)
    out.mkdir(parents=True, exist_ok=True)
    outcomes: list[Outcome] = []
    started = time.monotonic()
    for outcome in run_batch(jobs, args.jobs, args.cluster):
        outcomes.append(outcome)
        if not args.json:
            quick = sum(each.kept or each.error is not None for each in outcomes)  # these took no time
            _tell(outcome, len(outcomes), len(jobs), time_left(started, len(outcomes) - quick, len(jobs) - quick))
    write_table(outcomes, out)
    rows = [{"name": Path(o.folder).name, **asdict(o)} for o in sorted(outcomes, key=lambda o: o.recording)]
    write_atomically(out / "index.html", make_index_page(rows))
    failed = sum(outcome.error is not None for outcome in outcomes)
    print_result(args, rows, f"{len(outcomes) - failed} of {len(outcomes)} mapped; open {out / 'index.html'}")
    if failed == len(outcomes):
        raise InputError("no recording could be mapped")


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed, or if no drive was mapped."""
    args = _parser().parse_args(argv)
    return run_tool("oort batch", lambda: _run(args))
