# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps of every format there has been load, newer ones are refused, and the published schema reads ours."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from helpers.golden_maps import describe
from oort import _core, load_map, save_map
from oort.cli.main import main
from oort.errors import MapFileError

MAPS = ROOT / "tests/py/data/maps"
PUBLISHED_SCHEMA = ROOT / "tests/py/data/published_map.capnp"
FORMATS = range(_core.FORMAT_VERSION + 1)


def test_there_is_a_golden_map_of_every_format() -> None:
    assert {folder.name for folder in MAPS.iterdir() if folder.is_dir()} == {f"format_{k}" for k in FORMATS}


@pytest.mark.parametrize("version", FORMATS)
def test_golden_map(version: int, tmp_path: Path) -> None:
    folder = MAPS / f"format_{version}"
    expected = json.loads((folder / "expected.json").read_text(encoding="utf-8"))
    map_ = load_map(str(folder / "home"))
    assert describe(map_) == expected
    assert _core.read_map_format(str(folder / "home")).version == version
    save_map(str(tmp_path / "again"), map_)
    assert describe(load_map(str(tmp_path / "again"))) == expected
    assert _core.read_map_format(str(tmp_path / "again")).version == _core.FORMAT_VERSION


def test_what_a_golden_map_holds() -> None:
    map_ = load_map(str(MAPS / "format_1/home"))
    assert _core.read_map_format(str(MAPS / "format_1/home")).written_by == "Oort 0.1.0"
    assert set(map_.edges["type"].tolist()) == {0, 1}
    assert (map_.incremental_results["id"] == map_.incremental_results["target"]).sum() == 2
    assert map_.switchable_edges["switch"].min() < 0.5 < map_.switchable_edges["switch"].max()
    assert [location[:2] for location in map_.locations] == [("dock", "dock"), ("rooms", "Küche")]
    assert np.isnan(map_.cloud(0)).any()


def test_the_original_format_keeps_its_bytes(tmp_path: Path) -> None:
    old = MAPS / "format_0"
    save_map(str(tmp_path / "home"), load_map(str(old / "home")), as_original=True)
    for suffix in (".map_capnp", ".map_meta_capnp", ".md5"):
        assert (tmp_path / f"home{suffix}").read_bytes() == (old / f"home{suffix}").read_bytes(), suffix


def capnp(*arguments: str, data: bytes) -> bytes:
    tool = shutil.which("capnp")
    if tool is None:
        pytest.skip("the capnp tool is not installed")
    return subprocess.run([tool, *arguments], input=data, check=True, capture_output=True).stdout


@pytest.mark.parametrize(("suffix", "root"), [("map_capnp", "Map2d"), ("map_meta_capnp", "Map2dMetadata")])
def test_the_published_schema_reads_ours(suffix: str, root: str) -> None:
    texts = [
        capnp(
            "decode", "--packed", str(PUBLISHED_SCHEMA), root, data=(MAPS / f"format_{k}/home.{suffix}").read_bytes()
        ).decode()
        for k in FORMATS
    ]
    assert len(set(texts)) == 1
    assert "formatVersion" not in texts[0]


def newer(folder: Path, suffix: str, root: str) -> str:
    """A copy of a golden map in a format that is yet to come."""
    base = folder / "home"
    for path in (MAPS / "format_1").glob("home.*"):
        shutil.copy(path, folder)
    file = base.with_suffix(suffix)
    schema = str(ROOT / "schema/oort_map.capnp")
    text = capnp("decode", "--packed", schema, root, data=file.read_bytes()).decode()
    text = text.replace("formatVersion = 1", "formatVersion = 7").replace("Oort 0.1.0", "Oort 3.2.1")
    file.write_bytes(capnp("encode", "--packed", schema, root, data=text.encode()))
    return str(base)


def test_newer_maps_are_refused_by_name(tmp_path: Path) -> None:
    base = newer(tmp_path, ".map_capnp", "Map2d")
    with pytest.raises(
        MapFileError, match=r"home\.map_capnp has the map format 7, written by Oort 3\.2\.1; this is"
    ) as e:
        load_map(base, ignore_checksum=True)
    assert f"formats up to {_core.FORMAT_VERSION}: update it" in str(e.value)
    assert "damaged" not in str(e.value)
    found = _core.read_map_format(base, ignore_checksum=True)
    assert (found.version, found.written_by) == (7, "Oort 3.2.1")


def test_a_writer_that_is_no_text_is_told_as_far_as_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (MAPS / "format_1").glob("home.*"):
        data = path.read_bytes()
        (tmp_path / path.name).write_bytes(data.replace(b"Oort 0.1", b"\xf1ort 0.1"))
    base = str(tmp_path / "home")
    assert _core.read_map_format(base, ignore_checksum=True).written_by == "\ufffdort 0.1.0"
    for words in (["migrate", base, str(tmp_path / "new")], ["info", base], ["info", base, "--json"]):
        assert main([*words, "--ignore-checksum"]) == 0
    assert "ort 0.1.0" in capsys.readouterr().out


def test_newer_places_are_refused(tmp_path: Path) -> None:
    base = newer(tmp_path, ".map_meta_capnp", "Map2dMetadata")
    with pytest.raises(MapFileError, match=r"map_meta_capnp has the map format 7, written by a newer Oort"):
        load_map(base, ignore_checksum=True)


def test_migrate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    old, new, back = str(MAPS / "format_0/home"), str(tmp_path / "new"), str(tmp_path / "back")
    assert main(["migrate", old, new]) == 0
    nodes = len(load_map(old))
    assert capsys.readouterr().out == f"{old}: format 0, {nodes} nodes\n{new}: format {_core.FORMAT_VERSION}\n"
    assert describe(load_map(new)) == describe(load_map(old))
    assert main(["migrate", new, back, "--original"]) == 0
    assert "format 1, written by Oort " in capsys.readouterr().out
    assert Path(f"{back}.map_capnp").read_bytes() == Path(f"{old}.map_capnp").read_bytes()
    assert main(["migrate", new, f"{new}.map_capnp"]) == 2
    assert "would replace the old one" in capsys.readouterr().err
    assert main(["migrate", str(tmp_path / "none"), back]) == 2
    assert "oort migrate: " in capsys.readouterr().err
