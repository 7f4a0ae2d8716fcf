# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the ROS node costs in real time: CPU, the delay from a scan to its map -> odom, and serialising the map.

Plays a simulated home at the speed of life, or ``--rate`` times as fast, to a node in a roscore of its own, and prints
a Markdown table. It goes by the wall's clock, as on a robot: /clock comes in steps of 10 ms, which would be measured
instead of the node.
"""

import argparse
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests/py"))

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Int64
from tf2_msgs.msg import TFMessage

from accuracy import describe
from node.client import Client, Heard, figures, until
from node.running import Core, Node, start_core
from oort.node.middleware.rospy_messages import FastGrid
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag

_TICKS = os.sysconf("SC_CLK_TCK")  # [1/s]
_IDLE = 10.0  # [s] of watching the node before it maps
_AHEAD = (
    0.02  # [s] by which this process, with a thread for each topic, may hear of the pose before it does of its scan
)
_LARGE = 1000  # cells a side


class Watch:
    """Listens to scans and to map -> odom, each with the time of its arrival in this process [s]."""

    def __init__(self) -> None:
        self.scans: list[float] = []
        self.poses: list[tuple[float, tuple[float, ...]]] = []
        """arrival and what was said"""
        self._subscribers = [
            rospy.Subscriber("scan", LaserScan, self._on_scan, tcp_nodelay=True),
            rospy.Subscriber("/tf", TFMessage, self._on_tf, tcp_nodelay=True),
        ]

    def _on_scan(self, _: LaserScan) -> None:
        self.scans.append(time.monotonic())

    def _on_tf(self, message: TFMessage) -> None:
        now = time.monotonic()
        for one in message.transforms:
            if one.header.frame_id == "map":
                t, r = one.transform.translation, one.transform.rotation
                self.poses.append((now, (t.x, t.y, r.z, r.w)))

    def delays(self) -> list[float]:
        """[ms] from each scan until another map -> odom came than before; a scan that changes nothing has none.

        A delay of almost a scan's period would count for the next scan: the node's own figures would show it.
        """
        delays = []
        news = [at for (_, before), (at, now) in pairwise(self.poses) if now != before]
        for came, following in pairwise([*self.scans, float("inf")]):
            index = int(np.searchsorted(news, came - _AHEAD))
            if index < len(news) and news[index] < following - _AHEAD:
                delays.append(1e3 * (news[index] - came))
        return delays


def cpu_seconds(pid: int) -> float:
    """That a process has used, in all of its threads."""
    after_name = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(after_name[11]) + int(after_name[12])) / _TICKS


def memory_mb(pid: int) -> float:
    """The most that a process has had in memory."""
    line = next(line for line in Path(f"/proc/{pid}/status").read_text().splitlines() if line.startswith("VmHWM:"))
    return int(line.split()[1]) / 1024.0


def cpu_each_second(pid: int, goes_on: Callable[[], bool]) -> list[float]:
    """[%] of a core, second by second, for as long as something goes on."""
    shares = []
    used, since = cpu_seconds(pid), time.monotonic()
    while goes_on():
        time.sleep(1.0)
        now_used, now = cpu_seconds(pid), time.monotonic()
        shares.append(100.0 * (now_used - used) / (now - since))
        used, since = now_used, now
    return shares


def milliseconds(work: Callable[[], object], times: int = 15) -> float:
    """The median duration of some work."""
    durations = []
    for _ in range(times):
        started = time.perf_counter()
        work()
        durations.append(1e3 * (time.perf_counter() - started))
    return statistics.median(durations)


def serialisation(name: str, width: int, height: int, cells: Sequence[int]) -> Iterator[tuple[str, str]]:
    """What it takes to write a grid of these cells, by Oort's message and by the generated one, from a list at best."""
    fast, generated = FastGrid(), OccupancyGrid()
    for message in (fast, generated):
        message.info.width, message.info.height = width, height
    fast.data, generated.data = np.array(cells, dtype=np.int8), list(cells)
    ours = milliseconds(lambda: fast.serialize(BytesIO()))
    theirs = milliseconds(lambda: generated.serialize(BytesIO()), 3)
    yield f"serialising {name}, {width} x {height} cells (the generated message)", f"{ours:.3f} ms ({theirs:.1f} ms)"


def spread(samples: Sequence[float]) -> str:
    """P50 / P99 / worst."""
    p50, p99 = np.quantile(samples, [0.5, 0.99], method="inverted_cdf").tolist()
    return f"{p50:.1f} / {p99:.1f} / {max(samples):.1f}"


def run(core: Core, folder: Path, seed: int, seconds: float, rate: float) -> Iterator[tuple[str, str]]:
    """Plays a drive to the node; what was measured, as names and values."""
    write_bag(simulate_drive(seed, SimulationConfig(minutes=seconds / 60.0)), folder / "home.bag")
    node = Node(core, "oort_slam", [sys.executable, "-m", "oort.node"], folder / "node.log", folder)
    pid = node.process.pid
    rospy.init_node("bench", disable_signals=True)
    try:
        node.wait_for_service("map/stop")
        client, watch = Client(node), Watch()
        with (
            Heard("/map", OccupancyGrid) as maps,
            Heard("/diagnostics", DiagnosticArray) as told,
            Heard("/oort_slam/queue_size", Int64) as queue,
        ):
            before = time.monotonic()
            idle = cpu_each_second(pid, lambda: time.monotonic() < before + _IDLE)
            client.call("map/start", str(folder / "map"))
            command = ["rosbag", "play", "--queue=10000", "--wait-for-subscribers"]
            command += [f"--duration={seconds}", f"--rate={rate}"]
            command += ["--topics", "/scan", "/tf", "/tf_static", "--bags", str(folder / "home.bag")]
            player = Node(core, "player", command, folder / "play.log", folder)
            try:
                until(lambda: watch.scans, "the bag is being played", 30.0)
                mapping = cpu_each_second(pid, lambda: player.process.poll() is None)
            finally:
                player.stop()
            said = figures(told.messages[-1])
            yield from _results(watch, said, idle, mapping)
            sizes = [message.data for message in queue.messages]
            yield "queue, most", str(max(sizes))
            yield "memory, most", f"{memory_mb(pid):.0f} MB"
            yield "maps published", str(len(maps.messages))
            newest = maps.messages[-1]
            yield from serialisation("the map", newest.info.width, newest.info.height, newest.data)
            yield from serialisation("a large one", _LARGE, _LARGE, [-1] * _LARGE**2)
    finally:
        node.stop()
        rospy.signal_shutdown("the measurement is over")


def _results(watch: Watch, said: dict[str, str], idle: list[float], mapping: list[float]) -> Iterator[tuple[str, str]]:
    delays = watch.delays()
    yield "scans", f"{said['scans received']} at {said['scan rate [Hz]']} Hz, {said['scans dropped']} dropped"
    yield "nodes, closures", f"{said['nodes']}, {said['closures']}"
    yield "CPU of the node while mapping, % of a core", f"{statistics.mean(mapping):.1f}, most {max(mapping):.0f}"
    yield "CPU before map/start, no scans, % of a core", f"{statistics.mean(idle):.1f}"
    yield f"delay scan to map -> odom, by a client, {len(delays)} scans: P50 / P99 / worst, ms", spread(delays)
    for name, key in (
        ("delay by the node itself, last 600 scans: P50 / P99 / worst, ms", "delay [ms]"),
        ("of that mapping the scan: P50 / P99 / worst, ms", "ms per scan"),
    ):
        yield name, " / ".join(said[f"{key}, {which}"] for which in ("median", "99 %", "worst"))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1, help="of the simulated home (default: 1)")
    parser.add_argument("--seconds", type=float, default=150.0, help="how long to map (default: 150)")
    parser.add_argument("--rate", type=float, default=1.0, help="how many times as fast (default: 1)")
    args = parser.parse_args(argv)
    what: dict[str, Any] = describe(None)
    with tempfile.TemporaryDirectory() as name, start_core(Path(name)) as core:
        os.environ.pop("ROS_HOSTNAME", None)  # it would win over ROS_IP
        os.environ.update(core.variables)
        load = os.getloadavg()
        rows = list(run(core, Path(name), args.seed, args.seconds, args.rate))
    print(
        f"Home {args.seed} for {args.seconds:.0f} s at {args.rate:g}x; commit {what['commit']}, {what['parameters']}."
    )
    print(f"{what['machine']}; load before and after: {load[0]:.1f}, {os.getloadavg()[0]:.1f}.\n")
    print("| what | measured |\n|---|---|")
    for row in rows:
        print(f"| {row[0]} | {row[1]} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
