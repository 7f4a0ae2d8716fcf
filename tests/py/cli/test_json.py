# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Every word of ``oort`` takes --json and then prints JSON and nothing else; the words are those of the parser."""

import argparse
import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from oort.cli.completion import whole_parser
from oort.cli.main import TOOLS, main
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive


def _words() -> Iterator[tuple[str, ...]]:
    """Each tool, and where it has commands each of these."""

    def below(parser: argparse.ArgumentParser, words: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
        inner = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
        if not inner:
            yield words
        for action in inner:
            for name, child in action.choices.items():
                yield from below(child, (*words, name))

    return below(whole_parser(TOOLS), ())


WORDS = list(_words())


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two drives through one home, each replayed; a relation of the first."""
    place = tmp_path_factory.mktemp("json")
    for way, name in ((0, "one"), (1, "two")):
        drive = simulate_drive(3, SimulationConfig(minutes=0.0, way=way))
        write_drive(drive, place, name, picture=False)
        bag, out = str(place / f"{name}.bag"), str(place / name)
        assert main(["replay", bag, "--events", str(place / f"{name}.events.json"), "--out", out, "--quiet"]) == 0
    return place


# What follows each word; {} is the folder of the drives.
CALLS = {
    ("replay",): ["{}/one.bag", "--out", "{}/again"],
    ("batch",): ["{}/one.bag", "--out", "{}/batch"],
    ("tune",): ["{}/one.bag", "--search", "linear_update", "--trials", "1", "--out", "{}/tune", "--seed", "1"],
    ("check",): ["{}/one.bag", "--until", "20"],
    ("info",): ["{}/one/map"],
    ("localize",): ["{}/one/map", "{}/two.bag", "--out", "{}/localized"],
    ("render",): ["{}/one/map", "{}/drawn"],
    ("export",): ["{}/one/map", "pgm", "{}/exported.pgm"],
    ("rooms",): ["{}/one/map"],
    ("areas",): ["{}/one/map"],
    ("compare",): ["{}/one", "{}/two", "--out", "{}/compare.html"],
    ("merge",): ["{}/one/map", "{}/two/map", "{}/merged"],
    ("simulate",): ["--minutes", "0", "--out", "{}/made", "--no-picture"],
    ("evaluate", "ate"): ["{}/one/trajectory.tum", "{}/one.truth.tum"],
    ("evaluate", "relations"): ["{}/one/trajectory.tum", "{}/one.relations"],
    ("evaluate", "autogenerate"): ["{}/one/map", "{}/made.relations", "--min-covered-distance", "2"],
    ("graph", "solve"): ["{}/one/graph.g2o", "{}/solved.g2o"],
    ("prune",): ["{}/one/map", "{}/pruned"],
    ("history",): ["{}/one/map"],
    ("migrate",): ["{}/one/map", "{}/migrated"],
    ("parameters", "table"): [],
    ("parameters", "write"): ["{}/project"],
    ("completion",): ["bash"],
    ("view",): ["{}/one/map", "--port", "0"],  # for ever: below
}


def test_every_word_takes_it() -> None:
    assert set(WORDS) == set(CALLS)


@pytest.mark.parametrize("words", [words for words in WORDS if words != ("view",)], ids=" ".join)
def test_it_prints_json_alone(words: tuple[str, ...], place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    times = [line.split()[0] for line in (place / "one/trajectory.tum").read_text().splitlines()]
    (place / "one.relations").write_text(f"{times[20]} {times[60]} 0 0 0 0 0 0\n")
    status = main([*words, *(each.format(place) for each in CALLS[words]), "--json"])
    told = capsys.readouterr()
    if words == ("tune",) and status == 2:  # the one trial was no better, which is an error like another
        assert not told.out
        assert "none of 1 trials is better" in told.err
        return
    assert status == 0, told.err
    assert json.loads(told.out, parse_constant=_refuse) not in (None, {}, ""), words


def _refuse(name: str) -> Any:
    raise ValueError(f"{name} is no JSON")


def test_the_view_prints_its_address(place: Path) -> None:
    words = [each.format(place) for each in CALLS["view",]]
    code = "import sys; from oort.cli.main import main; sys.exit(main())"
    command = [sys.executable, "-c", code, "view", *words, "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as view:
        assert view.stdout is not None
        lines = [view.stdout.readline() for _ in range(3)]
        view.send_signal(signal.SIGTERM)
        assert view.wait(30.0) == 0
        assert view.stdout.read() == ""
    assert json.loads("".join(lines))["url"].startswith("http://127.0.0.1:")
