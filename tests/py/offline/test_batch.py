# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Many recordings in parallel."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from oort.cli.batch import main
from oort.errors import InputError
from oort.offline.batch import make_jobs
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two short drives and a file that is none."""
    folder = tmp_path_factory.mktemp("fleet")
    for seed in (1, 2):
        write_carmen(simulate_drive(seed, SimulationConfig(minutes=0.0)), folder / f"drive{seed}.clf")
    (folder / "notes.clf").write_text("no scans\n")
    return folder


def _run(fleet: Path, out: Path, *more: str) -> int:
    return main([str(path) for path in sorted(fleet.glob("*.clf"))] + ["--out", str(out), "--jobs", "2", *more])


def _row(out: Path, name: str) -> dict[str, object]:
    rows: list[dict[str, object]] = json.loads((out / "batch.json").read_text())
    return next(row for row in rows if Path(str(row["folder"])).name == name)


def test_each_drive_is_mapped_as_alone_and_failures_are_told(
    fleet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(fleet, tmp_path / "out") == 0
    assert "2 of 3 mapped" in capsys.readouterr().out
    assert "no laser scans" in str(_row(tmp_path / "out", "notes")["error"])
    alone = [
        sys.executable,
        "-m",
        "oort.replay",
        str(fleet / "drive1.clf"),
        "--quiet",
        "--out",
        str(tmp_path / "alone"),
    ]
    subprocess.run(alone, check=True)
    for name in ("map.map_capnp", "trajectory.tum", "map.png"):
        assert (tmp_path / "alone" / name).read_bytes() == (tmp_path / "out" / "drive1" / name).read_bytes()
    page = (tmp_path / "out" / "index.html").read_text()
    assert 'href="drive1/report.html"' in page
    assert "no laser scans" in page


def test_a_missing_recording_costs_no_other(fleet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gone = str(tmp_path / "gone.clf")
    assert main([gone, str(fleet / "drive1.clf"), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    assert f"gone: '{gone}' does not exist" in told
    assert "1 of 2 mapped" in told
    assert "does not exist" in str(_row(tmp_path / "out", "gone")["error"])
    assert "does not exist" in (tmp_path / "out" / "index.html").read_text()
    assert not (tmp_path / "out" / "gone").exists()
    assert main([gone, "--out", str(tmp_path / "alone")]) == 2
    assert "no recording could be mapped" in capsys.readouterr().err


def test_what_was_done_is_kept_until_its_input_changes(
    fleet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _run(fleet, tmp_path)
    stamp = (tmp_path / "drive1" / "report.json").stat().st_mtime_ns
    (tmp_path / "drive2" / "batch.json").unlink()  # as after a kill in the middle of it
    capsys.readouterr()
    _run(fleet, tmp_path)
    told = capsys.readouterr().out
    assert "drive1: was done before" in told
    assert "drive2: was done before" not in told
    assert (tmp_path / "drive1" / "report.json").stat().st_mtime_ns == stamp
    parameters = tmp_path / "p.json"
    parameters.write_text("{}")
    _run(fleet, tmp_path, "--params", str(parameters))
    assert (tmp_path / "drive1" / "report.json").stat().st_mtime_ns != stamp


def test_a_killed_drive_costs_no_other(fleet: Path, tmp_path: Path) -> None:
    long = tmp_path / "long.clf"
    write_carmen(simulate_drive(3), long)
    arguments = [str(long), str(fleet / "drive1.clf"), "--out", str(tmp_path / "out")]
    code = "import sys; from oort.cli.batch import main; sys.exit(main(sys.argv[1:]))"
    batch = subprocess.Popen([sys.executable, "-c", code, *arguments], stdout=subprocess.DEVNULL)
    victim = 0
    for _ in range(600):
        found = subprocess.run(["pgrep", "-P", str(batch.pid), "-f", str(long)], capture_output=True, text=True)
        if found.stdout.strip():
            victim = int(found.stdout.split()[0])
            break
        time.sleep(0.05)
    assert victim
    os.kill(victim, signal.SIGKILL)
    assert batch.wait(timeout=120) == 0
    assert _row(tmp_path / "out", "drive1")["error"] is None
    assert "status -9" in str(_row(tmp_path / "out", "long")["error"])


def test_two_recordings_never_share_a_folder(tmp_path: Path) -> None:
    for folder in ("monday", "tuesday"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "drive.bag").touch()
    paths = [str(tmp_path / folder / "drive.bag") for folder in ("monday", "tuesday")]
    assert [job.folder.name for job in make_jobs(paths, tmp_path)] == ["drive", "tuesday-drive"]
    with pytest.raises(InputError, match="would have one folder"):
        make_jobs([*paths, str(tmp_path / "tuesday" / "drive.bag")], tmp_path)
