# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A robot's day with Oort's nodes in ROS 2: in real time, all by ROS clients.

    .venv-ros2/bin/python bench/ros2_day.py [--minutes 10] [--rate 1] [--resolution 0.05]

A simulated robot maps its home (with the calls at the dock that belong to the drive, a place in the middle, and the
stop), is then found on the saved map by the localiser, and goes on with the map from there. Prints a table: what was
mapped, CPU of the nodes, delays from a scan to map -> odom as the node tells them, and how far poses
are from the truth. ``--rate 4`` plays the drive four times as fast: 40 scans a second. ``--resolution 0.0085`` makes
the map of a home, which a client hears as it grows, as large as 1000 x 1000 cells.
"""

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests/py"))

from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from tf2_msgs.msg import TFMessage

from helpers.course import ODOM, of_drive
from node.peer import Peer, Program, running, until
from node.peer_rclpy import RclpyPeer
from node.rover import Rover
from oort.node.messages import transform, yaw
from oort.poses import Array, between, compose
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.messages import BASE_FRAME

SLAM, LOCALIZER = "/oort_slam", "/oort_localizer"
AGAIN = 60.0  # [s] of the drive for the localiser, and for going on
_TICKS = os.sysconf("SC_CLK_TCK")  # [1/s]
_EVENTS = {"graph_loc/create": "LocCreate", "map/notify_docked": "Empty"}


class Player:
    """Publishes a drive as it was, so many times as fast."""

    def __init__(self, peer: Peer, drive: Drive, rate: float) -> None:
        self._peer, self._drive, self._rate = peer, drive, rate
        self._course = of_drive(drive)
        self._rover = Rover(peer, self._course)
        self._tf = peer.publisher("/tf", TFMessage)
        self.sent: list[float] = []
        """[s] time.monotonic() of each scan"""

    def play(self, seconds: float, calls: Sequence[tuple[float, Callable[[], object]]] = ()) -> None:
        """The first seconds of the drive, with calls at times of the drive."""
        begin = self._drive.odometry_times[0]
        # A robot drives on while it waits for an answer; if it stood, the scans that were due would come all at once.
        with ThreadPoolExecutor(1) as caller:
            made = []
            started, waiting = time.monotonic(), sorted(calls, key=lambda call: call[0])
            scan = 0
            for number, at in enumerate((self._drive.odometry_times - begin).tolist()):
                if at > seconds:
                    break
                while waiting and waiting[0][0] - begin < at:
                    made.append(caller.submit(waiting.pop(0)[1]))
                time.sleep(max(0.0, started + at / self._rate - time.monotonic()))
                scan = self._tell(number, scan)
            for call in made:
                call.result()

    def _tell(self, number: int, scan: int) -> int:
        """Odometry and, if one was taken there, the scan; the number of the next."""
        drive, stamp = self._drive, self._peer.now()
        x, y, theta = drive.T_odom_base[number].tolist()
        self._tf(TFMessage(transforms=[transform(ODOM, BASE_FRAME, stamp, (x, y, theta))]))
        if scan == len(drive.scan_stamps) or drive.scan_stamps[scan] != drive.odometry_stamps[number]:
            return scan
        self.sent.append(time.monotonic())
        self._rover.scan(self._course, scan, stamp)
        return scan + 1


class Poses:
    """map -> odom as a client hears it."""

    def __init__(self, peer: Peer) -> None:
        self._messages = peer.hear("/tf", TFMessage)

    def last(self) -> tuple[float, float, float]:
        """The newest."""
        ours = [one for message in list(self._messages) for one in message.transforms if one.child_frame_id == ODOM]
        moved = ours[-1].transform
        return moved.translation.x, moved.translation.y, yaw(moved.rotation)


def cpu_seconds(program: Program) -> float:
    """That a process has used, in all of its threads."""
    after_name = Path(f"/proc/{program.process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(after_name[11]) + int(after_name[12])) / _TICKS


def error(drive: Drive, T_map_odom: Sequence[float], scan: int) -> float:  # noqa: N803
    """[m] between where the base is said to be at a scan and where it is."""
    said: Array = compose(np.asarray(T_map_odom), drive.T_odom_base_at_scans[scan])
    return float(np.hypot(*between(drive.T_map_base[scan], said)[:2]))


def figures(told: list[Any]) -> dict[str, str]:
    """Of the newest diagnostics."""
    return {item.key: item.value for item in told[-1].status[0].values}


def ask(peer: Peer, service: str, kind: str = "Empty", **fields: Any) -> Any:
    """Calls what must succeed."""
    reply = peer.call(service, kind, **fields)
    assert reply.success, f"{service}: {reply.message}"
    return reply.response


def mapping(peer: Peer, folder: Path, drive: Drive, rate: float, resolution: float) -> Iterator[tuple[str, str]]:
    """The drive is mapped and saved."""
    seconds = float(drive.odometry_times[-1] - drive.odometry_times[0])
    cell: dict[str, Any] = {"output_map.probability_grid.resolution": resolution}
    with running(peer, folder, **cell) as program:
        grids = peer.hear("map", OccupancyGrid, latched=True)
        told, poses, player = peer.hear("/diagnostics", DiagnosticArray), Poses(peer), Player(peer, drive, rate)

        def call(name: str, args: Sequence[str]) -> Callable[[], object]:
            fields = dict(zip(("nspace", "id"), args, strict=False)) if args else {}
            return lambda: ask(peer, f"{SLAM}/{name}", _EVENTS[name], **fields)

        calls = [(event.t, call(event.call, event.args)) for event in drive.events if event.call in _EVENTS]
        middle = float(drive.odometry_times[0]) + 0.5 * seconds
        calls.append((middle, call("graph_loc/create", ("waypoint", "kitchen"))))
        ask(peer, f"{SLAM}/map/start", "SetString", data=str(folder / "home"))
        before, begun = cpu_seconds(program), time.monotonic()
        player.play(seconds, calls)
        used, lasted = cpu_seconds(program) - before, time.monotonic() - begun
        until(lambda: figures(told)["scans processed"] == str(len(player.sent)), "all scans are mapped", 30.0)
        said = figures(told)
        maps, grid = len(grids), grids[-1].info
        ask(peer, f"{SLAM}/map/stop")
        ask(peer, f"{SLAM}/save_map", "SetString", data=str(folder / "shown"))
        places = ask(peer, f"{SLAM}/graph_loc/list", "LocNamespace", nspace="", use_as_prefix=True)
        yield "scans sent, mapped, dropped", f"{len(player.sent)}, {said['scans processed']}, {said['scans dropped']}"
        yield "nodes, closures", f"{said['nodes']}, {said['closures']}"
        yield "calls during the drive", ", ".join(event.call for event in drive.events if event.call in _EVENTS)
        yield "places", ", ".join(f"{a}/{b}" for a, b in zip(places.nspaces, places.ids, strict=True))
        yield "CPU of the mapping node, % of a core", f"{100.0 * used / lasted:.1f}"
        for name, key in (("scan to map -> odom", "delay [ms]"), ("mapping a scan", "ms per scan")):
            spread = " / ".join(said[f"{key}, {which}"] for which in ("median", "99 %", "worst"))
            yield f"{name}, by the node, last 600 scans: P50 / P99 / worst, ms", spread
        yield "maps heard meanwhile, and cells of the last", f"{maps}, {grid.width} x {grid.height}"
        yield "base at the last scan, from the truth, m", f"{error(drive, poses.last(), len(player.sent) - 1):.3f}"
    peer.forget()


def again(peer: Peer, folder: Path, drive: Drive, rate: float) -> Iterator[tuple[str, str]]:
    """The robot is found on the map and goes on with it."""
    home = folder / "home"
    with (
        running(
            peer, folder, "oort.node.localizer", name=LOCALIZER[1:], map=folder / "home", start="global"
        ) as program,
        running(peer, folder, load=home),
    ):
        player, poses = Player(peer, drive, rate), Poses(peer)
        before, begun = cpu_seconds(program), time.monotonic()
        player.play(AGAIN)
        used, lasted = cpu_seconds(program) - before, time.monotonic() - begun
        located = ask(peer, f"{LOCALIZER}/is_localized", "GetBool").data
        yield "found by the localiser after a minute, without a guess", "yes" if located else "no"
        yield "base from the truth by the localiser, m", f"{error(drive, poses.last(), len(player.sent) - 1):.3f}"
        yield "CPU of the localiser, % of a core", f"{100.0 * used / lasted:.1f}"
        nodes = ask(peer, f"{SLAM}/map/num_nodes", "GetUInt").data
        ask(peer, f"{SLAM}/map/resume_here", "SetString", data=str(folder / "second"))
        player.play(AGAIN)
        ask(peer, f"{SLAM}/map/stop")
        more = ask(peer, f"{SLAM}/map/num_nodes", "GetUInt").data
        yield "nodes before going on and after", f"{nodes}, {more}"
    peer.forget()


def main(argv: Sequence[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10.0, help="of the drive (default: 10)")
    parser.add_argument("--rate", type=float, default=1.0, help="how many times as fast (default: 1)")
    parser.add_argument("--resolution", type=float, default=0.05, help="cell of the drawn map [m] (default: 0.05)")
    parser.add_argument("--seed", type=int, default=1, help="of the simulated home (default: 1)")
    args = parser.parse_args(argv)
    drive = simulate_drive(args.seed, SimulationConfig(minutes=args.minutes))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        peer = RclpyPeer(folder, 101 + os.getpid() % 100)
        try:
            load = os.getloadavg()[0]
            rows = [*mapping(peer, folder, drive, args.rate, args.resolution), *again(peer, folder, drive, args.rate)]
            print("| what | measured |\n|---|---|")  # after what the nodes have printed
            print("\n".join(f"| {what} | {measured} |" for what, measured in rows))
            print(f"\nload before and after: {load:.1f}, {os.getloadavg()[0]:.1f}")
        finally:
            peer.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
