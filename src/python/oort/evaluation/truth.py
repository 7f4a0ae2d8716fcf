# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What is known to be true of a drive, and how far a replay is off it."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort.evaluation.trajectories import (
    compare_poses,
    compare_relations,
    evaluate_ate,
    evaluate_relations,
    read_relations,
)
from oort.export.tum import Trajectory, read_tum


@dataclass(frozen=True)
class Truth:
    """What is known, as files: true poses of the base (TUM), relations of them, or both."""

    poses: str | None = None
    relations: str | None = None

    def __bool__(self) -> bool:
        """Whether anything is known."""
        return self.poses is not None or self.relations is not None

    def check(self) -> None:
        """Reads the files, before a drive is mapped for them. Raises InputError."""
        if self.poses is not None:
            read_tum(self.poses)
        if self.relations is not None:
            read_relations(Path(self.relations))

    def judge(self, trajectory: Trajectory) -> "Judgement":
        """How far a trajectory is off. Raises InputError for files that cannot be read or are of another drive."""
        figures: dict[str, Any] = {}
        true = off = turned = None
        ends, relation_off = np.zeros((0, 2), dtype=np.int64), np.zeros(0)
        if self.poses is not None:
            truth = read_tum(self.poses)
            figures["ate"] = asdict(evaluate_ate(trajectory, truth))
            true, errors = compare_poses(trajectory, truth)
            off, turned = np.hypot(errors[:, 0], errors[:, 1]), np.degrees(np.abs(errors[:, 2]))
        if self.relations is not None:
            figures["relations"] = asdict(evaluate_relations(trajectory, self.relations))
            ends, errors = compare_relations(trajectory, self.relations)
            known = np.isfinite(errors[:, 0])
            ends, relation_off = ends[known], np.hypot(errors[known, 0], errors[known, 1])
        return Judgement(figures, true, off, turned, ends, relation_off)


@dataclass(frozen=True, eq=False)
class Judgement:
    """How far the base's poses of a replay, one per scan, are off."""

    figures: dict[str, Any]
    """of report.json: ``ate`` and ``relations``, as `oort evaluate --json` has them"""
    true: NDArray[np.float64] | None
    """(n, 3) true poses on the map, NaN where there are none"""
    off: NDArray[np.float64] | None
    """(n,) [m]"""
    turned: NDArray[np.float64] | None
    """(n,) [deg]"""
    relation_ends: NDArray[np.int64]
    """(k, 2) which scans a relation is of"""
    relation_off: NDArray[np.float64]
    """(k,) [m]"""
