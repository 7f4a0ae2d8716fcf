# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""oort info and oort completion."""

import json
import subprocess
from pathlib import Path

import pytest

from helpers.saved_room import save_room
from oort import load_map
from oort.cli import completion, info
from oort.cli.main import TOOLS, main
from oort.simulate import Drive
from oort.simulate.bag import write_ros2_bag
from oort.simulate.writers import write_carmen


def test_a_saved_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = save_room(tmp_path / "map")
    assert info.main([f"{path}.map_capnp", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["kind"], told["nodes"], told["chains"]) == ("Oort map", len(load_map(path)), 1)
    assert (told["places"], told["areas"], told["versions"]) == (["dock/dock"], [], [])
    assert 10.0 < told["free_area"] < 20.5
    assert told["bytes"] == sum(file.stat().st_size for file in tmp_path.iterdir())
    assert info.main([path]) == 0
    told_in_words = capsys.readouterr().out
    assert "free area" in told_in_words and " m²\n" in told_in_words


def test_a_recording(drive: Drive, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_carmen(drive, tmp_path / "home.clf")
    assert info.main([str(tmp_path / "home.clf"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["kind"], told["scans"], told["beams"]) == (
        "CARMEN log",
        len(drive.scan_stamps),
        [drive.ranges.shape[1]],
    )
    assert told["scans_per_second"] == pytest.approx(10.0)
    assert told["driven_by_odometry"] == pytest.approx(drive.length, rel=0.1)
    assert info.main([str(tmp_path / "home.clf")]) == 0
    assert "odometry            there" in capsys.readouterr().out


def test_a_folder_is_a_recording(drive: Drive, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_ros2_bag(drive, tmp_path / "home")
    for name in ("home", "home/"):
        assert info.main([f"{tmp_path}/{name}", "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["kind"] == "ROS 2 bag"


def test_a_word_that_is_no_tool(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replya"]) == 2
    told = capsys.readouterr().err
    assert told == "oort: there is no tool 'replya'; perhaps replay is meant; oort --help lists them\n"
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("oort 0.")
    assert main([]) == 2
    assert "usage: oort TOOL" in capsys.readouterr().err


def test_neither(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert info.main([str(tmp_path / "nothing")]) == 2
    assert "oort info: " in capsys.readouterr().err


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_a_shell_completes_all_tools(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert completion.main([shell]) == 0
    script = capsys.readouterr().out
    assert [tool for tool in TOOLS if tool not in script] == []
    assert "--odom-frame" in script or "odom-frame" in script


def test_bash_takes_the_script(capsys: pytest.CaptureFixture[str]) -> None:
    assert completion.main(["bash"]) == 0
    script = capsys.readouterr().out
    command = f"{script}\nCOMP_WORDS=(oort repl); COMP_CWORD=1; _shtab_oort; echo ${{COMPREPLY[@]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "replay"


@pytest.mark.parametrize("tool", TOOLS)
def test_every_help_has_an_example(tool: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([tool, "--help"])
    assert f"oort {tool} " in capsys.readouterr().out.replace("\n", " ").partition("Example: ")[2]
