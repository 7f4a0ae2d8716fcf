# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Every command in the documents works: those of ``oort`` are run, in a folder that has what they name.

A block of commands is fenced as ``sh``. One that cannot be run here has a comment before it that says why; these are
counted: ``<!-- not run: needs ROS 1 -->``.
"""

import argparse
import glob
import re
import shlex
import signal
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import pytest

from conftest import ROOT
from helpers.plans import write_house, write_picture_of_plan
from oort.cli.completion import whole_parser
from oort.cli.main import TOOLS, main
from oort.history import keep_version
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.drive import first_seconds
from oort.simulate.writers import write_drive

PAGES = [*(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "bench/README.md")), *(ROOT / "docs").glob("*.md")]
SECONDS = 45.0  # of a drive: a map of a room or two

# A block that moves from here to what is run makes its number smaller; one more that is not run must be worth it.
NOT_RUN = {
    "changes the sources": 2,
    "installs or builds": 17,
    "needs ROS 1": 9,
    "needs ROS 2": 5,
    "needs a long recording": 1,
    "needs docker": 1,
    "takes minutes": 20,
}

_BLOCK = re.compile(r"(?:<!-- not run: (?P<why>[^>]+) -->\n)?^```sh\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE)
_PROGRAMS = (
    r"oort |scripts/|\.venv|cmake |pip |docker |g\+\+ |rosrun |roslaunch |source |ros2 |git |cd |ctest |gdb |perf "
)
_UNFENCED = re.compile(rf"\n\n    (?:{_PROGRAMS}).*")


@dataclass(frozen=True)
class Block:
    """Commands of a page."""

    page: str
    why_not: str | None
    lines: tuple[str, ...]


def _blocks() -> list[Block]:
    found = []
    for page in sorted(PAGES):
        for match in _BLOCK.finditer(page.read_text(encoding="utf-8")):
            lines = [line.partition("  #")[0].strip() for line in match["text"].splitlines()]
            found.append(Block(str(page.relative_to(ROOT)), match["why"], tuple(filter(None, lines))))
    return found


BLOCKS = _blocks()
RUN = [block for block in BLOCKS if block.why_not is None]


def test_every_block_of_commands_is_fenced() -> None:
    for page in PAGES:
        assert _UNFENCED.findall(page.read_text(encoding="utf-8")) == [], page


def test_what_is_not_run_is_counted() -> None:
    assert Counter(block.why_not for block in BLOCKS if block.why_not) == NOT_RUN
    assert len(RUN) >= 30


def _words(line: str) -> list[str] | None:
    """What follows ``oort`` in a command of it; None for another program."""
    words = shlex.split(line)
    if words[:1] == ["oort"] or words[:1] == [".venv/bin/oort"]:
        return words[1:]
    if words[:2] == [".venv/bin/python", "-m"] and words[2].startswith("oort."):
        return [words[2].removeprefix("oort."), *words[3:]]
    return None


# ---- options of commands within sentences, and of those that are not run ----


def _options(tool: str, parser: argparse.ArgumentParser) -> set[str]:
    inner = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    own = {option for action in parser._actions for option in action.option_strings}
    return own.union(*(_options(tool, child) for action in inner for child in action.choices.values()))


def test_options_that_are_named_exist() -> None:
    tools = next(a for a in whole_parser(TOOLS)._actions if isinstance(a, argparse._SubParsersAction)).choices
    known = {tool: _options(tool, parser) for tool, parser in tools.items()}
    named = [(block.page, words) for block in BLOCKS for line in block.lines if (words := _words(line))]
    for page in PAGES:
        inline = re.findall(r"`oort ([a-z][^`]*)`", page.read_text(encoding="utf-8"))
        named += [(page.name, text.split()) for text in inline]
    assert len(named) > 80
    for page_name, words in named:
        assert words[0] in known, (page_name, words)
        options = {word.partition("=")[0] for word in words if re.match("--[a-z]", word)}
        assert options <= known[words[0]], (page_name, words)


# ---- what is run ----


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the documents' commands name: recordings, maps of two days, floor plans, replays, a graph."""
    place = tmp_path_factory.mktemp("commands")
    whole = [simulate_drive(3, SimulationConfig(minutes=0.0, way=way)) for way in (0, 1)]
    drives = [first_seconds(drive, SECONDS) for drive in whole]
    names = {"": ("drive", "home_1", "monday", "wednesday"), "fleet": ("a", "b")}
    for folder, those in names.items():
        for name in those:
            write_drive(drives[0], place / folder, name, picture=False, formats=("ros1",))
    write_drive(drives[1], place, "tuesday", picture=False, formats=("ros1",))
    write_picture_of_plan(place / "flat.png")
    write_house(place / "house.json")
    (place / "params.json").write_text("{}")
    (place / "params").mkdir()
    (place / "params/cartographer.json").write_text((ROOT / "params/cartographer.json").read_text())
    for folder in ("maps", "old", "new", "pictures"):
        (place / folder).mkdir()
    write_drive(whole[0], place, "home", picture=False, formats=("ros1",))
    for name, day in (
        ("home", "home"),
        ("before", "drive"),
        ("after", "drive"),
        ("intel", "drive"),
        ("two", "tuesday"),
    ):
        assert main(["replay", str(place / f"{day}.bag"), "--out", str(place / "oort-out" / name), "--quiet"]) == 0
    _copy_maps(place)
    keep_version(str(place / "home"))
    lines = (place / "oort-out/intel/trajectory.tum").read_text().splitlines()
    times = [line.split()[0] for line in lines]
    (place / "intel.relations").write_text(f"{times[20]} {times[60]} 0 0 0 0 0 0\n")
    (place / "manhattan.g2o").write_bytes((place / "oort-out/home/graph.g2o").read_bytes())
    nodes = [line for line in (place / "manhattan.g2o").read_text().splitlines() if line.startswith("VERTEX")]
    (place / "truth.txt").write_text("".join(f"{' '.join(line.split()[2:5])}\n" for line in nodes))
    return place


def _copy_maps(place: Path) -> None:
    for source, targets in (("home", ("maps/home", "home", "monday", "old/home")), ("two", ("tuesday",))):
        for ending in (".map_capnp", ".map_meta_capnp", ".md5"):
            content = (place / f"oort-out/{source}/map{ending}").read_bytes()
            for target in targets:
                (place / f"{target}{ending}").write_bytes(content)
    for ending in (".pgm", ".yaml"):  # of the picture, a plan
        content = (place / f"oort-out/home/map{ending}").read_bytes()
        (place / f"maps/home{ending}").write_bytes(content.replace(b"image: map.pgm", b"image: home.pgm"))


def _expanded(words: list[str]) -> list[str]:
    """As a shell does it with ``*``."""
    return [found for word in words for found in (sorted(glob.glob(word)) if "*" in word else [word])]


def _look_at_page(words: list[str]) -> None:
    """``oort view`` serves until it is told to end."""
    code = "import sys; from oort.cli.main import main; sys.exit(main())"
    with subprocess.Popen(
        [sys.executable, "-c", code, *words, "--port", "0"], stdout=subprocess.PIPE, text=True
    ) as view:
        assert view.stdout is not None
        assert view.stdout.readline().startswith("open http://127.0.0.1:")
        view.send_signal(signal.SIGTERM)
        assert view.wait(30.0) == 0


@pytest.mark.parametrize("block", RUN, ids=lambda block: f"{block.page}: {block.lines[0]}")
def test_the_commands_work(
    block: Block, place: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(place)
    for line in block.lines:
        words = _words(line)
        assert words is not None, f"{block.page}: {line}: say with <!-- not run: ... --> why it is not run"
        if words[0] == "view":
            _look_at_page(words)
            continue
        status = main(_expanded(words))
        assert status == 0, (line, capsys.readouterr().err)
