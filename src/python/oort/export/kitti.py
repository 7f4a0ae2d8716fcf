# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Trajectories in the KITTI format: a line for each pose, the upper three rows of its 4 x 4 matrix."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from oort.export.files import decimal, write_atomically


def write_kitti(path: Path, poses: NDArray[np.float64]) -> None:
    """Writes planar poses (n, 3), x and y in the plane and z up. Raises OortError if the file cannot be written."""
    lines = []
    for x, y, theta in poses.tolist():
        c, s = np.cos(theta), np.sin(theta)
        lines.append(" ".join(decimal(float(v)) for v in (c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, 1.0, 0.0)))
    write_atomically(path, "".join(f"{line}\n" for line in lines).encode())
