# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Earlier versions of a saved map."""

from pathlib import Path

import pytest

from oort import InputError, MapFileError, Mapper, load_map, save_map
from oort.cli.main import main
from oort.history import Version, describe, keep_version, restore, versions


def save_numbered(path: str, number: int) -> None:
    """A map with as many nodes as its number."""
    mapper = Mapper()
    for k in range(number):
        mapper.add_ranges(1.0 * k, -1.5, 0.1, 0.05, 5.0, [2.0] * 30, (0.0, 0.0, 0.7 * k))  # turning in a round room
    save_map(path, mapper.map())


def nodes(path: str) -> int:
    return len(load_map(path))


def test_the_last_three_versions_are_kept(tmp_path: Path) -> None:
    path = str(tmp_path / "home")
    for number in range(1, 6):
        save_numbered(path, number)
        assert keep_version(path) == f"{path}.previous"
    assert [(version.number, nodes(version.path)) for version in versions(path)] == [(1, 5), (2, 4), (3, 3)]


def test_going_back_keeps_what_was_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(tmp_path / "home")
    for number in (1, 2):
        save_numbered(path, number)
        keep_version(path)
    save_numbered(path, 3)
    assert main(["history", path]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 2
    assert main(["history", path, "--restore", "2"]) == 0
    assert nodes(path) == 1
    assert [nodes(version.path) for version in versions(path)] == [3, 2, 1]
    assert main(["history", path, "--restore", "9"]) == 2
    assert "there is no version 9" in capsys.readouterr().err


def test_a_broken_version_stops_nothing_and_is_not_restored(tmp_path: Path) -> None:
    path = str(tmp_path / "home")
    save_numbered(path, 1)
    keep_version(path)
    Path(f"{path}.previous.map_capnp").write_bytes(b"broken")
    with pytest.raises(MapFileError):
        restore(path, 1)
    assert nodes(path) == 1
    keep_version(path)
    assert nodes(versions(path)[0].path) == 1


def test_a_version_of_no_time_that_can_be() -> None:
    assert "at no time that can be" in describe(Version(1, "home.previous", 1e300))


def test_without_a_map_there_is_nothing_to_keep(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(MapFileError):
        keep_version(str(tmp_path / "none"))
    assert versions(str(tmp_path / "none")) == []
    with pytest.raises(InputError):
        restore(str(tmp_path / "none"), 1)
    assert main(["history", str(tmp_path / "none")]) == 2
    assert "none: there is no map" in capsys.readouterr().err
    save_numbered(str(tmp_path / "home"), 1)
    assert main(["history", str(tmp_path / "home")]) == 0
    assert "no earlier versions" in capsys.readouterr().out
