# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Bags in which every third message of a topic is given: a whole container around hostile messages."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores

sys.path.insert(0, str(Path(__file__).parents[1] / "py"))

from helpers.recording_files import Bag, yaw_quaternion
from oort import Parameters
from oort.offline.info import recording_info
from oort.offline.replay import ReplayOptions, replay
from oort.recording import open_recording

_SCANS, _BEAMS = 30, 13


class _Changing:
    """A writer of a bag that writes ``data`` in the place of some messages; without data it keeps one."""

    def __init__(self, writer: Any, topic: str, data: bytes | None) -> None:
        self.kept = b""
        self._writer, self._topic, self._data = writer, topic, data
        self._number = 0

    def add_connection(self, topic: str, kind: str, **how: Any) -> tuple[str, Any]:
        return topic, self._writer.add_connection(topic, kind, **how)

    def write(self, connection: tuple[str, Any], stamp: int, raw: bytes) -> None:
        topic, inner = connection
        if topic == self._topic:
            self._number += 1
            if self._number % 3 == 1:
                self.kept = bytes(raw)
                raw = raw if self._data is None else self._data
        self._writer.write(inner, stamp, raw)


def _bag(topic: str) -> Bag:
    """A robot that turns in a round room."""
    bag = Bag().tf(0.0, "base", "laser", (0.1, 0.0, 0.2), topic="/tf_static")
    for k in range(_SCANS):
        time = 1.0 + 0.1 * k
        bag.tf(time, "odom", "base", (0.02 * k, 0.0, 0.0), yaw_quaternion(0.05 * k))
        if topic == "/imu":
            bag.imu(time, (0.0, 0.0, 0.5))
        if topic == "/echoes":
            bag.echoes(time, topic, [(2.0 + 0.1 * (beam % 7), 4.0) for beam in range(_BEAMS)])
        else:
            bag.scan(time, ranges=[2.0 + 0.1 * (beam % 7) for beam in range(_BEAMS)])
    return bag


def _write(topic: str, data: bytes | None, path: Path) -> bytes:
    """Writes a bag and returns one of the messages that data stands for."""
    if topic == "/echoes":
        with Writer2(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            changing = _Changing(writer, topic, data)
            _bag(topic)._write(changing, Stores.ROS2_HUMBLE)
    else:
        with Writer1(path) as writer:
            changing = _Changing(writer, topic, data)
            _bag(topic)._write(changing, Stores.ROS1_NOETIC)
    return changing.kept


def seed(topic: str, folder: Path) -> bytes:
    """A message as it should be."""
    return _write(topic, None, folder / "seed.bag")


def reader(topic: str) -> Callable[[Path], None]:
    """Reads and maps a bag with the message that a file holds, and says what it is."""

    def read(path: Path) -> None:
        bag = path.with_name(f"{path.name}.{'d' if topic == '/echoes' else 'bag'}")
        parameters = Parameters()
        parameters.set("use_imu", topic == "/imu")
        parameters.set("motion_compensation", True)
        try:
            _write(topic, path.read_bytes(), bag)
            recording = open_recording(bag, parameters=parameters)
            replay(recording, parameters, ReplayOptions(quiet=True))
            recording_info(recording)
        finally:
            _remove(bag)

    return read


def _remove(bag: Path) -> None:
    if bag.is_dir():
        for file in bag.iterdir():
            file.unlink()
        bag.rmdir()
    else:
        bag.unlink(missing_ok=True)
