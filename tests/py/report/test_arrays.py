# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays within a page."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from oort.report.arrays import pack, unpack

_LIMITS = {"i4": 2**31 - 1, "i2": 2**15 - 1, "u1": 255}


@given(st.lists(st.floats(width=32)), st.just("f4"))
def test_numbers_come_back(values: list[float], type_: str) -> None:
    np.testing.assert_array_equal(unpack(pack(values, type_)), np.array(values, dtype=np.float32))


@given(st.lists(st.integers(0, 10**12)), st.sampled_from(sorted(_LIMITS)))
def test_whole_numbers_come_back_within_the_limits_of_their_type(values: list[int], type_: str) -> None:
    expected = [min(value, _LIMITS[type_]) for value in values]
    assert unpack(pack(np.array(values, dtype=np.int64), type_)).tolist() == expected


def test_shapes_come_back() -> None:
    assert unpack(pack(np.zeros((0, 3)), "f4")).shape == (0, 3)
    assert unpack(pack(np.arange(6).reshape(2, 3), "i2")).tolist() == [[0, 1, 2], [3, 4, 5]]


def test_other_types_are_refused() -> None:
    with pytest.raises(ValueError, match="f8"):
        pack([1.0], "f8")
