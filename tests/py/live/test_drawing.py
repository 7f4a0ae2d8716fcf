# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a live session's map is drawn: each revision once, and a failure ends nothing."""

import threading
import time
from pathlib import Path
from typing import Any

import pytest

from helpers.live_rig import Recorder, driven, until
from oort import InputError, Map, Parameters, StateError, render_map
from oort.live import LiveSession
from oort.session import State


def test_has_map_and_clear(live: LiveSession) -> None:
    assert not live.has_map
    live.call("map/start", [""])
    driven(live)
    live.call("map/stop")
    assert live.has_map
    live.call("map/clear")
    assert not live.has_map
    assert live.snapshot.places == {}
    live.call("map/start", [""])


def test_no_map_within_the_time(live: LiveSession, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("oort.live.gallery.MAP_TIMEOUT", 0.3)
    with pytest.raises(StateError, match="no map"):
        live.gallery.latest(live.snapshot.revision)


@pytest.fixture
def rendered(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The nodes of each map that was rendered."""
    rendered: list[int] = []

    def render(map_: Map, parameters: Parameters) -> Any:
        rendered.append(len(map_))
        time.sleep(0.1)
        return render_map(map_, parameters)

    monkeypatch.setattr("oort.live.gallery.render_map", render)
    return rendered


@pytest.fixture
def stopped(live: LiveSession) -> LiveSession:
    """A session with a map that was drawn."""
    live.call("map/start", [""])
    driven(live)
    live.call("map/stop")
    return live


def test_one_drawing_serves_all_who_wait(live: LiveSession, rendered: list[int]) -> None:
    live.call("map/start", [""])
    driven(live)
    until(lambda: live.gallery.drawing is not None)
    time.sleep(1.2)
    driven(live, start=6.0)
    rendered.clear()
    asking = [threading.Thread(target=live.gallery.latest, args=[live.snapshot.revision]) for _ in range(5)]
    for thread in asking:
        thread.start()
    for thread in asking:
        thread.join()
    assert len(rendered) <= 2, "one may have been under way"
    assert live.gallery.latest(live.snapshot.revision).revision == live.snapshot.revision


def test_showing_it_again_does_not_draw_it_again(rendered: list[int], stopped: LiveSession, recorder: Recorder) -> None:
    rendered.clear()
    shown = recorder.drawings[-1]
    recorder.drawings.clear()
    stopped.redraw()
    stopped.redraw()
    assert recorder.drawings == [shown, shown]
    assert not rendered


def test_a_place_is_told_without_drawing(rendered: list[int], recorder: Recorder) -> None:
    live = LiveSession(Parameters(), recorder, localiser=lambda: (0.3, 0.1, 0.5))
    live.call("map/start", [""])
    driven(live)
    live.call("map/stop")
    rendered.clear()
    recorder.drawings.clear()
    live.places.create("a", "b")
    assert [list(snapshot.places) for snapshot in recorder.places] == [[("a", "b")]]
    assert not live.call("graph_loc/delete", ["no", "no"])
    time.sleep(1.3)
    assert len(recorder.places) == 1
    assert not rendered
    assert not recorder.drawings
    live.close()


# ---- what cannot be drawn ----


@pytest.fixture
def unpaintable(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How often the rendering was tried, and failed."""
    tries: list[int] = []

    def render(map_: Map, _: Parameters) -> None:
        tries.append(len(map_))
        raise InputError("the map is too wide")

    monkeypatch.setattr("oort.live.gallery.render_map", render)
    return tries


def test_a_failure_is_told_once_and_fails_no_call(
    live: LiveSession, recorder: Recorder, unpaintable: list[int], tmp_path: Path
) -> None:
    live.call("map/start", [str(tmp_path / "map")])
    driven(live)
    live.call("map/stop")
    tries = len(unpaintable)
    time.sleep(1.3)
    assert len(unpaintable) == tries <= 2, "a revision is tried once"
    assert recorder.troubles == ["the map cannot be drawn: the map is too wide"]
    assert live.snapshot.state is State.NOT_MAPPING
    live.call("map/load", [str(tmp_path / "map")])
    with pytest.raises(InputError, match="too wide"):
        live.redraw()
    started = time.monotonic()
    with pytest.raises(StateError, match="map/map: the map cannot be drawn: the map is too wide"):
        live.gallery.latest(live.snapshot.revision)
    assert time.monotonic() - started < 1.0


def test_a_failure_is_not_repeated_at_once(live: LiveSession, unpaintable: list[int]) -> None:
    live.call("map/start", [""])
    for _ in range(20):
        driven(live, 30)  # a node or more
    assert 1 <= len(unpaintable) <= 3
