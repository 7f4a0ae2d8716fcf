# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The mapper, the localiser and the map as programs use them."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import oort
from helpers.scenes import room_scan
from oort.localization import start_covariance
from oort.poses import compose

MOUNT = (0.1, 0.0, 0.0)
"""T_base_sensor"""


def base_of(sensor: tuple[float, float, float]) -> NDArray[np.float64]:
    return compose(sensor, (-0.1, 0.0, 0.0))


def drive(mapper: oort.Mapper, scans: int = 60) -> oort.ScanResult:
    for k in range(scans):
        scan = room_scan(0.01 * k, 0.0, 0.02 * k, 0.1 * k)
        result = mapper.add_scan(scan, base_of(scan.odometry))
    return result


@pytest.fixture(scope="module")
def map_() -> oort.Map:
    mapper = oort.Mapper(oort.Config(linear_update=0.1), MOUNT)
    drive(mapper)
    mapper.create_location("places", "end", mapper.sensor_pose)
    mapper.finish()
    return mapper.map()


def test_a_result_tells_where_the_robot_is() -> None:
    mapper = oort.Mapper(sensor_on_base=MOUNT)
    result = drive(mapper)
    assert result.T_map_base == pytest.approx(base_of((0.59, 0.0, 1.18)).tolist(), abs=0.03)
    assert result.T_map_odom == pytest.approx((0.0, 0.0, 0.0), abs=0.03)  # the origin is the first sensor pose
    assert result.tracking is oort.TrackingState.TRACKING
    assert json.dumps(result.tracking) == '"tracking"'
    assert result.covariance.shape == (3, 3) and (np.diag(result.covariance) > 0.0).all()


def test_a_scan_is_made_of_anything_that_holds_numbers() -> None:
    memory = np.full(90, 2.0)
    scan = oort.LaserScan(memory, -1.5, 0.03, 0.1, 5.0)
    memory[:] = 0.0
    assert scan.ranges.dtype == np.float32 and (scan.ranges == 2.0).all()
    assert oort.Mapper().add_scan(scan, np.zeros(3)).outcome == "node"
    assert oort.Mapper().add_scan(oort.LaserScan([2.0] * 90, -1.5, 0.03, 0.1, 5.0), [0, 0, 0]).outcome == "node"


@pytest.mark.parametrize("ranges", [[[1.0, 2.0]], "far", 3.0, [1.0, "x"]])
def test_ranges_that_are_no_row_of_numbers_are_refused(ranges: object) -> None:
    with pytest.raises(oort.InputError, match="LaserScan: the ranges must be"):
        oort.LaserScan(ranges, -1.5, 0.03, 0.1, 5.0)  # type: ignore[arg-type]


def test_errors_name_the_method(map_: oort.Map) -> None:
    mapper = oort.Mapper()
    scan = room_scan(0.0, 0.0, 0.0, 0.0)
    with pytest.raises(oort.InputError, match=r"Mapper.add_scan: odometry must be three numbers.*not \(1.0, 2.0\)"):
        mapper.add_scan(scan, (1.0, 2.0))
    with pytest.raises(oort.StateError, match=r"Mapper\.notify_docked: no scan"):
        mapper.notify_docked()
    mapper.set_map(map_)
    with pytest.raises(oort.StateError, match=r"Mapper\.add_scan: the map was loaded; call Mapper\.begin_session"):
        mapper.add_scan(scan, scan.odometry)
    with pytest.raises(oort.InputError, match=r"Mapper\.begin_session: the start pose"):
        mapper.begin_session((float("nan"), 0.0, 0.0))
    with pytest.raises(oort.InputError, match=r"Localizer\.add_scan: odometry"):
        oort.Localizer(map_).add_scan(scan, 0.0)


def test_a_map_saves_renders_and_locates(map_: oort.Map, tmp_path: Path) -> None:
    map_.save(str(tmp_path / "map"))
    loaded = oort.load_map(str(tmp_path / "map"))
    assert loaded.locate("places", "end") == map_.locate("places", "end") != None  # noqa: E711
    assert loaded.locate("places", "nowhere") is None
    drawn = loaded.render()
    grid, cleaned = oort.render_map(loaded, oort.Parameters())
    assert (drawn.map.cells == grid.cells).all() and (drawn.map_cleaned.cells == cleaned.cells).all()
    assert drawn.map.cells.size > 0
    assert loaded.render(oort.Config(output_map={"probability_grid": {"resolution": 0.1}})).map.resolution == 0.1


def test_a_map_shows_its_clouds(map_: oort.Map) -> None:
    assert len(map_.clouds) == len(map_)
    assert all(np.array_equal(cloud, map_.cloud(k), equal_nan=True) for k, cloud in enumerate(map_.clouds))


def test_a_map_draws_itself_in_a_notebook(map_: oort.Map) -> None:
    png = map_._repr_png_()  # type: ignore[attr-defined]
    assert png.startswith(b"\x89PNG")
    html = map_._repr_html_()  # type: ignore[attr-defined]
    assert f"{len(map_)} nodes" in html and "data:image/png;base64," in html
    assert oort.Map()._repr_png_() is None  # type: ignore[attr-defined]
    assert "nothing to draw" in oort.Map()._repr_html_()  # type: ignore[attr-defined]


def test_a_localiser_follows_the_base(map_: oort.Map) -> None:
    localizer = oort.Localizer(map_, oort.Config(), MOUNT)
    assert localizer.T_map_base is None
    localizer.start_at((0.0, 0.0, 0.0), start_covariance())
    for k in range(60):
        scan = room_scan(0.01 * k, 0.0, 0.02 * k, 0.1 * k)
        state = localizer.add_scan(scan, compose((5.0, 1.0, 0.5), base_of(scan.odometry)))
    assert state == localizer.state == "tracking"
    assert localizer.T_map_base == pytest.approx(base_of((0.59, 0.0, 1.18)).tolist(), abs=0.05)


def test_maps_can_be_merged_and_recordings_replayed_by_their_names() -> None:
    assert callable(oort.merge_maps) and callable(oort.replay) and callable(oort.open_recording)
