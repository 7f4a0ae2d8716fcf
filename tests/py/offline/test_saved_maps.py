# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What people give where a saved map is expected: a lone file, a damaged map, a map of another program."""

import logging
import shutil
from pathlib import Path

import pytest

from helpers.scenes import room_scan
from oort import Parameters, Session, load_map
from oort.cli.main import main
from oort.errors import MapFileError
from oort.saved_maps import open_map


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    session = Session(Parameters())
    session.start(str(tmp_path / "room"))
    for step in range(3):
        session.add_scan(room_scan(-1.0 + 0.25 * step, 0.0, 0.0, 100.0 + step))
    session.locations.create_at("dock", "dock", (0.0, 0.0, 0.0))
    session.stop()
    return tmp_path / "room"


@pytest.fixture
def lone(saved: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(f"{saved}.map_capnp", tmp_path / "lone.map_capnp"))


def test_a_lone_map_file_is_read_with_a_note(saved: Path, lone: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        map_ = open_map(str(lone))
    assert len(map_) == len(load_map(str(saved)))
    assert map_.locations == []
    assert "lies there alone: it was read without a check" in caplog.text


def test_a_session_loads_a_lone_map_file(lone: Path, tmp_path: Path) -> None:
    session = Session(Parameters())
    session.load(str(lone))
    assert len(session.map) > 0


def test_tools_take_a_lone_map_file(lone: Path, tmp_path: Path) -> None:
    assert main(["render", str(lone), str(tmp_path / "flat")]) == 0
    assert (tmp_path / "flat_map.png").exists()
    assert main(["migrate", str(lone), str(tmp_path / "new")]) == 0
    assert len(load_map(str(tmp_path / "new"))) > 0


def test_tools_ignore_checksums_where_told_to(saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path(f"{saved}.md5").unlink()
    for call in (["render", str(saved), str(tmp_path / "flat")], ["migrate", str(saved), str(tmp_path / "new")]):
        assert main(call) == 2
        assert "--ignore-checksum" in capsys.readouterr().err
        assert main([*call, "--ignore-checksum"]) == 0
    assert load_map(str(tmp_path / "new")).locations[0][:2] == ("dock", "dock")


@pytest.mark.parametrize("tool", ["replay", "localize", "render", "merge", "migrate"])
def test_every_tool_that_reads_a_map_has_the_option(tool: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([tool, "--help"])
    assert "--ignore-checksum" in capsys.readouterr().out


@pytest.mark.parametrize("given", ["map.yaml", "map.pgm", "map"])
def test_a_map_of_map_server_is_named(tmp_path: Path, given: str) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5 2 2 255\n\0\0\0\0")
    (tmp_path / "map.yaml").write_text("image: map.pgm\nresolution: 0.05\n")
    message = "image for map_server, not an Oort map.*Map the place with 'oort replay'"
    with pytest.raises(MapFileError, match=message):
        open_map(str(tmp_path / given))


def test_maps_of_other_programs_and_pointers_are_named(tmp_path: Path) -> None:
    for name, what in (("a.pbstream", "Cartographer"), ("a.posegraph", "slam_toolbox"), ("a.bag", "a recording")):
        (tmp_path / name).write_bytes(b"x")
        with pytest.raises(MapFileError, match=what):
            open_map(str(tmp_path / name))
    (tmp_path / "b.map_capnp").write_bytes(b"version https://git-lfs.github.com/spec/v1\nsize 9\n")
    with pytest.raises(MapFileError, match="Git LFS pointer"):
        open_map(str(tmp_path / "b"))


def test_a_file_of_another_kind_is_not_said_to_lack_its_checksum(saved: Path, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("hello")
    with pytest.raises(MapFileError, match=r"notes\.txt is a file of another kind; an Oort map is given by"):
        open_map(str(tmp_path / "notes.txt"))
    Path(f"{saved}.map_capnp").unlink()  # of a map
    with pytest.raises(MapFileError, match="room"):
        open_map(f"{saved}.map_meta_capnp")


def test_a_map_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(MapFileError, match="does not exist"):
        open_map(str(tmp_path / "none"))
