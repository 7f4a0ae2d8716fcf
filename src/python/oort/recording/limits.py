# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Which readings of a laser count: those within limits of range, and not in masked sectors."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort.errors import ParameterError

_ROUNDING = 1e-5  # [rad]


@dataclass(frozen=True, slots=True)
class ScanLimits:
    """What a person says of a laser beyond what it says itself. Raises ParameterError for what cannot be."""

    min_range: float | None = None
    """[m]; readings below it are no return"""
    max_range: float | None = None
    """[m]; readings at or beyond it are no return"""
    masks: Sequence[tuple[float, float]] = ()
    """bearings [rad] in the laser's own frame, counter-clockwise from the first to the second: no return there"""

    def __post_init__(self) -> None:
        """Checks the numbers."""
        for name, value in (("min_range", self.min_range), ("max_range", self.max_range)):
            if value is not None and not (math.isfinite(value) and value > 0.0):
                raise ParameterError(f"{name} must be a positive number of metres, not {value}")
        if self.min_range is not None and self.max_range is not None and self.min_range >= self.max_range:
            raise ParameterError(f"min_range {self.min_range} must be below max_range {self.max_range}")
        for begin, end in self.masks:
            if not (abs(begin) <= 2.0 * math.pi and abs(end) <= 2.0 * math.pi):
                raise ParameterError(
                    f"a mask goes from one bearing to another, counter-clockwise, in radians; {begin} to {end} is none"
                )

    def range_min(self, own: float) -> float:
        """The least range [m] that counts, of a laser that says ``own``."""
        return max(float(own), self.min_range or 0.0)

    def range_max(self, own: float) -> float:
        """The range [m] from which on nothing counts."""
        return min(float(own), math.inf if self.max_range is None else self.max_range)

    def usable(self, ranges: NDArray[np.float32], angle_min: float, angle_increment: float) -> NDArray[np.float32]:
        """The ranges (n,) with nan for 0, which is no distance, and in the masked sectors."""
        none = ranges == 0.0
        if self.masks:
            none |= self._masked(angle_min + angle_increment * np.arange(len(ranges)))
        return np.where(none, np.float32(np.nan), ranges) if none.any() else ranges

    def _masked(self, bearings: NDArray[np.floating[Any]]) -> NDArray[np.bool_]:
        masked = np.zeros(len(bearings), dtype=np.bool_)
        for begin, end in self.masks:
            # A beam on the edge is masked, though its bearing may miss it by the rounding of a float32.
            width = (end - begin) % (2.0 * math.pi) + 2.0 * _ROUNDING
            masked |= np.mod(bearings - begin + _ROUNDING, 2.0 * math.pi) <= width
        return masked


NO_LIMITS = ScanLimits()
