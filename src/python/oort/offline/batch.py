# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps many recordings, each in a process of its own: a drive that fails, or is killed, costs no other."""

import hashlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from oort.errors import InputError, OortError
from oort.export.files import write_atomically
from oort.offline.workers import fingerprint, in_pool, local_copy, open_pool

_STATE = "batch.json"  # within a drive's folder: what it was made from; written last


@dataclass(frozen=True)
class Job:
    """One recording of a batch."""

    recording: str
    """its path or URL, as whoever maps it sees it"""
    folder: Path
    """where its results go"""
    parameters: str | None = None
    """the text of a parameter file; the packaged ones if None"""

    @property
    def key(self) -> str:
        """What its results depend on: another key makes them anew. Raises InputError if the recording is gone."""
        return hashlib.sha256(f"{fingerprint(self.recording)} {self.parameters}".encode()).hexdigest()


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


@dataclass(frozen=True)
class _Mapped:
    """What a worker sends back."""

    error: str | None
    files: dict[str, bytes]
    """what the replay wrote, where it could not write into the folder of the job"""


def make_jobs(recordings: Sequence[str], out: Path, parameters: str | None = None) -> list[Job]:
    """A job per recording, each with a folder of its own name. Raises InputError for a doubled one.

    A missing one is told by run_batch, as any that cannot be mapped.
    """
    jobs: dict[str, Job] = {}
    for recording in recordings:
        name = Path(recording).name.split(".")[0] or Path(recording).name
        if name in jobs:  # two folders with recordings of one name
            name = f"{Path(recording).absolute().parent.name}-{name}"
        if name in jobs:
            raise InputError(f"{recording} and {jobs[name].recording} would have one folder, {out / name}; rename one")
        jobs[name] = Job(recording, out / name, parameters)
    if not jobs:
        raise InputError("no recording was named")
    return list(jobs.values())


def run_batch(jobs: Sequence[Job], workers: int, cluster: str | None = None) -> Iterator[Outcome]:
    """Runs jobs, so many at a time here or on a cluster, and yields their outcomes as they come.

    What was done before is not done again.
    """
    waiting = []
    for job in jobs:
        outcome = _done_before(job)
        if outcome is None:
            waiting.append(job)
        else:
            yield outcome
    if waiting:
        with open_pool(workers, cluster) as pool:
            for job, mapped in in_pool(pool, _map_here if cluster is None else _map_afar, waiting):
                yield _outcome(job, mapped)


def _done_before(job: Job) -> Outcome | None:
    """The outcome that is there, or why it cannot be told what is there; None if the job is to be done."""
    try:
        if _read(job.folder / _STATE).get("key") == job.key:
            return Outcome(job.recording, str(job.folder), None, _figures(job.folder), kept=True)
    except (OSError, OortError) as error:
        return Outcome(job.recording, str(job.folder), str(error), {})
    return None


def _map_here(job: Job) -> _Mapped:
    try:
        return _Mapped(_replay(job, job.folder), {})
    except (OSError, OortError) as error:
        return _Mapped(str(error), {})


def _map_afar(job: Job) -> _Mapped:
    """Maps into a folder that is soon gone and sends back what is in it: nothing is shared but the recording."""
    try:
        with tempfile.TemporaryDirectory(prefix="oort-") as place:
            folder = Path(place) / job.folder.name
            error = _replay(job, folder)
            return _Mapped(error, {path.name: path.read_bytes() for path in sorted(folder.glob("*"))})
    except (OSError, OortError) as error:
        return _Mapped(str(error), {})


def _replay(job: Job, folder: Path) -> str | None:
    """Maps a recording in a process of its own; the sentence of the error if it cannot be."""
    with local_copy(job.recording) as path, tempfile.TemporaryDirectory(prefix="oort-") as place:
        command = [sys.executable, "-m", "oort.replay", path, "--out", str(folder), "--quiet"]
        if job.parameters is not None:
            parameters = Path(place) / "params.json"
            parameters.write_text(job.parameters)
            command += ["--params", str(parameters)]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    if done.returncode == 0:
        return None
    last = (done.stderr.strip().splitlines() or [f"ended with status {done.returncode}"])[-1]
    return last.removeprefix("oort replay: ")


def _outcome(job: Job, mapped: _Mapped | OortError) -> Outcome:
    """Writes what came from afar; the mark that all is there comes last."""
    error = str(mapped) if isinstance(mapped, OortError) else mapped.error
    if isinstance(mapped, OortError) or error is not None:
        return Outcome(job.recording, str(job.folder), error, {})
    try:
        job.folder.mkdir(parents=True, exist_ok=True)
        for name, content in mapped.files.items():
            write_atomically(job.folder / name, content)
        figures = _figures(job.folder)
        write_atomically(job.folder / _STATE, json.dumps({"key": job.key}).encode())
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
