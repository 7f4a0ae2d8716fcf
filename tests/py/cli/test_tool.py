# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the command line tools have in common."""

import argparse
import sys
import warnings
from pathlib import Path
from typing import TextIO

import pytest

from oort import InputError
from oort.cli import localize, merge, replay
from oort.cli.main import main
from oort.cli.tool import add_pose_argument, parse_arguments, run_tool
from oort.simulate import Drive
from oort.simulate.writers import write_carmen


@pytest.fixture
def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser()
    parser.add_argument("name", nargs="?")
    parser.add_argument("--seed", type=int)
    add_pose_argument(parser, "--at", "where")
    return parser


@pytest.mark.parametrize("number", ["-1e-3", "-1E-3", "-.1e-2", "-1.e-3", "-0.001", "-1e7", "-1e300", "-5e-324", "-2."])
def test_a_pose_may_have_any_negative_number(parser: argparse.ArgumentParser, number: str) -> None:
    assert parse_arguments(parser, ["--at", "-0.1", number, "0"]).at == [-0.1, float(number), 0.0]
    assert parse_arguments(parser, ["--at", number, number, number, "home"]).name == "home"


def test_other_arguments_stay_as_they_are(parser: argparse.ArgumentParser, capsys: pytest.CaptureFixture[str]) -> None:
    assert parse_arguments(parser, ["--seed", "-3", "1e-3"]) == argparse.Namespace(name="1e-3", seed=-3, at=None)
    for wrong in (["-x"], ["--at", "1", "2"], ["--at", "-inf", "0", "0"]):
        with pytest.raises(SystemExit):
            parse_arguments(parser, wrong)
        assert "usage" in capsys.readouterr().err


def test_the_arguments_of_the_process(parser: argparse.ArgumentParser, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["oort", "--at", "-1e-3", "0", "0"])
    assert parse_arguments(parser, None).at == [-0.001, 0.0, 0.0]


def test_every_command_that_takes_a_pose(capsys: pytest.CaptureFixture[str]) -> None:
    pose = ["-0.1", "-1e-3", "0"]
    assert merge.main(["none/a", "none/b", "none/c", "--at", *pose]) == 2
    assert replay.main(["none/a.bag", "--resume", "none/b", "--pose", *pose]) == 2
    assert localize.main(["none/a", "none/b.bag", "--start", "pose", "--pose", *pose]) == 2
    told = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[0] for line in told] == ["oort merge", "oort replay", "oort localize"]


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (["replay"], "the following arguments are required: input"),
        (["replay", "a.bag", "--nope"], "unrecognized arguments: --nope"),
        (["replay", "a.bag", "--until", "nan"], "argument --until: nan: choose a number of seconds from 0"),
        (["check", "a.bag", "--until", "soon"], "argument --until: invalid seconds value: 'soon'"),
        (["batch", "a.bag", "--jobs", "0"], "argument --jobs: 0: choose at least 1"),
        (["prune", "a", "b", "--views", "0"], "argument --views: 0: choose at least 1"),
        (["evaluate", "ate", "a"], "the following arguments are required: TRUTH"),
    ],
)
def test_a_wrong_call_is_told_in_one_line(call: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(call)
    assert end.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"oort {call[0]}") and told in line and "--help" in line


@pytest.mark.parametrize(("option", "name"), [("--truth", "none.tum"), ("--relations", "none.relations")])
def test_a_truth_that_is_not_there_is_told_before_mapping(
    option: str, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["replay", str(tmp_path / "no.bag"), option, str(tmp_path / name), "--out", str(tmp_path / "out")]) == 2
    assert f"{name} cannot be read" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_folder_that_is_a_file(drive: Drive, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_carmen(drive, tmp_path / "home.clf")
    (tmp_path / "out").write_text("")
    assert main(["replay", str(tmp_path / "home.clf"), "--out", str(tmp_path / "out")]) == 2
    assert "out is no folder; choose another path" in capsys.readouterr().err


def test_a_warning_is_a_note(capsys: pytest.CaptureFixture[str]) -> None:
    def run() -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.showwarning = _shown  # as it is without pytest
            warnings.warn("a key has no effect", stacklevel=1)

    assert run_tool("oort x", run) == 0
    assert capsys.readouterr().err == "note: a key has no effect\n"


def _shown(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    sys.stderr.write(warnings.formatwarning(message, category, filename, lineno))


def stop() -> None:
    raise KeyboardInterrupt


def refuse() -> None:
    raise InputError("no scan")


def refuse_by_name() -> None:
    raise InputError("x: no scan")


def refuse_to_read() -> None:
    raise OSError(13, "Permission denied")


def test_how_a_tool_ends(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_tool("oort x", lambda: None) == 0
    for run, status, told in (
        (refuse, 2, "oort x: no scan\n"),
        (refuse_by_name, 2, "oort x: no scan\n"),
        (refuse_to_read, 2, "oort x: home: Permission denied; check who may read and write there\n"),
        (stop, 130, "oort x: interrupted\n"),
    ):
        assert run_tool("oort x", run, "home") == status
        assert capsys.readouterr().err == told
