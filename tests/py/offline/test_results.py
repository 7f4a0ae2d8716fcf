# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The end of a replay: what cannot be drawn or written costs nothing else."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from helpers.recording_files import flaser
from oort import Map, load_map, read_parameters, render_map
from oort.cli.main import main
from oort.errors import InputError
from oort.offline import drawing, results
from oort.offline.drawing import draw_map
from oort.recording import open_recording
from oort.session import Session


def log(path: Path) -> Path:
    """A robot that goes straight on in a room."""
    scans = [[2.0 + 0.01 * beam + 0.02 * (step % 2) for beam in range(180)] for step in range(20)]
    path.write_text("\n".join(flaser(f"{k}.0", ranges, (0.1 * k, 0, 0)) for k, ranges in enumerate(scans)) + "\n")
    return path


def mapped(path: Path, far: float = 0.0) -> Map:
    """The map of a log; ``far`` is one more reading, of a laser that sees so far."""
    session = Session(read_parameters())
    session.start()
    for number, scan in enumerate(open_recording(path).scans()):
        ranges = scan.ranges.copy()
        if number == 0 and far:
            ranges[90] = far
        session.add_scan(replace(scan, ranges=ranges, range_max=1e5))
    session.stop()
    return session.map


def test_a_failure_of_one_output_costs_no_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ValueError("no colours left")

    monkeypatch.setattr(results, "write_picture", fail)
    out = tmp_path / "out"
    assert main(["replay", str(log(tmp_path / "a.clf")), "--out", str(out)]) == 2
    told = capsys.readouterr()
    assert "map.png was not written: no colours left (written all the same: the map" in told.err
    assert f"map: {out}/map" in told.out
    assert {path.name for path in out.iterdir()} >= {"trajectory.tum", "map.pgm", "report.json", "graph.g2o", "map.md5"}
    assert len(load_map(str(out / "map"))) > 0


def test_a_map_that_is_too_wide_is_drawn_coarser(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    map_ = mapped(log(tmp_path / "a.clf"))
    (fine, _), notes = draw_map(map_, read_parameters())
    assert notes == []

    def of_a_small_grid(*args: Any) -> Any:
        drawn = render_map(*args)
        if drawn[0].cells.size > fine.cells.size / 3:
            raise InputError("more than a grid can hold")
        return drawn

    monkeypatch.setattr(drawing, "render_map", of_a_small_grid)
    (coarse, _), notes = draw_map(map_, read_parameters())
    assert coarse.resolution == 2 * fine.resolution
    assert notes == ["the map is too large for cells of 0.05 m: drawn with cells of 0.1 m"]


def test_a_reading_that_no_laser_gives_does_not_widen_the_picture(tmp_path: Path) -> None:
    (grid, _), notes = draw_map(mapped(log(tmp_path / "a.clf"), 79000.0), read_parameters())
    assert max(grid.width, grid.height) * grid.resolution < 30.0
    assert notes == []


def test_one_far_reading_does_not_widen_the_picture(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def of_a_small_grid(*args: Any) -> Any:
        drawn = render_map(*args)
        if max(drawn[0].width, drawn[0].height) * drawn[0].resolution > 100.0:
            raise InputError("more than a grid can hold")
        return drawn

    monkeypatch.setattr(drawing, "render_map", of_a_small_grid)
    (grid, _), notes = draw_map(mapped(log(tmp_path / "a.clf"), 140.0), read_parameters())
    assert max(grid.width, grid.height) * grid.resolution < 30.0
    assert "the picture is cropped to" in notes[0]
    assert (grid.cells == 100).any()
