# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What is kept of each scan for the timeline."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from oort.report.scan_log import ScanLog, thinned


def _log(count: int) -> ScanLog:
    log = ScanLog()
    for k in range(count):
        log.add(0.1 * k, None)
        log.states[-1] = 0
        log.seconds[-1], log.waited[-1], log.inlier_ratios[-1] = 0.001, 0.0, 0.9
    return log


@given(st.integers(1, 300), st.integers(1, 50), st.integers(0, 299))
def test_a_short_trouble_is_not_thinned_away(count: int, most: int, where: int) -> None:
    log = _log(count)
    where %= count
    log.states[where], log.seconds[where], log.inlier_ratios[where] = 2, 0.5, 0.1
    rows, columns = thinned(log, most)
    assert len(rows) == len(columns["time"]) == min(count, most)
    row = np.searchsorted(rows, where, side="right") - 1
    assert columns["state"][row] == 2
    assert columns["local_ms"][row] == 500.0
    assert columns["inlier_ratio"][row] == 0.1
    assert (np.diff(columns["time"]) > 0).all()


def test_no_scans_make_no_rows() -> None:
    rows, columns = thinned(ScanLog(), 10)
    assert len(rows) == 0
    assert all(len(column) == 0 for column in columns.values())


def test_scans_without_a_match_have_no_inlier_ratio() -> None:
    log = _log(3)
    log.inlier_ratios[1] = np.nan
    assert log.matched_inlier_ratios.tolist() == [0.9, 0.9]
    _, columns = thinned(log, 1)
    assert columns["inlier_ratio"].tolist() == [0.9]
