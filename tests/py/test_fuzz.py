# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What reads files in Python, with inputs changed by chance (tests/fuzz/readers.py): nothing but an OortError."""

import sys

import pytest

from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests" / "fuzz"))

import readers


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("reader", readers.READERS)
def test_changed_inputs_are_read_or_refused(reader: str) -> None:
    readable = readers.by_chance(reader, 200)
    assert 0 < readable < 200
