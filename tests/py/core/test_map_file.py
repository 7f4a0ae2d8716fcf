# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Map files from Python; what they do on the disk is tested in C++ (test_storage.cpp)."""

import threading
from pathlib import Path

import numpy as np
import pytest

from oort import LaserScan, Map, Mapper, Parameters, _core, load_map, render_map, save_map
from oort.errors import MapFileError, OortError, ParameterError


def test_an_empty_map_has_arrays_of_the_right_shape() -> None:
    empty = Map()
    assert len(empty) == 0
    assert empty.node_poses.shape == (0, 3)
    assert empty.edges["pose"].shape == (0, 3)
    assert empty.edges["covariance"].shape == (0, 3, 3)
    assert empty.switchable_edges["switch"].shape == (0,)
    assert empty.cloud_times.shape == (0,)
    assert empty.locations == []


def test_an_empty_map_is_saved_loaded_and_drawn(tmp_path: Path) -> None:
    base = str(tmp_path / "home")
    save_map(base, Map())
    assert sorted(path.name for path in tmp_path.iterdir()) == ["home.map_capnp", "home.map_meta_capnp", "home.md5"]
    for grid in render_map(load_map(base), Parameters()):
        assert grid.cells.shape == (0, 0)
        assert (grid.width, grid.height) == (0, 0)


def test_what_is_missing_or_damaged_is_a_map_file_error(tmp_path: Path) -> None:
    base = str(tmp_path / "home")
    with pytest.raises(MapFileError, match="does not exist"):
        load_map(base)
    save_map(base, Map())
    (tmp_path / "home.md5").unlink()
    with pytest.raises(MapFileError, match="ignore_checksum"):
        load_map(base)
    assert len(load_map(base, ignore_checksum=True)) == 0
    with pytest.raises(MapFileError, match="make it"):
        save_map(str(tmp_path / "none" / "home"), Map())
    assert issubclass(MapFileError, OortError)


def test_locations_must_be_at_nodes(tmp_path: Path) -> None:
    map_ = Map()
    map_.locations = [("dock", "dock", 3, (1.0, 2.0, 0.5))]
    assert map_.locations == [("dock", "dock", 3, (1.0, 2.0, 0.5))]
    with pytest.raises(MapFileError, match="'dock/dock' refers to node 3"):
        save_map(str(tmp_path / "home"), map_)
    assert not list(tmp_path.iterdir())
    with pytest.raises(TypeError):
        map_.locations = [("dock", "dock", -1, (0.0, 0.0, 0.0))]


def test_metadata_alone(tmp_path: Path) -> None:
    base = str(tmp_path / "home")
    assert _core.save_metadata(base, Map()) == _core.Saved.MAP  # nothing was there
    assert _core.save_metadata(base, Map()) == _core.Saved.METADATA


def test_each_form_of_a_path(tmp_path: Path) -> None:
    base = str(tmp_path.resolve() / "home")
    for form in ("", ".map_capnp", ".map_meta_capnp", ".capnp"):
        assert _core.normalise_map_path(base + form) == base
    with pytest.raises(MapFileError, match="empty"):
        _core.normalise_map_path("")


def test_bad_parameters_are_refused() -> None:
    parameters = Parameters()
    parameters.set("output_map.median.kernel_size", 2)
    with pytest.raises(ParameterError, match="kernel_size"):
        render_map(load_one_node(), parameters)


def load_one_node() -> Map:
    """A map with one node, made by the mapper from one scan."""
    mapper = Mapper(Parameters())
    ranges = np.full(180, 2.0, dtype=np.float32)
    mapper.add_scan(LaserScan(ranges, -np.pi / 2, np.pi / 180, 0.1, 5.0), (0.0, 0.0, 0.0))
    return mapper.map()


def test_a_mapped_node_is_drawn_and_saved(tmp_path: Path) -> None:
    map_ = load_one_node()
    grid, cleaned = render_map(map_, Parameters())
    assert grid.cells.shape == cleaned.cells.shape == (grid.height, grid.width)
    assert (grid.cells == 100).sum() > 100  # the half circle around the sensor
    column, row = (round(-origin / grid.resolution) for origin in grid.origin)
    assert grid.cells[row, column] == 0  # where the sensor stands
    save_map(str(tmp_path / "home"), map_)
    loaded = load_map(str(tmp_path / "home"))
    np.testing.assert_array_equal(loaded.cloud(0), map_.cloud(0))
    np.testing.assert_array_equal(loaded.node_poses, map_.node_poses)


def test_threads_may_save_and_load_at_once(tmp_path: Path) -> None:
    base, map_ = str(tmp_path / "home"), load_one_node()
    save_map(base, map_)
    errors: list[Exception] = []

    def work() -> None:
        try:
            for _ in range(10):
                save_map(base, map_)
                assert len(load_map(base)) == 1
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
