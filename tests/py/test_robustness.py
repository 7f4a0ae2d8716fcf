# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odd orders of calls, senseless input and gaps: nothing is lost, bent or answered with a traceback."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.recording_files import flaser
from helpers.scenes import room_scan
from oort import InputError, Parameters, Session, StateError, load_map
from oort.cli.replay import main
from oort.export.tum import read_tum
from test_session import drive_around


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """Six seconds in a room, as a log."""
    path = tmp_path / "log.clf"
    scans = [room_scan(0.02 * k, 0.0, 0.02 * k, 0.1 * k) for k in range(60)]
    lines = [flaser(s.stamp, s.ranges.tolist(), s.odometry) for s in scans]
    path.write_text("".join(line + "\n" for line in lines))
    return path


def replay(log: Path, out: Path, *entries: Any, options: tuple[str, ...] = ()) -> int:
    calls = out.with_suffix(".events.json")
    calls.write_text(json.dumps(list(entries)))
    return main([str(log), "--out", str(out), "--quiet", "--events", str(calls), *options])


def test_a_link_over_a_gap_without_matches_is_as_uncertain_as_odometry() -> None:
    """Two metres through clutter that matches nothing, odometry off by 0.4 m: no edge may deny that."""
    rng = np.random.Generator(np.random.PCG64(1))
    session = Session(Parameters())
    session.start()
    times = []
    for k in range(200):
        drift = 0.4 * min(max(k - 60, 0), 40) / 40
        scan = room_scan(-1.5 + 0.02 * k, 0.0, 0.0, 0.1 * k)
        if 60 <= k < 100:
            scan.ranges[:] = rng.uniform(0.3, 3.0, 180)
        object.__setattr__(scan, "odometry", (scan.odometry[0] + drift, 0.0, 0.0))
        session.add_scan(scan)
        times.append(scan.time)
    map_ = session.map
    truth = -1.5 + 0.2 * map_.cloud_times
    for i, j, pose, covariance in zip(
        map_.edges["i"], map_.edges["j"], map_.edges["pose"], map_.edges["covariance"], strict=True
    ):
        error = abs(pose[0] - (truth[j] - truth[i]))
        assert error < 4.0 * np.sqrt(covariance[0, 0]), f"edge {i} to {j} is wrong by {error:.3f} m"


@pytest.mark.parametrize("jump", [3e6, 1e300])
def test_a_senseless_jump_of_odometry_is_an_input_error(jump: float) -> None:
    session = Session(Parameters())
    session.start()
    drive_around(session)
    scan = room_scan(0.6, 0.0, 1.2, 20.0)
    object.__setattr__(scan, "odometry", (jump, 0.0, 1.2))
    with pytest.raises(InputError):
        session.add_scan(scan)


def test_a_dock_without_play_is_searched_at_its_place() -> None:
    parameters = Parameters()
    parameters.set("dock_graph_builder.dock_contacts_size", 0.0)
    parameters.set("dock_graph_builder.dock_max_translation", 0.0)
    session = Session(parameters)
    session.start()
    drive_around(session, scans=150)
    session.notify_docked()


def test_notify_docked_after_a_pause_waits_for_a_scan() -> None:
    session = Session(Parameters())
    session.start()
    drive_around(session, scans=100)
    session.pause()
    session.resume_from_paused()
    nodes = session.mapper.num_nodes
    with pytest.raises(StateError):
        session.notify_docked()
    assert session.mapper.num_nodes == nodes


@pytest.mark.parametrize(
    ("call", "args"),
    [
        ("map/start", [5]),
        ("graph_loc/create", ["dock", 5]),
        ("graph_loc/create_points", [["p"], [[1.0]], ["q"]]),
        ("graph_loc/create_points", [["p"], [["x", "y"]], ["q"]]),
        ("map/resume", ["new", [1.0, 2.0]]),
        ("map/resume", ["new", ["x", 1.0, 2.0]]),
    ],
)
def test_wrong_arguments_are_one_line_of_state_error(call: str, args: list[Any]) -> None:
    session = Session(Parameters())
    if call != "map/start":
        session.start()
        drive_around(session)
    if call == "map/resume":
        session.stop()
    with pytest.raises(StateError) as caught:
        session.call(call, args)
    assert "\n" not in str(caught.value)


def test_replay_saves_where_it_was_told_not_where_the_robot_did(log: Path, tmp_path: Path) -> None:
    robots = tmp_path / "robots_map"
    assert replay(log, tmp_path / "out", {"t": 0.0, "call": "map/start", "args": [str(robots)]}) == 0
    assert not list(tmp_path.glob("robots_map*"))
    assert len(load_map(str(tmp_path / "out" / "map"))) > 0


def test_scans_before_map_clear_keep_their_way(log: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    clear = [{"t": 3.0, "call": "map/clear"}, {"t": 3.0, "call": "map/start", "args": [str(out / "map")]}]
    assert replay(log, out, {"t": 0.0, "call": "map/start", "args": [""]}, *clear) == 0
    poses = read_tum(out / "trajectory.tum").poses
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() < 0.05


def test_calls_out_of_order_take_effect_at_their_own_time(log: Path, tmp_path: Path) -> None:
    late = {"t": 5.0, "call": "graph_loc/create", "args": ["p", "late"]}
    early = {"t": 1.0, "call": "graph_loc/create", "args": ["p", "early"]}
    assert replay(log, tmp_path / "out", late, early) == 0
    nodes = {location[1]: location[2] for location in load_map(str(tmp_path / "out" / "map")).locations}
    assert nodes["early"] < nodes["late"]


def test_going_on_with_a_map_never_overwrites_it(log: Path, tmp_path: Path) -> None:
    """The old file is not touched. The default folder of a second replay is that of the first."""
    out = tmp_path / "out"
    assert replay(log, out) == 0
    old = (out / "map.map_capnp").read_bytes()
    assert replay(log, out, options=("--resume", str(out / "map"), "--pose", "0", "0", "0")) == 2
    assert (out / "map.map_capnp").read_bytes() == old


def test_a_recording_without_any_return_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "blind.clf"
    log.write_text("".join(flaser(f"{0.1 * k:.6f}", [81.91] * 180, (0.0, 0.0, 0.0)) + "\n" for k in range(20)))
    assert replay(log, tmp_path / "out") == 2
    assert "return" in capsys.readouterr().err
    assert not list((tmp_path / "out").glob("*"))
