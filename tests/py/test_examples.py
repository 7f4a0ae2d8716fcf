# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The numbered examples run, and each twin in C++ prints and saves what its twin in Python does."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from oort import load_map, open_recording, replay
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen

EXAMPLES = ROOT / "examples"
BUILT = Path(os.environ.get("OORT_BUILD", ROOT / "build/dev")) / "examples/cpp"

NAMES = sorted(path.stem for path in (EXAMPLES / "python").glob("0*.py"))
MAP_FILES = (".map_capnp", ".map_meta_capnp", ".md5")


@pytest.fixture(scope="module")
def drive() -> Drive:
    """A short drive from the dock and back."""
    return simulate_drive(1, SimulationConfig(minutes=0.0))


@pytest.fixture(scope="module")
def log(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("log") / "home.clf"
    write_carmen(drive, path)
    return path


@pytest.fixture(scope="module")
def mapped(log: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """What example 01 leaves."""
    base = str(tmp_path_factory.mktemp("mapped") / "home")
    run(python("01_map_a_log"), log, base)
    return base


def python(name: str) -> list[str]:
    return [sys.executable, str(EXAMPLES / "python" / f"{name}.py")]


def cpp(name: str) -> list[str]:
    return [str(BUILT / name)]


def run(command: list[str], log: Path, base: str) -> str:
    done = subprocess.run([*command, str(log), base], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


def test_every_example_has_a_twin() -> None:
    assert sorted(path.stem for path in (EXAMPLES / "cpp").glob("0*.cpp")) == NAMES
    assert [name[:2] for name in NAMES] == ["01", "02", "03", "04", "05"]


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("05")])
def test_twins_print_and_save_the_same(name: str, log: Path, tmp_path: Path) -> None:
    printed = {}
    for language, command in (("python", python(name)), ("cpp", cpp(name))):
        (tmp_path / language).mkdir()
        printed[language] = run(command, log, str(tmp_path / language / "map"))
    assert printed["python"] == printed["cpp"] != ""
    for suffix in MAP_FILES:
        saved = {language: (tmp_path / language / f"map{suffix}").read_bytes() for language in printed}
        assert saved["python"] == saved["cpp"], suffix
    assert len(load_map(str(tmp_path / "python/map"))) > 20


def test_twins_find_the_robot_at_the_same_place(log: Path, mapped: str) -> None:
    printed = {run(command, log, mapped) for command in (python("05_localise"), cpp("05_localise"))}
    assert len(printed) == 1
    assert "tracking: the base is at" in printed.pop()


def test_the_live_loop_maps_as_a_replay_does(log: Path, tmp_path: Path) -> None:
    run(python("02_live_loop"), log, str(tmp_path / "map"))
    replayed = replay(open_recording(log)).map
    assert np.array_equal(load_map(str(tmp_path / "map")).node_poses, replayed.node_poses)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("language", [python, cpp])
def test_an_input_that_cannot_be_is_told_without_a_traceback(
    language: Callable[[str], list[str]], name: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [*language(name), str(tmp_path / "none.clf"), str(tmp_path / "map")], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 1
    assert "none.clf" in done.stderr and "Traceback" not in done.stderr
