# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A few of the kills of bench/kills.py."""

import sys

from conftest import ROOT

sys.path.insert(0, str(ROOT / "bench"))

from kills import kill_often


def test_a_killed_process_leaves_a_whole_map() -> None:
    counts = kill_often(12, seed=1)
    assert counts.kills == 12
    assert counts.without_map < 12
    assert not counts.lost
