# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the scans of a drive were, by their nodes at the final solution."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from oort.offline.trajectory import TrajectoryRecorder
from oort.poses import between, compose
from oort.recording import Pose

ZERO = (0.0, 0.0, 0.0)
MOUNT = (0.1, 0.0, 0.0)


@dataclass
class Result:
    """What the mapper says of a scan."""

    outcome: str
    node_id: int | None
    T_node_sensor: Pose = ZERO


@dataclass
class SolvedMap:
    """Of a map, what the recorder looks at."""

    node_poses: np.ndarray[Any, np.dtype[np.float64]]
    incremental_results: dict[str, np.ndarray[Any, Any]]

    def __len__(self) -> int:
        return len(self.node_poses)


def chain(measured: list[Pose], solved: list[Pose]) -> Any:
    """Nodes of one segment: where the scan matcher saw them, and where the solution puts them."""
    poses = np.array(measured, dtype=np.float64).reshape(-1, 3)
    ids = np.arange(len(poses))
    targets = np.maximum(ids - 1, 0)
    results = {"id": ids, "target": targets, "pose": between(poses[targets], poses)}
    return SolvedMap(np.array(solved, dtype=np.float64).reshape(-1, 3), results)


def record(results: Sequence[Result | None], odometry: list[Pose], mount: Pose = ZERO) -> TrajectoryRecorder:
    recorder: Any = TrajectoryRecorder(mount)  # Any: Result stands in for ScanResult
    for number, (result, pose) in enumerate(zip(results, odometry, strict=True)):
        recorder.add(f"{number}.0", pose, result)
    recorded: TrajectoryRecorder = recorder
    return recorded


def straight(n: int) -> list[Pose]:
    return [(0.1 * k, 0.0, 0.0) for k in range(n)]


def test_scans_are_seen_from_their_node_and_given_for_the_base() -> None:
    results = [Result("node", 0), Result("located", 0, (0.1, 0.0, 0.5))]
    recorder = record(results, straight(2), MOUNT)
    node = (1.0, 2.0, np.pi / 2)
    base = recorder.base_poses(chain([node], [node]))
    assert recorder.stamps == ["0.0", "1.0"]
    expected = [compose(node, between(MOUNT, ZERO)), compose(compose(node, (0.1, 0.0, 0.5)), between(MOUNT, ZERO))]
    assert base == pytest.approx(np.array(expected))


def test_unmoved_nodes_leave_the_scans_where_they_were_matched() -> None:
    results = [Result("node", 0), Result("located", 0, (0.11, 0.0, 0.01)), Result("node", 1), Result("carried", 1)]
    nodes = [ZERO, (0.2, 0.0, 0.0)]
    base = record(results, straight(4)).base_poses(chain(nodes, nodes))
    assert base == pytest.approx(np.array([ZERO, (0.11, 0.0, 0.01), (0.2, 0.0, 0.0), (0.2, 0.0, 0.0)]))


def test_a_moved_node_takes_the_scans_before_it_along_in_proportion() -> None:
    """The second node moved by 0.3 m aside: the scans on the way go over to it evenly, without a jump."""
    results = [
        Result("node", 0),
        Result("located", 0, (0.1, 0.0, 0.0)),
        Result("located", 0, (0.2, 0.0, 0.0)),
        Result("node", 1),
        Result("located", 1, (0.1, 0.0, 0.0)),
    ]
    solved = chain([ZERO, (0.3, 0.0, 0.0)], [ZERO, (0.3, 0.3, 0.0)])
    base = record(results, straight(5)).base_poses(solved)
    assert base[:, :2] == pytest.approx(np.array([(0.0, 0.0), (0.1, 0.1), (0.2, 0.2), (0.3, 0.3), (0.4, 0.3)]))


def test_a_turned_node_turns_the_scans_before_it_in_proportion() -> None:
    results = [Result("node", 0), Result("located", 0), Result("node", 1)]
    solved = chain([ZERO, ZERO], [ZERO, (0.0, 0.0, 0.4)])
    base = record(results, [ZERO] * 3).base_poses(solved)
    assert base[:, 2] == pytest.approx([0.0, 0.2, 0.4])


def test_scans_before_the_first_node_are_led_back_by_odometry() -> None:
    skipped = Result("skipped", None)
    recorder = record([skipped, skipped, Result("node", 0)], [(5.0, 5.0, 0.0), (5.0, 5.1, 0.0), (5.0, 5.3, np.pi / 2)])
    base = recorder.base_poses(chain([ZERO], [ZERO]))
    # Seen from the third scan, which looks along y, the second is 0.2 m behind and the first 0.3 m.
    assert base == pytest.approx(np.array([(-0.3, 0.0, -np.pi / 2), (-0.2, 0.0, -np.pi / 2), ZERO]))


def test_scans_that_were_not_mapped_follow_odometry_from_the_last_that_was() -> None:
    results = [Result("node", 0), Result("located", 0, (0.12, 0.0, 0.0)), None, None]
    base = record(results, straight(4)).base_poses(chain([ZERO], [ZERO]))
    assert base[:, 0] == pytest.approx([0.0, 0.12, 0.22, 0.32])


def test_odometry_of_the_base_carries_the_base_not_the_sensor() -> None:
    """A turn on the spot moves a sensor that is ahead of the base, but not the base."""
    recorder = record([Result("node", 0), None], [ZERO, (0.0, 0.0, 1.0)], MOUNT)
    base = recorder.base_poses(chain([ZERO], [ZERO]))
    assert base == pytest.approx(np.array([(-0.1, 0.0, 0.0), (-0.1, 0.0, 1.0)]))


def test_without_a_map_there_is_only_odometry() -> None:
    odometry = [(1.0, 2.0, 3.0), (1.1, 2.0, 3.0)]
    assert record([None, None], odometry).base_poses(chain([], [])) == pytest.approx(np.array(odometry))
    assert record([], []).base_poses(chain([], [])).shape == (0, 3)


def test_a_node_made_between_two_scans_carries_the_scans_after_it() -> None:
    """A call may make a node of the last scan: then the scan was not yet said to be one."""
    results = [
        Result("node", 0),
        Result("located", 0, (0.1, 0.0, 0.0)),  # made node 1 afterwards
        Result("located", 1, (0.1, 0.0, 0.0)),
        Result("node", 2),
    ]
    solved = chain(
        [ZERO, (0.1, 0.0, 0.0), (0.3, 0.0, 0.0)],
        [ZERO, (0.1, 0.1, 0.0), (0.3, 0.3, 0.0)],
    )
    base = record(results, straight(4)).base_poses(solved)
    assert base[1] == pytest.approx((0.1, 0.1, 0.0)), "the scan that is node 1"
    assert base[2] == pytest.approx((0.2, 0.2, 0.0)), "half way from node 1 to node 2"


def test_the_beginning_of_a_segment_does_not_move_the_scans_before_it() -> None:
    """A robot carried away while mapping was paused says nothing about the scans before the pause."""
    results = [Result("node", 0), Result("located", 0, (0.1, 0.0, 0.0)), None, Result("node", 1)]
    solved = chain([ZERO, (0.3, 0.0, 0.0)], [ZERO, (0.3, 5.0, 0.0)])
    solved.incremental_results["target"] = np.array([0, 1])
    base = record(results, straight(4)).base_poses(solved)
    assert base[1] == pytest.approx((0.1, 0.0, 0.0))


def test_scans_go_over_to_the_nodes_that_are_left() -> None:
    results = [Result("node", node) for node in range(3)] + [Result("located", 1, (0.2, 0.0, 0.0)), None]
    recorder = record(results, straight(5))
    recorder.follow(None)
    recorder.follow((np.array([0, 0, 1]), np.array([ZERO, (0.5, 0.1, 0.0), ZERO])))
    assert recorder.carriers().tolist() == [0, 0, 1, 0, 0]
    left = chain([ZERO, (1.0, 0.0, 0.0)], [ZERO, (1.0, 0.0, 0.0)])
    poses = recorder.base_poses(left)
    assert poses[:4, 0] == pytest.approx([0.0, 0.5, 1.0, 0.7])
    assert poses[:4, 1] == pytest.approx([0.0, 0.1, 0.0, 0.1])
