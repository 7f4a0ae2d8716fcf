# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Trajectories in the TUM format: a line for each pose, `time x y z qx qy qz qw`."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort.errors import InputError
from oort.export.files import decimal, write_atomically
from oort.inputs import floats, read_rows
from oort.poses import wrap_angle


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Poses in the order of the file."""

    stamps: tuple[str, ...]
    """the times as they are written [s]"""
    poses: NDArray[np.float64]
    """(n, 3) x, y [m], theta [rad]"""

    @property
    def times(self) -> NDArray[np.float64]:
        """(n,) the stamps as numbers [s]."""
        return np.array([float(stamp) for stamp in self.stamps])


def write_tum(path: str | os.PathLike[str], stamps: Sequence[str], poses: ArrayLike) -> None:
    """Writes planar poses (n, 3) with their stamps, which are written as they are.

    z, qx and qy are 0. Raises InputError for numbers that are not finite or do not fit together, OortError if the
    file cannot be written.
    """
    poses = np.asarray(poses, dtype=np.float64).reshape(-1, 3)
    if len(stamps) != len(poses):
        raise InputError(f"{len(stamps)} stamps do not fit {len(poses)} poses")
    lines = []
    for stamp, (x, y, theta) in zip(stamps, poses.tolist(), strict=True):
        floats([stamp], f"stamp of the pose {x} {y} {theta}")
        qz, qw = decimal(np.sin(theta / 2.0)), decimal(np.cos(theta / 2.0))
        lines.append(f"{stamp} {decimal(x)} {decimal(y)} 0 0 0 {qz} {qw}\n")
    write_atomically(Path(path), "".join(lines).encode())


def read_tum(path: str | os.PathLike[str]) -> Trajectory:
    """Reads a trajectory and brings it to the plane. Lines that begin with # are comments.

    Raises InputError if the file is missing, holds no pose, or a line is not eight numbers with a rotation.
    """
    path = Path(path)
    stamps = []
    poses = []
    for where, fields, (_, x, y, _, qx, qy, qz, qw) in read_rows(path, "time x y z qx qy qz qw"):
        norm = qx * qx + qy * qy + qz * qz + qw * qw
        if norm < 1e-6:
            raise InputError(
                f"{where}: the quaternion has no length, so it is no rotation; a trajectory has time x y z qx qy qz qw"
            )
        stamps.append(fields[0])
        poses.append((x, y, np.arctan2(2.0 * (qw * qz + qx * qy), norm - 2.0 * (qy * qy + qz * qz))))
    if not poses:
        raise InputError(f"{path} holds no pose")
    result = np.array(poses, dtype=np.float64)
    result[:, 2] = wrap_angle(result[:, 2])
    return Trajectory(tuple(stamps), result)
