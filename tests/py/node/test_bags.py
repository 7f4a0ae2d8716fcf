# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Bags played to the node by `rosbag play --clock`, and the same bags replayed: both give the same map."""

import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rospy")
from geometry_msgs.msg import Point, Pose2D
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int64, String

from node.client import Client, Heard, until
from node.conftest import NodeFactory
from node.playing import cut, play, write_marks
from node.running import Core
from oort import load_map, read_parameters
from oort.cli.replay import main as replay
from oort.events import SCAN, read_events
from oort.recording import open_recording
from oort.session import Session
from oort.simulate import Drive, Sensor, SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag

HALFWAY = 70.05  # [s] after the start, between two scans
FILES = (".map_capnp", ".map_meta_capnp")


@dataclass(frozen=True)
class Recorded:
    """A drive in a bag, and the calls that go with it."""

    drive: Drive
    bag: Path
    marks: Path
    calls: list[dict[str, Any]]

    def scans_before(self, time: float) -> int:
        return int(np.searchsorted(self.drive.scan_times, time))


@pytest.fixture(scope="module")
def home() -> Drive:
    """Two and a half minutes from the dock through all rooms and back."""
    return simulate_drive(4, SimulationConfig(minutes=1))


@pytest.fixture(scope="module")
def recorded(home: Drive, tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """All of the drive, with the dock marked at its begin and found again at its end, and a waypoint between."""
    calls: list[dict[str, Any]] = [
        {"t": event.t, "call": event.call, "args": list(event.args)} for event in home.events
    ]
    calls.insert(1, {"t": home.scan_times[0] + HALFWAY, "call": "graph_loc/create", "args": ["", "kitchen"]})
    folder = tmp_path_factory.mktemp("home")
    write_bag(home, folder / "home.bag")
    marks = write_marks(folder / "marks.bag", [call["t"] for call in calls])
    return Recorded(home, folder / "home.bag", marks, calls)


@pytest.fixture(scope="module")
def short_bag(home: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first forty seconds of it."""
    bag = tmp_path_factory.mktemp("short") / "short.bag"
    write_bag(cut(home, slice(400)), bag)
    return bag


def files(base: Path) -> list[bytes]:
    return [base.with_name(base.name + ending).read_bytes() for ending in FILES]


def replayed(bag: Path, out: Path, *options: str | Path) -> list[bytes]:
    """The map that `oort replay` makes of a bag."""
    assert replay([str(bag), *map(str, options), "--out", str(out), "--quiet"]) == 0
    return files(out / "map")


def write_calls(path: Path, calls: list[dict[str, Any]]) -> Path:
    path.write_text(json.dumps(calls))
    return path


def scans_in(log: Path) -> int:
    """How many scans were mapped."""
    return log.read_text().count(f'"{SCAN}"')


def drive_home(ros: Core, client: Client, recorded: Recorded, log: Path) -> None:
    """Plays the bag with its calls between the very scans that their times say."""
    before = scans_in(log)

    def wait_for_scans(count: int) -> None:
        until(lambda: scans_in(log) == before + count, f"{count} scans mapped", 30.0)

    with play(ros, log.parent, recorded.bag, recorded.marks, rate=40.0) as player:
        for number, call in enumerate(recorded.calls):
            player.wait_for_mark(number)
            wait_for_scans(recorded.scans_before(call["t"]))
            client.call(call["call"], *call["args"])
            player.go_on()
        player.wait()
    wait_for_scans(len(recorded.drive.scan_stamps))


def test_twice_in_a_row(ros: Core, rospy: Any, node: NodeFactory, recorded: Recorded, tmp_path: Path) -> None:
    """From start to stop, clear, and again, which sets the clock back; each time what replaying the bag gives."""
    events = write_calls(tmp_path / "calls.json", recorded.calls)
    expected = replayed(recorded.bag, tmp_path / "expected", "--events", events)
    ros.set_parameter("/use_sim_time", True)
    log = tmp_path / "log.json"
    client = Client(node(f"_events_log:={log}"))
    for number in ("first", "second"):
        client.call("map/start", str(tmp_path / number / "map"))
        drive_home(ros, client, recorded, log)
        client.call("map/stop")
        assert client.call("graph_loc/list", "", True).ids == ["dock", "kitchen"]
        assert client.call("map/num_nodes") == len(load_map(str(tmp_path / number / "map"))) > 100
        assert files(tmp_path / number / "map") == expected
        told = client.figures()
        assert (told["scans dropped"], told["clock jumps"]) == ("0", "0")
        client.call("map/clear")
    whole = json.loads(log.read_text())
    end = [entry["call"] for entry in whole].index("map/clear")
    for number, entries in (("first", whole[:end]), ("second", whole[end + 1 : -1])):
        only = write_calls(tmp_path / f"{number}.json", entries)
        assert replayed(recorded.bag, tmp_path / f"replay of the {number}", "--events", only) == expected


def test_start_stop_and_resume_need_no_log(
    ros: Core, rospy: Any, node: NodeFactory, short_bag: Path, tmp_path: Path
) -> None:
    """Played once to begin a map, and again to go on with it."""
    ros.set_parameter("/use_sim_time", True)
    client = Client(node())
    first, second = tmp_path / "first" / "map", tmp_path / "second" / "map"

    def drive(all_scans: int) -> None:
        with play(ros, tmp_path, short_bag) as player:
            player.wait()
        until(lambda: client.figures()["scans received"] == str(all_scans), "all scans have come")
        client.call("map/stop")

    client.call("map/start", str(first))
    drive(400)
    assert files(first) == replayed(short_bag, tmp_path / "replay")
    client.call("map/resume", str(second), Pose2D(0.0, 0.0, 0.0))
    drive(800)
    told = client.figures()
    assert (told["scans processed"], told["clock jumps"]) == ("800", "0")
    assert files(second) == replayed(short_bag, tmp_path / "again", "--resume", first, "--pose", "0", "0", "0")


@pytest.mark.parametrize("use_imu", [False, True])
def test_scans_that_take_time_and_a_gyro(
    ros: Core, rospy: Any, node: NodeFactory, tmp_path: Path, use_imu: bool
) -> None:
    """The bag ends while the robot drives, so that the last scan's beams are beyond the last odometry."""
    sensor = Sensor(sweep_seconds=0.08)
    drive = simulate_drive(4, SimulationConfig(sensor, odometry_error=5.0, minutes=1, gyro=True))
    bag, log, params = tmp_path / "sweep.bag", tmp_path / "log.json", tmp_path / "params.json"
    write_bag(cut(drive, slice(300)), bag)
    params.write_text(json.dumps({"use_imu": use_imu}))
    ros.set_parameter("/use_sim_time", True)
    client = Client(node(f"_events_log:={log}", f"_params:={params}"))
    client.call("map/start", str(tmp_path / "map"))
    with play(ros, tmp_path, bag, imu=use_imu) as player:
        player.wait()
    until(lambda: client.figures()["scans received"] == "300", "all scans have come")
    client.call("map/stop")
    told = client.figures()
    assert (told["scans processed"], told["scans dropped"]) == ("300", "0")
    expected = files(tmp_path / "map")
    assert replayed(bag, tmp_path / "replay", "--events", log, "--params", params) == expected
    if not use_imu:  # what a gyro's odometry is depends on when the node began to listen
        assert replayed(bag, tmp_path / "without log", "--params", params) == expected
    others = tmp_path / "others.json"
    others.write_text(json.dumps({"motion_compensation": False}))
    assert replayed(bag, tmp_path / "otherwise", "--params", others) != expected


def test_calls_at_any_moment_are_replayed_from_the_log(
    ros: Core, rospy: Any, node: NodeFactory, short_bag: Path, tmp_path: Path
) -> None:
    ros.set_parameter("/use_sim_time", True)
    log = tmp_path / "log.json"
    client = Client(node(f"_events_log:={log}"))
    with play(ros, tmp_path, short_bag, rate=10.0) as player:
        until(lambda: client.figures()["scans received"] != "0", "the bag is being played")
        client.call("map/start", str(tmp_path / "map"))
        client.call("graph_loc/create", "", "a")
        until(lambda: scans_in(log) > 50, "fifty scans are mapped")
        client.call("graph_loc/create_points", ["b"], [Point(1.0, 2.0, 0.0)], ["c"])
        client.call("map/notify_docked")
        client.call("map/pause")
        time.sleep(0.2)
        client.call("map/resume_from_paused")
        client.call("graph_loc/delete", "", "a")
        client.call("graph_loc/create", "", "d")
        player.wait()
    client.call("map/stop")
    assert files(tmp_path / "map") == replayed(short_bag, tmp_path / "replay", "--events", log)
    assert 50 < scans_in(log) < 400
    assert {place[1] for place in load_map(str(tmp_path / "map")).locations} == {"c", "d"}


def test_clock_set_back_while_mapping(
    ros: Core, rospy: Any, node: NodeFactory, short_bag: Path, tmp_path: Path
) -> None:
    """It is said, and mapping goes on with all that comes."""
    ros.set_parameter("/use_sim_time", True)
    log = tmp_path / "log.json"
    running = node(f"_events_log:={log}")
    client = Client(running)
    client.call("map/start", str(tmp_path / "map"))
    for scans in (400, 800):
        with play(ros, tmp_path, short_bag) as player:
            player.wait()
        until(lambda scans=scans: scans_in(log) == scans, f"{scans} scans mapped", 30.0)  # type: ignore[misc]
    assert client.state == "mapping"
    told = client.figures()
    assert (told["clock jumps"], told["scans processed"], told["scans dropped"]) == ("1", "800", "0")
    assert "the scans' clock went back by 39.9 s: the map goes on with a very uncertain link" in running.output
    client.call("map/stop")
    assert files(tmp_path / "map") == mapped_by_log(log, short_bag, tmp_path / "again")


@pytest.mark.slow
def test_half_an_hour_in_real_time(ros: Core, rospy: Any, node: NodeFactory, tmp_path: Path) -> None:
    """A client that follows the clock: a waypoint every five minutes, a pause, and the dock at both ends."""
    drive = simulate_drive(4, SimulationConfig(minutes=30))
    bag = tmp_path / "long.bag"
    write_bag(drive, bag)
    start = drive.scan_times[0]
    plan = [(event.t, event.call, event.args) for event in drive.events]
    plan += [(start + 300.0 * k, "graph_loc/create", ("way", str(k))) for k in range(1, 6)]
    plan += [(start + 930.0, "map/pause", ()), (start + 940.0, "map/resume_from_paused", ())]
    plan += [(start + 960.0, "graph_loc/delete", ("way", "1"))]
    ros.set_parameter("/use_sim_time", True)
    log = tmp_path / "log.json"
    client = Client(node(f"_events_log:={log}"))
    client.call("map/start", str(tmp_path / "map"))
    with (
        Heard("/oort_slam/file_changed", String) as saves,
        Heard("/oort_slam/queue_size", Int64) as queue,
        play(ros, tmp_path, bag, rate=1.0) as player,
        Heard("/clock", Clock, "/player") as clock,
    ):

        def reached(t: float) -> bool:
            return bool(clock.messages) and clock.messages[-1].clock.to_sec() >= t

        for t, call, args in sorted(plan):
            until(lambda t=t: reached(t), f"{call} at {t}", 1800.0)  # type: ignore[misc]
            client.call(call, *args)
        player.wait()
    client.call("map/stop")
    assert client.figures()["scans dropped"] == "0"
    assert scans_in(log) > 0.99 * len(drive.scan_stamps)  # all but those of the pause
    assert [save.data for save in saves.messages].count("map") > 0.9 * drive.duration / 15.0
    assert max(size.data for size in queue.messages) < 50
    assert files(tmp_path / "map") == replayed(bag, tmp_path / "replay", "--events", log)


def mapped_by_log(log: Path, bag: Path, base: Path) -> list[bytes]:
    """The map of a log that lists scans of a bag more than once, which no single replay has."""
    recording = open_recording(str(bag))
    scans = {scan.stamp: scan for scan in recording.scans()}
    session = Session(read_parameters(), recording.sensor_on_base)
    for event in read_events(log):
        if event.call == SCAN:
            session.add_scan(scans[event.args[0]])
        else:
            session.call(event.call, event.args)
            session.save_to(str(base))
    session.save()
    return files(base)
