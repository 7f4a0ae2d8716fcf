# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Many recordings on a Dask cluster: two worker processes on this machine, one of them killed."""

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from oort.cli.batch import main
from oort.offline.scoring import Trial, score
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive

Cluster = tuple[str, list[subprocess.Popen[bytes]]]
"""The address of a scheduler, and its two workers."""


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    place = tmp_path / "scheduler.json"
    started: list[subprocess.Popen[bytes]] = []

    def start(name: str, *options: str) -> None:
        command = [sys.executable, "-m", f"distributed.cli.{name}", "--scheduler-file", str(place), "--no-dashboard"]
        silent = subprocess.DEVNULL
        started.append(subprocess.Popen([*command, *options], stdout=silent, stderr=silent, cwd=tmp_path))

    try:
        start("dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        for _ in range(2):
            start("dask_worker", "--nthreads", "1", "--no-nanny")
        for _ in range(600):
            if place.is_file() and place.read_text():
                break
            time.sleep(0.05)
        yield json.loads(place.read_text())["address"], started[1:]
    finally:
        for process in started:
            process.kill()
            process.wait()


def test_a_worker_that_dies_loses_nothing_and_the_bytes_are_those_of_one_machine(
    cluster: Cluster, tmp_path: Path
) -> None:
    address, workers = cluster
    names = [f"home{seed}" for seed in range(1, 5)]
    for seed, name in enumerate(names, 1):
        write_drive(simulate_drive(seed, SimulationConfig(minutes=0.0)), tmp_path, name, picture=False)
    code = "import sys; from oort.cli.batch import main; sys.exit(main(sys.argv[1:]))"
    urls = [f"file://{tmp_path}/{name}.clf" for name in names]
    command = [sys.executable, "-c", code, *urls, "--cluster", address, "--out", str(tmp_path / "afar")]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as batch:
        assert batch.stdout is not None
        assert batch.stdout.readline().startswith(b"[1/4, ")
        workers[0].kill()
        assert b"4 of 4 mapped" in batch.stdout.read()
    assert batch.returncode == 0
    assert main([*(str(tmp_path / f"{name}.clf") for name in names), "--out", str(tmp_path / "here")]) == 0
    for name in names:
        for file in ("map.map_capnp", "trajectory.tum", "map.png"):
            afar, here = (tmp_path / place / name / file for place in ("afar", "here"))
            assert afar.read_bytes() == here.read_bytes()


def test_no_cluster_is_said_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.clf").touch()
    arguments = [str(tmp_path / "a.clf"), "--out", str(tmp_path), "--cluster"]
    assert main([*arguments, "nowhere:1:2"]) == 2
    assert "no Dask scheduler answers at nowhere:1:2" in capsys.readouterr().err


def test_a_url_brings_the_truth_beside_the_recording(tmp_path: Path) -> None:
    write_drive(simulate_drive(1, SimulationConfig(minutes=0.0)), tmp_path, "home", picture=False)
    told = score(Trial(f"file://{tmp_path}/home.clf", "{}"))
    assert told.kind == "truth"
    assert "cannot be fetched" in score(Trial(f"file://{tmp_path}/none.clf", "{}")).why
    assert "Protocol not known" in score(Trial("nowhere://none.clf", "{}")).why
    for url in (f"file://{tmp_path}/..", "memory://", "memory://a/."):
        assert "does not end in the name of a recording" in score(Trial(url, "{}")).why
    assert "a device" in score(Trial("file:///dev/zero", "{}")).why
