# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The metrics, against values computed by hand."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from oort.cli.evaluate import main
from oort.errors import InputError
from oort.evaluation.trajectories import evaluate_ate, evaluate_relations, relation_errors
from oort.export import Trajectory, read_tum, write_tum
from oort.poses import compose
from oort.recording import open_recording

QUARTER = math.pi / 2
SQUARE = Trajectory(("1.0", "2.0", "50.0"), np.array([[0, 0, 0], [1, 0, QUARTER], [1, 2, QUARTER]], dtype=float))
# Seen from pose 1, pose 2 is at (1, 0, 90 deg); seen from pose 2, pose 50 is at (2, 0, 0).
RELATIONS = f"""# t1 t2 x y z roll pitch yaw
1.000000 2.0 1.3 0.4 0 0 0 {QUARTER - math.radians(10)}

2.0000001 50.0 2.0 -0.1 0 0 0 {math.tau}
"""


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def moving(n: int = 50) -> Trajectory:
    t = np.linspace(0.0, 4.9, n)
    return Trajectory(tuple(f"{time:.3f}" for time in t), np.stack([t, np.sin(t), np.cos(t)], axis=1))


def test_relations_by_hand(tmp_path: Path) -> None:
    result = evaluate_relations(SQUARE, write(tmp_path / "a.relations", RELATIONS))
    assert (result.n, result.missing) == (2, 0)
    translation = (result.translation_mean, result.translation_std, result.translation_max)
    np.testing.assert_allclose(translation, (0.3, 0.2, 0.5), atol=1e-12)  # errors 0.5 and 0.1
    rotation = (result.rotation_mean, result.rotation_std, result.rotation_max)
    np.testing.assert_allclose(rotation, (5.0, 5.0, 10.0), atol=1e-9)  # errors 10 and 0


def test_relations_under_a_time(tmp_path: Path) -> None:
    path = write(tmp_path / "a.relations", RELATIONS)
    assert evaluate_relations(SQUARE, path, max_seconds=20.0).translation_mean == pytest.approx(0.5)
    with pytest.raises(InputError, match=r"holds no relation under 0\.5 s"):
        evaluate_relations(SQUARE, path, max_seconds=0.5)


def test_few_missing_relations_are_counted_and_many_refused(tmp_path: Path) -> None:
    line = "1.0 2.0 1 0 0 0 0 0\n"
    result = evaluate_relations(SQUARE, write(tmp_path / "a", line * 19 + "1.0 2.5 1 0 0 0 0 0\n"))
    assert (result.n, result.missing) == (19, 1)
    with pytest.raises(InputError, match=r"2 of 20 relations of .* have no counterpart"):
        evaluate_relations(SQUARE, write(tmp_path / "a", line * 18 + "1.0 2.5 1 0 0 0 0 0\n" * 2))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# nothing\n", "holds no relation"),
        ("1 2 3\n", "line 1: expected t1 t2 x y z roll pitch yaw, but there are 3 fields"),
        ("1 2 3 4 5 6 7 nan\n", "line 1: expected finite numbers"),
    ],
)
def test_damaged_relations_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        evaluate_relations(SQUARE, write(tmp_path / "a.relations", text))


def test_a_time_that_occurs_twice_is_refused(tmp_path: Path) -> None:
    twice = Trajectory(("1.0", "1.0000001"), np.zeros((2, 3)))
    with pytest.raises(InputError, match="same time to 6 decimals"):
        evaluate_relations(twice, write(tmp_path / "a.relations", RELATIONS))


def test_ate_does_not_see_a_rigid_motion() -> None:
    truth = moving()
    moved = Trajectory(truth.stamps, compose((5.0, -3.0, 2.5), truth.poses))
    result = evaluate_ate(moved, truth)
    assert (result.n, result.missing) == (50, 0)
    np.testing.assert_allclose((result.position_rmse, result.position_max, result.heading_rmse), 0.0, atol=1e-9)


def test_ate_by_hand() -> None:
    """Points on a cross, each moved out by 0.1 m: no rigid motion can help."""
    truth = np.array([[1, 0, 0], [0, 1, 1], [-1, 0, 2], [0, -1, 3]], dtype=float)
    estimated = truth * [1.1, 1.1, 1.0] + [[0, 0, 0.3], [0, 0, -0.3], [0, 0, 0.3], [0, 0, -0.3]]
    stamps = ("1", "2", "3", "4")
    result = evaluate_ate(Trajectory(stamps, compose((3, 4, -1), estimated)), Trajectory(stamps, truth))
    np.testing.assert_allclose((result.position_rmse, result.position_max), 0.1, rtol=1e-12)
    assert result.heading_rmse == pytest.approx(math.degrees(0.3))


def test_ate_sees_scale_and_a_mirror() -> None:
    truth = moving()
    assert evaluate_ate(Trajectory(truth.stamps, truth.poses * [1.1, 1.1, 1.0]), truth).position_rmse > 0.1
    assert evaluate_ate(Trajectory(truth.stamps, truth.poses * [1.0, -1.0, -1.0]), truth).position_rmse > 0.1


def test_ate_interpolates_the_truth() -> None:
    truth = Trajectory(("1.0", "1.2", "1.4"), np.array([[0, 0, 3.1], [1, 0, -3.1], [1, 1, -3.1]]))
    seam = 3.1 + (math.tau - 6.2) / 2
    between_stamps = Trajectory(("1.1", "1.3", "1.4"), np.array([[0.5, 0, seam], [1, 0.5, -3.1], [1, 1, -3.1]]))
    result = evaluate_ate(between_stamps, truth)
    np.testing.assert_allclose((result.position_max, result.heading_rmse), 0.0, atol=1e-9)


def test_ate_needs_truth_for_nearly_all_poses() -> None:
    truth = moving()
    late = Trajectory((*truth.stamps, "99"), np.vstack([truth.poses, [0, 0, 0]]))
    assert evaluate_ate(late, truth).missing == 1
    sparse = Trajectory(truth.stamps[::10], truth.poses[::10])  # 1 s apart: too far to interpolate
    with pytest.raises(InputError, match="45 of 50 poses have no counterpart"):
        evaluate_ate(truth, sparse)


def test_ate_of_a_parked_robot_aligns_by_heading() -> None:
    parked = Trajectory(("1", "2"), np.array([[1, 2, 0.5], [1, 2, 0.5]]))
    truth = Trajectory(("1", "2"), np.array([[0, 0, -0.5], [0, 0, -0.5]]))
    result = evaluate_ate(parked, truth)
    np.testing.assert_allclose((result.position_max, result.heading_rmse), 0.0, atol=1e-12)


def test_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    relations = write(tmp_path / "a.relations", RELATIONS)
    trajectory = tmp_path / "a.tum"
    write_tum(trajectory, SQUARE.stamps, SQUARE.poses)
    assert main(["relations", str(trajectory), str(relations)]) == 0
    assert capsys.readouterr().out == (
        "relations    2 (0 missing)\n"
        "translation  mean 0.3000 m  std 0.2000 m  max 0.5000 m\n"
        "rotation     mean 5.0000 deg  std 5.0000 deg  max 10.0000 deg\n"
        "squared      mean 0.130000 m^2  std 0.120000 m^2\n"
        "squared      mean 50.0000 deg^2  std 50.0000 deg^2\n"
    )
    assert main(["relations", str(trajectory), str(relations), "--json", "--max-seconds", "20"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert (printed["n"], printed["translation_mean"]) == (1, pytest.approx(0.5))
    assert main(["ate", str(trajectory), str(trajectory)]) == 0
    assert capsys.readouterr().out.startswith("poses        3 (0 without truth)\nposition     rmse 0.0000 m")
    assert main(["ate", str(trajectory), str(tmp_path / "none.tum")]) == 2
    assert capsys.readouterr().err.startswith(f"oort evaluate: {tmp_path / 'none.tum'} cannot be read: ")


@pytest.mark.parametrize(
    ("name", "n", "translation", "rotation"), [("intel", 2984, 7.37, 39.0), ("fr079", 1685, 6.50, 30.0)]
)
def test_raw_odometry_of_real_logs(
    datasets: Path, tmp_path: Path, name: str, n: int, translation: float, rotation: float
) -> None:
    scans = list(open_recording(datasets / f"radish/{name}.clf.bz2").scans())
    path = tmp_path / "odometry.tum"
    write_tum(path, [scan.stamp for scan in scans], [scan.odometry for scan in scans])
    result = evaluate_relations(read_tum(path), datasets / f"radish/{name}.relations")
    assert (result.n, result.missing) == (n, 0)
    assert result.translation_mean == pytest.approx(translation, abs=0.01)
    assert result.rotation_mean == pytest.approx(rotation, abs=0.5)


def test_relations_with_rounded_times_find_their_poses(tmp_path: Path) -> None:
    stamps = [10.00004, 11.00006, 12.00004]
    lines = "".join(f"{stamp:.5f} {k}.0 0 0 0 0 0 1\n" for k, stamp in enumerate(stamps))
    (tmp_path / "trajectory.tum").write_text(lines)
    (tmp_path / "relations").write_text("10.0001 11.0001 1 0 0 0 0 0\n11.0 12.0 1 0 0 0 0 0\n")
    errors = relation_errors(read_tum(tmp_path / "trajectory.tum"), tmp_path / "relations")
    assert np.abs(errors).max() < 1e-9
