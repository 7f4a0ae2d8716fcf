# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Who may save to a path, and what is kept of the maps that were there."""

import fcntl
import os
from pathlib import Path

import pytest

from helpers.live_rig import Recorder, driven
from oort import LiveMapper, MapFileError, Parameters, load_map
from oort.live import LiveSession
from oort.live.claim import Claim


def test_one_session_at_a_time_saves_to_a_path(recorder: Recorder, tmp_path: Path) -> None:
    path = str(tmp_path / "home")
    first, second = LiveSession(Parameters(), recorder), LiveSession(Parameters(), Recorder())
    first.call("map/start", [path])
    with pytest.raises(MapFileError, match=rf"another session saves its map there \(process {os.getpid()}\)"):
        second.call("map/start", [path])
    assert second.snapshot.state.value == "not_mapping"
    second.call("map/start", [str(tmp_path / "other")])
    driven(first)
    first.close()
    second.call("map/start", [path])
    second.close()
    assert not list(tmp_path.glob(".*.lock"))


def test_two_live_mappers_do_not_share_a_path(tmp_path: Path) -> None:
    with LiveMapper(save_to=tmp_path / "home"), pytest.raises(MapFileError, match="another session"):
        LiveMapper(save_to=tmp_path / "home")
    LiveMapper(save_to=tmp_path / "home").close()


def test_a_map_that_was_loaded_is_not_saved_over_another_session(tmp_path: Path) -> None:
    path = str(tmp_path / "home")
    with LiveSessionAt(path) as first:
        driven(first)
        first.call("map/stop")
        other = LiveSession(Parameters(), Recorder())
        other.call("map/load", [path])
        with pytest.raises(MapFileError, match="another session"):
            other.call("graph_loc/create_points", [["rooms"], [(0.0, 0.0)], ["kitchen"]])
        other.close()
    assert load_map(path).locations == []


class LiveSessionAt:
    """A session that maps to a path and closes itself."""

    def __init__(self, path: str) -> None:
        self._live = LiveSession(Parameters(), Recorder())
        self._live.call("map/start", [path])

    def __enter__(self) -> LiveSession:
        return self._live

    def __exit__(self, *_: object) -> None:
        self._live.close()


def test_a_lock_that_was_left_behind_holds_nothing(tmp_path: Path) -> None:
    (tmp_path / ".home.lock").write_text("1\n")
    claim = Claim(str(tmp_path / "home"))
    assert claim.is_for(str(tmp_path / "home.map_capnp"))
    claim.release()
    claim = Claim(str(tmp_path / "home"))
    claim.release()


def test_a_lock_file_that_goes_while_it_is_waited_for_is_made_again(tmp_path: Path) -> None:
    first = Claim(str(tmp_path / "home"))
    stale = os.open(tmp_path / ".home.lock", os.O_RDWR)
    first.release()
    fcntl.flock(stale, fcntl.LOCK_EX)
    Claim(str(tmp_path / "home")).release()
    os.close(stale)


def test_a_link_in_the_place_of_the_lock_is_refused(tmp_path: Path) -> None:
    (tmp_path / "precious").write_text("precious")
    (tmp_path / ".home.lock").symlink_to(tmp_path / "precious")
    with pytest.raises(MapFileError, match="cannot be made"):
        Claim(str(tmp_path / "home"))
    assert (tmp_path / "precious").read_text() == "precious"
