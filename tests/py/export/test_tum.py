# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The TUM format."""

import math
from pathlib import Path

import numpy as np
import pytest

from oort.errors import InputError
from oort.export import read_tum, write_tum


def test_round_trip(tmp_path: Path) -> None:
    path = tmp_path / "a.tum"
    stamps = ["976052905.167303", "976052905.1", "3"]
    poses = np.array([[0.1, -2.0, 3.0], [1 / 3, 1e-9, -math.pi], [0.0, 0.0, 0.0]])
    write_tum(path, stamps, poses)
    trajectory = read_tum(path)
    assert trajectory.stamps == tuple(stamps)
    assert trajectory.times.tolist() == [976052905.167303, 976052905.1, 3.0]
    np.testing.assert_array_equal(trajectory.poses[:, :2], poses[:, :2])
    np.testing.assert_allclose(trajectory.poses[:, 2], poses[:, 2], atol=1e-15)


def test_text(tmp_path: Path) -> None:
    write_tum(tmp_path / "a.tum", ["12.50", "13"], [[1.5, -0.25, 0.0], [0.0, 0.0, -math.pi]])
    first, second = (tmp_path / "a.tum").read_text().splitlines()
    assert first == "12.50 1.5 -0.25 0 0 0 0.0 1.0"  # the stamp as it was given
    assert second.startswith("13 0.0 0.0 0 0 0 -1.0 0.00000000000000006")


def test_reading_projects_to_the_plane_and_skips_comments(tmp_path: Path) -> None:
    path = tmp_path / "a.tum"
    path.write_text("# time x y z q\n\n1.0 1 2 3 0 0 2 2\n")  # a quaternion of any length
    trajectory = read_tum(path)
    np.testing.assert_allclose(trajectory.poses, [[1.0, 2.0, math.pi / 2]])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# nothing\n", "holds no pose"),
        ("1 2 3\n", "line 1: expected time x y z qx qy qz qw, but there are 3 fields"),
        ("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 one\n", "line 2: expected finite numbers"),
        ("1 0 0 0 0 0 0 0\n", "the quaternion has no length"),
    ],
)
def test_damaged_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.tum"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_tum(path)


def test_missing_and_binary_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.tum cannot be read: No such file"):
        read_tum(tmp_path / "none.tum")
    (tmp_path / "b.tum").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="not a text file"):
        read_tum(tmp_path / "b.tum")


def test_what_does_not_fit_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "a.tum"
    with pytest.raises(InputError, match="1 stamps do not fit 2 poses"):
        write_tum(path, ["1"], np.zeros((2, 3)))
    with pytest.raises(InputError, match="must be finite"):
        write_tum(path, ["1"], [[math.nan, 0, 0]])
    with pytest.raises(InputError, match="stamp of the pose"):
        write_tum(path, ["noon"], [[0, 0, 0]])
    assert not path.exists()
