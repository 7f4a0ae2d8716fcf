# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort check``, and what ``--strict`` makes of an uncertain drive."""

import json
import math
from pathlib import Path

import pytest

from oort.cli.check import main as check
from oort.cli.replay import main as replay
from oort.simulate import Sensor, SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag
from oort.simulate.writers import write_carmen


@pytest.fixture
def sound(tmp_path: Path) -> Path:
    path = tmp_path / "sound.clf"
    write_carmen(simulate_drive(7, SimulationConfig(minutes=0.5)), path)
    return path


def test_a_sound_recording(sound: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(sound.parent)
    assert check([str(sound)]) == 0
    assert "nothing is wrong, as far as the drive shows" in capsys.readouterr().out
    assert check([str(sound), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["troubles"] == []
    assert [path.name for path in sound.parent.iterdir()] == ["sound.clf"], "nothing is kept"


def test_troubles_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "body.clf"
    write_carmen(simulate_drive(7, SimulationConfig(Sensor(body=math.radians(10)), minutes=0.5)), path)
    assert check([str(path), "--json"]) == 0
    (trouble,) = json.loads(capsys.readouterr().out)["troubles"]
    assert trouble["code"] == "body_in_view"
    assert set(trouble) == {"code", "text", "advice", "evidence"}
    assert replay([str(path), "--out", str(tmp_path / "out"), "--strict"]) == 0
    printed = capsys.readouterr().out
    assert "what is wrong with this recording or setup:\n- the laser sees the robot itself at" in printed
    assert json.loads((tmp_path / "out" / "report.json").read_text())["troubles"] == [trouble]


def test_strict(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = sound.read_text().splitlines(keepends=True)
    sound.write_text("".join([*lines[:20], *(_blind(line) for line in lines[20:])]))
    options = [str(sound), "--out", str(sound.parent / "out")]
    assert replay(options) == 0
    assert "uncertain for" in capsys.readouterr().out
    assert replay([*options, "--strict"]) == 3


def _blind(line: str) -> str:
    fields = line.split(" ")
    count = int(fields[8])
    return " ".join([*fields[:9], *["3.0"] * count, *fields[9 + count :]])


def test_what_cannot_be_read_is_an_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check([str(tmp_path / "none.bag")]) == 2
    assert "oort check: " in capsys.readouterr().err


@pytest.mark.parametrize("topics", [["/scan", "/scan_rear"], ["/scan_rear", "/scan"]])
def test_a_robot_with_two_lasers(tmp_path: Path, topics: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    write_bag(simulate_drive(7, SimulationConfig(minutes=0.5, rear=True)), tmp_path / "two.bag")
    assert check([str(tmp_path / "two.bag")]) == 2
    assert "choose one with scan_topic (--scan-topic, once for each laser)" in capsys.readouterr().err
    options = [option for topic in topics for option in ("--scan-topic", topic)]
    assert replay([str(tmp_path / "two.bag"), *options, "--out", str(tmp_path / "out")]) == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["troubles"] == []
    assert report["tracking"]["tracking"] == report["scans"]
    assert len(report["other_lasers"]) == 1
    assert report["match_rejections"] == {}
