# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Plays bags with `rosbag play`, which can be told to halt at marks, so that calls are made between known scans."""

import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import rosbag
import rospy
from std_msgs.msg import String
from std_srvs.srv import SetBool

from node.running import Core, Node
from oort.simulate import Drive

_MARK, _HALT = "/mark", "/halt"
_PLAYER = "player"


def cut(drive: Drive, scans: slice) -> Drive:
    """A part of a drive."""
    stamps = drive.scan_stamps[scans]
    poses = slice(*np.searchsorted(drive.odometry_stamps, (stamps[0], stamps[-1] + 1)))
    return replace(
        drive,
        scan_stamps=stamps,
        ranges=drive.ranges[scans],
        odometry_stamps=drive.odometry_stamps[poses],
        T_odom_base=drive.T_odom_base[poses],
        T_odom_base_at_scans=drive.T_odom_base_at_scans[scans],
        T_map_base=drive.T_map_base[scans],
        T_map_base_at_odometry=drive.T_map_base_at_odometry[poses],
        gyro=drive.gyro[poses],
        legs=drive.legs[scans],
    )


def write_marks(path: Path, times: Sequence[float]) -> Path:
    """A bag that halts the playing of another at each of these times [s]."""
    with rosbag.Bag(str(path), "w") as bag:
        for number, time in enumerate(times):
            bag.write(_MARK, String(str(number)), rospy.Time.from_sec(time - 0.001))
            bag.write(_HALT, String(), rospy.Time.from_sec(time))  # the player halts before it publishes this
    return path


class Player:
    """A running `rosbag play --clock`."""

    def __init__(self, process: Node) -> None:
        self._process = process
        self.marks: list[str] = []
        """that were reached"""

    def wait_for_mark(self, number: int) -> None:
        """Waits until playing halts at a mark; what comes before it is on its way."""
        self._process.wait_until(lambda: self.marks[-1:] == [str(number)], f"mark {number} was not reached", 120.0)

    def go_on(self) -> None:
        """After a mark."""
        pause = rospy.ServiceProxy(f"/{_PLAYER}/pause_playback", SetBool)
        self._process.wait_until(lambda: pause(False).success, "the player does not halt")

    def wait(self, timeout: float = 120.0) -> None:
        """Waits for the end of the bag."""
        assert self._process.process.wait(timeout) == 0, self._process.output


@contextmanager
def play(ros: Core, folder: Path, *bags: Path, rate: float = 20.0, imu: bool = False) -> Iterator[Player]:
    """Plays scans, transforms and maybe an IMU, and marks if they are among the bags; `folder` takes what it prints.

    Begins when somebody listens to each of these topics, so that nothing is lost.
    """
    marked = [_MARK, _HALT] if len(bags) > 1 else []
    command = ["rosbag", "play", f"__name:={_PLAYER}", "--clock", "-r", str(rate), "--queue=10000"]
    command += ["--wait-for-subscribers", *(["--pause-topics", _HALT] if marked else [])]
    command += [
        "--topics",
        "/scan",
        "/tf",
        "/tf_static",
        *(["/imu"] if imu else []),
        *marked,
        "--bags",
        *map(str, bags),
    ]
    process = Node(ros, _PLAYER, command, folder / f"play.{len(list(folder.glob('play.*')))}.log", folder)
    player = Player(process)
    subscribers = [
        rospy.Subscriber(_MARK, String, lambda message: player.marks.append(message.data)),
        rospy.Subscriber(_HALT, String),
    ]
    try:
        yield player
    finally:
        for subscriber in subscribers:
            subscriber.unregister()
        process.stop(signal.SIGINT)
