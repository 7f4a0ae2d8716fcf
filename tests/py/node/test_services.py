# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The services map/* through a client of ROS: what each does, and what it says when it cannot."""

import threading
import time
from pathlib import Path

import pytest

pytest.importorskip("rospy")
from geometry_msgs.msg import Pose2D
from std_msgs.msg import Int64, String

from node.client import SERVICES, Client, Heard, until
from node.robot import COURSE, SHORT, Course, Robot
from node.running import Core
from oort import Parameters, load_map, render_map

pytest_plugins = ["node.fixtures"]
pytestmark = pytest.mark.usefixtures("cleared")

ORIGIN = Pose2D(0.0, 0.0, 0.0)


def files(path: str) -> dict[str, bytes]:
    """The files of a saved map by their endings."""
    return {file.suffix: file.read_bytes() for file in Path(path).parent.glob(f"{Path(path).name}*")}


def test_all_services_are_there_and_no_others(ros: Core, client: Client) -> None:
    of_every_node = {"get_loggers", "set_logger_level"}
    offered = {name for name, providers in ros.master("getSystemState")[2] if client.name in providers}
    assert offered == {f"{client.name}/{name}" for name in SERVICES.keys() | of_every_node}


# ---- start ----


def test_start_maps_and_saves(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    assert client.state == "mapping"
    assert client.call("map/name") == path
    robot.drive(SHORT)
    until(lambda: Path(f"{path}.md5").exists(), "the first save")
    assert files(path).keys() == {".map_capnp", ".map_meta_capnp", ".md5"}


def test_start_without_a_path_writes_nothing(client: Client, robot: Robot) -> None:
    with Heard("/oort_slam/file_changed", String) as saved:
        client.call("map/start", "")
        assert (client.state, client.call("map/name")) == ("mapping", "")
        robot.drive(SHORT)
        client.call("graph_loc/create", "a", "1")
        client.call("map/stop")
        assert client.call("map/num_nodes") > 2
        time.sleep(0.2)
        assert not saved.messages


def test_start_while_mapping_changes_the_path(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/start", path)
    assert (client.state, client.call("map/name")) == ("mapping", path)
    client.call("map/stop")
    assert len(load_map(path)) == client.call("map/num_nodes")


def test_start_on_a_map(client: Client, mapped: Course, path: str) -> None:
    refusal = client.refusal("map/start", path)
    assert refusal == "map/start: there is a map already; call map/clear first, or map/resume to go on with it"
    client.call("map/load", path)
    assert "call map/clear first" in client.refusal("map/start", f"{path}2")
    assert (client.state, client.call("map/name")) == ("not_mapping", path)
    client.call("map/clear")
    client.call("map/start", path)


@pytest.mark.parametrize("service", ["map/start", "map/load"])
def test_a_relative_path(client: Client, service: str) -> None:
    assert "'maps/7' is not absolute; give the whole path" in client.refusal(service, "maps/7")
    assert client.state == "not_mapping"


def test_a_place_that_cannot_be_written(client: Client, mapped: Course, path: str, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    refusal = client.refusal("map/resume", str(tmp_path / "file/7/map"), ORIGIN)
    assert refusal.startswith(f"map/resume: the folder {tmp_path}/file/7 cannot be made: ")
    client.call("map/clear")
    assert "cannot be made" in client.refusal("map/start", str(tmp_path / "file/map"))
    assert client.state == "not_mapping"


def test_a_name_is_kept_to_the_letter(client: Client, robot: Robot, tmp_path: Path) -> None:
    odd = f"{tmp_path}/Müllers 'Küche'//map.capnp"
    client.call("map/start", odd)
    assert client.call("map/name") == odd
    robot.drive(SHORT)
    client.call("map/stop")
    client.call("map/load", odd)
    assert client.call("map/name") == odd


# ---- load ----


def test_load(client: Client, mapped: Course, path: str) -> None:
    nodes, before = client.call("map/num_nodes"), files(path)
    client.call("map/clear")
    client.call("map/load", path)
    assert client.state == "not_mapping"
    assert client.call("map/has_map")
    assert (client.call("map/num_nodes"), client.call("map/name")) == (nodes, path)
    assert files(path) == before


def test_load_of_what_is_no_map(client: Client, mapped: Course, path: str, tmp_path: Path) -> None:
    nodes, whole = client.call("map/num_nodes"), files(path)

    def refusal(name: str, **changed: bytes) -> str:
        base = tmp_path / name
        for suffix, content in (whole | {f".{suffix}": content for suffix, content in changed.items()}).items():
            base.with_suffix(suffix).write_bytes(content)
        return client.refusal("map/load", str(base))

    assert str(tmp_path / "none") in client.refusal("map/load", str(tmp_path / "none"))
    torn = whole[".map_capnp"][:-100]
    assert "torn" in refusal("torn", map_capnp=torn)
    flipped = bytes([whole[".map_capnp"][-1] ^ 1])
    assert "md5" in refusal("flipped", map_capnp=whole[".map_capnp"][:-1] + flipped)
    assert "md5" in refusal("unsummed", md5=b"")
    assert (client.call("map/num_nodes"), client.call("map/name"), client.state) == (nodes, path, "not_mapping")
    assert client.call("map/has_map")


def test_load_while_mapping(client: Client, robot: Robot, mapped: Course, path: str) -> None:
    nodes = client.call("map/num_nodes")
    client.call("map/clear")
    client.call("map/start", f"{path}2")
    robot.drive(COURSE)
    client.refusal("map/load", f"{path}3")
    assert client.state == "mapping"  # nothing was lost
    client.call("map/load", path)
    assert (client.state, client.call("map/num_nodes"), client.call("map/name")) == ("not_mapping", nodes, path)


# ---- resume ----


def test_resume(client: Client, robot: Robot, mapped: Course, path: str, tmp_path: Path) -> None:
    nodes, before = client.call("map/num_nodes"), files(path)
    resumed = str(tmp_path / "oort_maps/8/map")
    client.call("map/resume", resumed, ORIGIN)
    assert client.state == "mapping"
    assert client.call("map/has_map")
    assert client.call("map/name") == resumed
    robot.drive(COURSE)
    client.call("map/stop")
    assert len(load_map(resumed)) == client.call("map/num_nodes") > nodes
    assert files(path) == before


def test_resume_without_a_map(client: Client, path: str) -> None:
    assert client.refusal("map/resume", path, ORIGIN) == "map/resume: no map is loaded; call map/load first"


def test_resume_while_mapping(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    assert "the state is mapping; call map/stop first" in client.refusal("map/resume", path, ORIGIN)
    client.call("map/pause")
    assert "the state is paused; call map/stop first" in client.refusal("map/resume", path, ORIGIN)


def test_resume_onto_the_same_path(client: Client, mapped: Course, path: str) -> None:
    assert "give another path" in client.refusal("map/resume", path, ORIGIN)
    assert "give another path" in client.refusal("map/resume", f"{path}.map_capnp", ORIGIN)
    assert "is not absolute" in client.refusal("map/resume", "maps/7", ORIGIN)
    assert (client.state, client.call("map/name")) == ("not_mapping", path)


def test_resume_at_no_pose(client: Client, mapped: Course, path: str) -> None:
    assert "finite" in client.refusal("map/resume", f"{path}2", Pose2D(float("nan"), 0.0, 0.0))
    assert (client.state, client.call("map/name")) == ("not_mapping", path)


# ---- pause, resume_from_paused, notify_docked ----


def test_pause_and_resume_from_paused(client: Client, robot: Robot) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/pause")
    nodes = client.call("map/num_nodes")
    robot.drive(COURSE)
    client.call("map/pause")
    assert (client.state, client.call("map/num_nodes")) == ("paused", nodes)
    client.call("map/resume_from_paused")
    assert client.state == "mapping"
    robot.drive(COURSE[:2])
    client.call("map/resume_from_paused")
    assert (client.state, client.call("map/num_nodes")) == ("mapping", nodes + 1)


def test_start_goes_on_after_a_pause(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", "")
    robot.drive(SHORT)
    client.call("map/pause")
    nodes = client.call("map/num_nodes")  # of all scans: the pause comes after those that were sent before
    client.call("map/start", path)
    assert (client.state, client.call("map/name")) == ("mapping", path)
    robot.drive(COURSE[:2])
    until(lambda: client.call("map/num_nodes") == nodes + 1, "a node after the pause")


def test_calls_that_need_mapping(client: Client, mapped: Course) -> None:
    def refusals() -> None:
        assert client.refusal("map/pause") == "map/pause: nothing is being mapped; call map/start first"
        assert "call map/start first" in client.refusal("map/resume_from_paused")
        assert "the state is not_mapping; it needs mapping" in client.refusal("map/notify_docked")
        assert client.state == "not_mapping"

    refusals()  # with a map
    client.call("map/clear")
    refusals()
    client.call("map/start", "")
    client.call("map/pause")
    assert "the state is paused; it needs mapping" in client.refusal("map/notify_docked")


def test_notify_docked(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    robot.drive(COURSE[:1])
    client.call("graph_loc/create", "dock", "dock")
    robot.drive(COURSE)
    robot.drive(COURSE[:3])  # not enough for a node
    client.call("graph_loc/delete", "no", "place")  # takes its turn behind the scans
    nodes = client.call("map/num_nodes")
    client.call("map/notify_docked")
    assert client.call("map/num_nodes") == nodes + 1
    client.call("map/stop")
    links = load_map(path).switchable_edges
    assert {links["i"][-1], links["j"][-1]} == {0, nodes}


# ---- stop and clear ----


def test_stop_waits_until_the_queue_is_empty(client: Client, robot: Robot, path: str) -> None:
    robot.base_on = False
    before = client.figures()
    client.call("map/start", path)
    with Heard("/oort_slam/queue_size", Int64) as queue:
        scans = COURSE[:100]
        stamps = robot.drive(scans, odometry=False) + robot.drive(scans, odometry=False)
        queue.wait_for(lambda message: message.data == 200, "200 scans that wait")
        stopping = threading.Thread(target=client.call, args=["map/stop"])
        stopping.start()
        queue.wait_for(lambda message: message.data == 201, "the call in the queue")
        assert stopping.is_alive()
        assert client.state == "mapping"
        robot.tell_odometry(stamps[:100], scans)
        robot.tell_odometry(stamps[100:], scans)
        stopping.join()
        assert client.state == "not_mapping"
        until(lambda: queue.messages[-1].data == 0, "an empty queue")
    after = client.figures()
    assert int(after["scans processed"]) == int(before["scans processed"]) + 200
    assert after["scans dropped"] == before["scans dropped"]
    assert len(load_map(path)) == client.call("map/num_nodes")


def test_stop_when_nothing_is_mapped(client: Client, robot: Robot, mapped: Course, path: str) -> None:
    Path(f"{path}.md5").unlink()
    client.call("map/stop")
    assert Path(f"{path}.md5").exists()
    client.call("map/clear")
    client.call("map/stop")
    assert client.state == "not_mapping"
    assert not client.call("map/has_map")


def test_stop_from_a_pause(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    robot.drive(SHORT)
    client.call("map/pause")
    client.call("map/stop")
    assert client.state == "not_mapping"
    assert len(load_map(path)) == client.call("map/num_nodes")


def test_clear(client: Client, mapped: Course, path: str) -> None:
    before = files(path)
    client.call("map/clear")
    assert (client.state, client.call("map/name"), client.call("map/num_nodes")) == ("not_mapping", "", 0)
    assert not client.call("map/has_map")
    assert files(path) == before


# ---- what only asks ----


def test_has_map_in_each_state(client: Client, robot: Robot, path: str) -> None:
    assert not client.call("map/has_map")
    client.call("map/start", path)
    assert not client.call("map/has_map")
    robot.drive(SHORT)
    until(lambda: client.call("map/has_map"), "a map while mapping", 3.0)
    client.call("map/pause")
    assert client.call("map/has_map")
    client.call("map/stop")
    assert client.call("map/has_map")
    client.call("map/clear")
    assert not client.call("map/has_map")
    client.call("map/load", path)
    assert client.call("map/has_map")
    client.call("map/resume", f"{path}2", ORIGIN)
    assert client.call("map/has_map")


def test_map(client: Client, robot: Robot, path: str) -> None:
    client.call("map/start", path)
    robot.drive(COURSE)
    while_mapping = client.call("map/map")
    assert while_mapping.header.frame_id == "map"
    assert sum(cell == 0 for cell in while_mapping.data) > 1000
    client.call("map/stop")
    grid, _ = render_map(load_map(path), Parameters())
    assert bytes(cell % 256 for cell in client.call("map/map").data) == grid.cells.tobytes()


def test_map_without_a_map(client: Client, robot: Robot) -> None:
    """It waits ten seconds, in which the other services answer."""
    refusals: list[str] = []
    asking = threading.Thread(target=lambda: refusals.append(client.refusal("map/map")))
    started = time.monotonic()
    asking.start()
    client.call("map/start", "")
    while asking.is_alive():
        asked = time.monotonic()
        assert client.state == "mapping"
        assert time.monotonic() - asked < 0.5
        asking.join(0.5)
    assert 9.9 < time.monotonic() - started < 12.0
    assert refusals == ["map/map: there is no map after 10 s; call map/start and drive, or map/load"]


def test_map_waits_for_the_first_one(client: Client, robot: Robot) -> None:
    maps = []
    asking = threading.Thread(target=lambda: maps.append(client.call("map/map")))
    asking.start()
    client.call("map/start", "")
    robot.drive(SHORT)
    asking.join(5.0)
    assert maps[0].info.width > 0


def test_republish_maps_without_a_map(client: Client) -> None:
    refusal = client.refusal("map/republish_maps")
    assert refusal == "map/republish_maps: there is no map; call map/start and drive, or map/load"


# ---- typed ----


def test_a_refusal_as_rosservice_shows_it(ros: Core, client: Client) -> None:
    done = ros.run("rosservice", "call", "oort_slam/map/start", "maps/7")
    assert done.returncode == 2
    assert "give the whole path, such as /home/me/map" in done.stderr


def test_answers_as_rosservice_shows_them(ros: Core, client: Client, mapped: Course, path: str) -> None:
    assert ros.run("rosservice", "call", "oort_slam/map/name").stdout == f'data: "{path}"\n'
    assert ros.run("rosservice", "call", "oort_slam/map/has_map").stdout == "data: True\n"
