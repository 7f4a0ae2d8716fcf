# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Windows of samples and rates."""

import math
import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from oort.live.window import Rate, Spread, Window

samples = st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=50)


def filled(values: list[float], size: int = 600) -> Window:
    window = Window(size)
    for value in values:
        window.add(value)
    return window


def test_nothing_measured_has_no_spread() -> None:
    assert Window().spread is None


def test_known_values() -> None:
    assert filled([float(value) for value in range(1, 101)]).spread == Spread(50.0, 99.0, 100.0)
    assert filled([7.0]).spread == Spread(7.0, 7.0, 7.0)


@given(values=samples)
def test_a_percentile_is_the_least_sample_that_enough_do_not_exceed(values: list[float]) -> None:
    spread = filled(values).spread
    assert spread is not None
    for value, share in ((spread.p50, 0.5), (spread.p99, 0.99), (spread.max, 1.0)):
        assert value in values
        assert sum(sample <= value for sample in values) >= share * len(values)
        assert sum(sample < value for sample in values) < share * len(values)


@given(values=samples, size=st.integers(1, 20))
def test_only_the_last_samples_count(values: list[float], size: int) -> None:
    window = filled(values, size)
    assert len(window) == min(size, len(values))
    assert window.spread == filled(values[-size:]).spread


def test_reading_while_another_thread_adds() -> None:
    window, stop = Window(1000), threading.Event()

    def add() -> None:
        while not stop.is_set():
            window.add(1.0)

    thread = threading.Thread(target=add)
    thread.start()
    try:
        for _ in range(300):
            assert window.spread in (None, Spread(1.0, 1.0, 1.0))
    finally:
        stop.set()
        thread.join()


@given(hertz=st.floats(1.0, 100.0), begin=st.floats(0.0, 1e6))
def test_rate_of_a_steady_sensor(hertz: float, begin: float) -> None:
    rate = Rate()
    times = [begin + k / hertz for k in range(300)]
    for now in times:
        rate.add(now)
    assert rate.hertz(times[-1]) == pytest.approx(hertz, rel=1e-4)


def test_rate_is_of_the_last_while_only() -> None:
    rate = Rate(horizon=2.0)
    for k in range(20):
        rate.add(0.1 * k)
    for now in (10.0, 11.0, 12.0):
        rate.add(now)
    assert rate.hertz(12.0) == 1.0
    assert rate.hertz(13.5) == 0.0  # one is left, and one tells nothing
    assert rate.hertz(99.0) == 0.0


def test_rate_with_nothing_or_all_at_once() -> None:
    rate = Rate()
    assert rate.hertz(1.0) == 0.0
    rate.add(1.0)
    rate.add(1.0)
    assert rate.hertz(1.0) == 0.0


def test_rate_survives_a_clock_that_is_set_back() -> None:
    rate = Rate()
    for now in (100.0, 100.1, 1.0, 1.5, 2.0):
        rate.add(now)
    assert math.isclose(rate.hertz(2.0), 2.0)
