# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps many recordings, each in a process of its own: a drive that fails, or is killed, costs no other."""

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from oort.errors import InputError, OortError
from oort.export.files import write_atomically

_STATE = "batch.json"  # within a drive's folder: what it was made from; written last


@dataclass(frozen=True)
class Job:
    """One recording of a batch."""

    recording: str
    folder: Path
    """where its results go"""
    options: tuple[str, ...] = ()
    """of the replay"""

    @property
    def key(self) -> str:
        """What its results depend on: another key makes them anew."""
        stat = os.stat(self.recording)
        told = [os.path.abspath(self.recording), stat.st_size, stat.st_mtime_ns, *self.options]
        told += [Path(word).read_bytes().hex() for word in self.options if os.path.isfile(word)]
        return hashlib.sha256(json.dumps(told).encode()).hexdigest()


@dataclass(frozen=True)
class Outcome:
    """What became of one recording."""

    recording: str
    folder: str
    error: str | None
    """a sentence, if it could not be mapped"""
    figures: dict[str, Any]
    """of its report.json"""
    kept: bool = False
    """whether it was there already"""


def make_jobs(recordings: Sequence[str], out: Path, options: Sequence[str] = ()) -> list[Job]:
    """A job per recording, each with a folder of its own name. Raises InputError for a missing or doubled one."""
    jobs: dict[str, Job] = {}
    for recording in recordings:
        if not os.path.exists(recording):
            raise InputError(f"{recording} does not exist")
        name = Path(recording).name.split(".")[0] or Path(recording).name
        if name in jobs:  # two folders with recordings of one name
            name = f"{Path(recording).absolute().parent.name}-{name}"
        if name in jobs:
            raise InputError(f"{recording} and {jobs[name].recording} would have one folder, {out / name}; rename one")
        jobs[name] = Job(recording, out / name, tuple(options))
    if not jobs:
        raise InputError("no recording was named")
    return list(jobs.values())


def run_batch(jobs: Sequence[Job], workers: int) -> Iterator[Outcome]:
    """Runs jobs, so many at a time, and yields their outcomes as they come. What was done before is not done again."""
    with ThreadPoolExecutor(workers) as pool:
        futures = [pool.submit(run_job, job) for job in jobs]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def run_job(job: Job) -> Outcome:
    """Runs one job in a process of its own, unless its results are there."""
    state = job.folder / _STATE
    try:
        if _read(state).get("key") == job.key:
            return Outcome(job.recording, str(job.folder), None, _figures(job.folder), kept=True)
        command = [
            sys.executable,
            "-m",
            "oort.replay",
            job.recording,
            "--out",
            str(job.folder),
            "--quiet",
            *job.options,
        ]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or [f"ended with status {done.returncode}"])[-1]
            return Outcome(job.recording, str(job.folder), last.removeprefix("oort replay: "), {})
        figures = _figures(job.folder)
        write_atomically(state, json.dumps({"key": job.key}).encode())
        return Outcome(job.recording, str(job.folder), None, figures)
    except (OSError, OortError) as error:
        return Outcome(job.recording, str(job.folder), str(error), {})


def write_table(outcomes: Sequence[Outcome], out: Path) -> None:
    """Writes batch.json: the outcomes in the order of their recordings. Raises OortError if it cannot."""
    rows = [asdict(outcome) for outcome in sorted(outcomes, key=lambda outcome: outcome.recording)]
    write_atomically(out / "batch.json", (json.dumps(rows, indent=1) + "\n").encode())


def _figures(folder: Path) -> dict[str, Any]:
    report = _read(folder / "report.json")
    if not report:
        raise InputError(f"{folder / 'report.json'} is missing or damaged, though the replay ended well")
    timings, tracking = report["timings"], report["tracking"]
    return {
        "scans": report["scans"],
        "nodes": report["nodes"],
        "closures": report["loops"]["accepted"],
        "uncertain": (tracking["uncertain"] + tracking["lost"]) / max(1, report["scans"]),
        "recorded_seconds": report["recorded_seconds"],
        "cpu_seconds": timings["cpu_seconds"],
        "worst_ms": timings["ms_per_scan"]["max"],
    }


def _read(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}
