# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the command line tools have in common."""

import argparse

import pytest

from oort import InputError
from oort.cli import localize, merge, replay
from oort.cli.tool import add_pose_argument, parse_arguments, run_tool


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


def stop() -> None:
    raise KeyboardInterrupt


def refuse() -> None:
    raise InputError("no scan")


def refuse_to_read() -> None:
    raise OSError(13, "Permission denied")


def test_how_a_tool_ends(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_tool("oort x", lambda: None) == 0
    for run, status, told in (
        (refuse, 2, "oort x: no scan\n"),
        (refuse_to_read, 2, "oort x: home: Permission denied\n"),
        (stop, 130, "oort x: interrupted\n"),
    ):
        assert run_tool("oort x", run, "home") == status
        assert capsys.readouterr().err == told
