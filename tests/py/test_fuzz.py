# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What reads in Python, with inputs changed by chance (tests/fuzz/readers.py): nothing but an OortError."""

import sys

import pytest

from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests" / "fuzz"))

import readers

SLOW = {"words": 60, "requests": 60, "laser": 25, "echoes": 25, "transform": 25, "static": 25, "imu": 25}
"""How many inputs; of the others 200."""


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("reader", readers.READERS)
def test_changed_inputs_are_read_or_refused(reader: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OORT_DEBUG", "1")  # faults of Oort's own come through
    count = SLOW.get(reader, 200)
    readable = readers.by_chance(reader, count)
    assert 0 < readable < count
