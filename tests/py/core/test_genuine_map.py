# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The map that Mayfield's Oort wrote and published: what it holds, and that we draw and write it as Oort did."""

import hashlib
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from oort import Map, Parameters, load_map, render_map, save_map
from oort.export import read_map_server
from oort.parameters import parameter_table

SUFFIXES = (".map_capnp", ".map_meta_capnp", ".md5")


@pytest.fixture(scope="module")
def genuine(datasets: Path) -> Path:
    folder = datasets / "kuri_oort_map"
    if not folder.is_dir():
        pytest.skip(f"the genuine map was not found at {folder} (set OORT_DATASETS)")
    return folder


@pytest.fixture(scope="module")
def genuine_map(genuine: Path) -> Map:
    return load_map(str(genuine / "map"))


@pytest.fixture(scope="module")
def documented() -> Parameters:
    """The documented output_map, whatever our defaults are."""
    parameters = Parameters()
    for entry in parameter_table():
        if entry.path.startswith("output_map."):
            parameters.set(entry.path, entry.documented)
    return parameters


def test_rendering_equals_the_published_picture(genuine: Path, genuine_map: Map, documented: Parameters) -> None:
    grid = render_map(genuine_map, documented)[0]
    published = read_map_server(genuine / "map.yaml")
    assert grid.cells.dtype == np.int8
    assert grid.cells.size == 28_830
    np.testing.assert_array_equal(grid.cells, published.cells)
    assert grid.resolution == published.resolution
    assert grid.origin == pytest.approx(published.origin[:2], abs=1e-6)


def test_the_cleaned_map_keeps_walls_and_free_space(genuine_map: Map, documented: Parameters) -> None:
    grid, cleaned = (drawn.cells for drawn in render_map(genuine_map, documented))
    occupied, still_occupied = grid == 100, cleaned == 100
    assert not (still_occupied & ~occupied).any()
    assert still_occupied.sum() > 0.9 * occupied.sum()
    assert (cleaned == 0).sum() > (grid == 0).sum()


def test_the_graph(genuine_map: Map) -> None:
    assert len(genuine_map) == 9
    assert genuine_map.node_ids.tolist() == list(range(9))
    assert genuine_map.node_poses.shape == (9, 3)
    assert genuine_map.node_poses[0] == pytest.approx([0.0, 0.0, 1.7369e-06], abs=1e-9)
    edges, switchable = genuine_map.edges, genuine_map.switchable_edges
    assert edges["id"].tolist() == list(range(8))
    assert (edges["j"] - edges["i"]).tolist() == [1] * 8
    assert edges["type"].tolist() == [0] * 8
    assert edges["pose"].shape == (8, 3)
    assert edges["covariance"].shape == (8, 3, 3)
    assert edges["covariance"][:, 2, 2] == pytest.approx(0.025)
    assert [switchable[key].tolist() for key in ("id", "i", "j", "node")] == [[8], [0], [8], [0]]
    assert switchable["pose"][0] == pytest.approx([-0.0004, -0.0056, -0.0887], abs=1e-4)
    assert switchable["switch"][0] == pytest.approx(0.99999721, abs=1e-8)


def test_the_clouds(genuine_map: Map) -> None:
    for k in range(9):
        points = genuine_map.cloud(k)
        assert points.shape == (180, 3)
        infinite = np.isinf(points[:, 0])
        assert np.isnan(points[infinite, 2]).all()
        assert np.isfinite(points[:, 1]).all()
    assert genuine_map.cloud_times.shape == (9,)
    with pytest.raises(IndexError, match="9 clouds"):
        genuine_map.cloud(9)


def test_the_results_agree_with_the_edges(genuine_map: Map) -> None:
    incremental, loops = genuine_map.incremental_results, genuine_map.loop_results
    assert incremental["id"].tolist() == list(range(9))
    np.testing.assert_array_equal(incremental["pose"][1:], genuine_map.edges["pose"])
    np.testing.assert_array_equal(incremental["covariance"][1:], genuine_map.edges["covariance"])
    assert (incremental["hit_fraction"] <= 1.0).all()
    assert (loops["id"].tolist(), loops["target"].tolist(), loops["hit_fraction"].tolist()) == ([0], [8], [1.0])
    np.testing.assert_array_equal(loops["pose"], genuine_map.switchable_edges["pose"])


def test_the_dock_is_at_the_first_node(genuine_map: Map) -> None:
    assert genuine_map.locations == [("dock", "dock", 0, (0.0, 0.0, 0.0))]


def test_saving_gives_the_bytes_of_the_original(genuine: Path, genuine_map: Map, tmp_path: Path) -> None:
    save_map(str(tmp_path / "map"), genuine_map, as_original=True)
    for suffix in SUFFIXES:
        assert (tmp_path / f"map{suffix}").read_bytes() == (genuine / f"map{suffix}").read_bytes(), suffix


def test_the_checksums_verify(genuine: Path, genuine_map: Map, tmp_path: Path) -> None:
    save_map(str(tmp_path / "map"), genuine_map)
    for folder in (genuine, tmp_path):
        for line in (folder / "map.md5").read_text().splitlines():
            digest, name = line.split("  ")
            assert hashlib.md5((folder / name).read_bytes()).hexdigest() == digest
    if shutil.which("md5sum"):
        subprocess.run(["md5sum", "--check", "--strict", "map.md5"], cwd=tmp_path, check=True, capture_output=True)


def test_the_manuals_tool_decodes_what_we_write(genuine_map: Map, tmp_path: Path) -> None:
    tool = shutil.which("capnp")
    if tool is None:
        pytest.skip("the capnp tool is not installed")
    save_map(str(tmp_path / "map"), genuine_map)
    schema = ROOT / "schema/oort_map.capnp"
    with (tmp_path / "map.map_meta_capnp").open("rb") as file:
        text = subprocess.run(
            [tool, "decode", "--packed", str(schema), "Map2dMetadata"], stdin=file, check=True, capture_output=True
        ).stdout.decode()
    assert 'namespace = "dock"' in text
