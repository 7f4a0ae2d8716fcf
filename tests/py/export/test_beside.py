# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A drive of which a part stays loose: said in one sentence, left out of the map, and shown beside it."""

from pathlib import Path

import numpy as np
from PIL import Image

from oort import Parameters, Session, read_parameters, render_map
from oort.diagnosis import loose_parts
from oort.export import write_picture
from oort.export.beside import set_beside
from oort.recording import Scan
from oort.simulate import SimulationConfig, simulate_drive


def _paused(parameters: Parameters, seeds: tuple[int, int], scans: int = 250) -> Session:
    """Maps some scans of one home, is carried to another while mapping is paused, and maps some of that."""
    drives = [simulate_drive(seed, SimulationConfig(minutes=0.5)) for seed in seeds]
    x, y, theta = drives[0].T_base_sensor.tolist()
    session = Session(parameters, (x, y, theta))
    session.start()
    for number, drive in enumerate(drives):
        for index in range(scans):
            time = 1.6e9 + 1000.0 * number + 0.1 * index
            session.add_scan(
                Scan(
                    time=time, stamp=f"{time:.6f}", angle_min=drive.angle_min, angle_increment=drive.angle_increment,
                    range_min=drive.range_min, range_max=drive.range_max, ranges=drive.ranges[index],
                    odometry=tuple(drive.T_odom_base_at_scans[index].tolist()),
                )
            )  # fmt: skip
        if number == 0:
            session.pause()
            session.resume_from_paused()
    session.stop()
    return session


def test_a_part_that_is_not_tied_is_told_of_and_shown_apart() -> None:
    parameters = read_parameters()
    session = _paused(parameters, (3, 4))
    map_ = session.map
    parts = map_.loose_parts
    assert len(parts) == 1
    assert [trouble.code for trouble in session.troubles()].count("loose_part") == 1
    (trouble,) = loose_parts(map_)
    assert "1 part of the drive" in str(trouble) and "could not be tied" in str(trouble)
    assert "from 0.0 s to 24.5 s after the first scan" in str(trouble)
    assert trouble.evidence["nodes"] == len(parts[0])
    grid = render_map(map_, parameters)[0]
    beside = set_beside(map_, grid, parameters)
    assert (beside.cells[: grid.cells.shape[0], : grid.cells.shape[1]] == grid.cells).all()
    assert beside.cells.shape[1] > grid.cells.shape[1]
    loose = render_map(map_, parameters, nodes=parts[0].tolist())[0]
    assert np.count_nonzero(beside.cells == 100) == np.count_nonzero(grid.cells == 100) + np.count_nonzero(
        loose.cells == 100
    )
    main = np.setdiff1d(np.arange(len(map_)), parts[0])
    assert (beside.shift[main] == 0.0).all() and (beside.part[main] == -1).all()
    x = map_.node_poses[parts[0].astype(int), 0] + beside.shift[parts[0].astype(int), 0]
    assert (x > grid.origin[0] + grid.cells.shape[1] * grid.resolution).all()


def test_a_part_that_is_found_is_no_trouble() -> None:
    session = _paused(read_parameters(), (3, 3))
    assert session.map.loose_parts == []
    assert loose_parts(session.map) == []


def test_the_picture_interrupts_the_way(tmp_path: Path) -> None:
    cells = np.zeros((40, 80), dtype=np.int8)
    way = np.array([[0.2, 0.2], [1.0, 0.2], [np.nan, np.nan], [3.0, 1.8], [3.8, 1.8]])
    write_picture(tmp_path / "a.png", cells, 0.05, (0.0, 0.0, 0.0), trajectory=way, captions=[("apart", (2.0, 1.0))])
    picture = np.asarray(Image.open(tmp_path / "a.png").convert("RGB")).astype(int)
    middle = picture[:800, 620:980]  # without the legend
    blue = (middle[:, :, 2] > 150) & (middle[:, :, 0] < 100)
    assert not blue.any(), "no line from the one part to the other"
