# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that no robot should send, in the middle of a drive: what comes after is mapped as if they had not been.

The node's own chain without a network: transforms and scans as messages, a live session. What is left out is counted
and told.
"""

import math
import time
from collections.abc import Callable
from typing import Any

import pytest

pytest.importorskip("rospy")
import rospy
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from sensor_msgs.msg import LaserScan

from helpers.live_rig import Recorder, until
from helpers.scenes import room_scan
from node.client import this_process
from oort import Parameters, render_map
from oort.live import LiveSession
from oort.node.laser import Laser
from oort.node.messages import transform
from oort.node.transforms import Transforms
from oort.recording import Pose

HALF, HOSTILE = 50, 10  # scans before and after, and between
BASE, LASER, ODOM = "base_footprint", "hokuyo_laser_link", "odom"
YEAR = 3.2e7  # [s]
NAN, INF = math.nan, math.inf


class Robot:
    """Sends what a robot sends."""

    def __init__(self) -> None:
        self.told = Recorder()
        parameters = Parameters()
        self.live = LiveSession(parameters, self.told, draws=False)
        self.transforms = Transforms(parameters, self.live.inbox.poke, this_process())
        self.laser = Laser(self.transforms, True, lambda frame, mount: self.live.mount_sensor(mount))
        self.live.call("map/start", [""])
        self.k = 0
        self.transforms.set_transform_static(transform(BASE, LASER, rospy.Time(), (0.0, 0.0, 0.0)), "robot")

    @property
    def now(self) -> float:
        return 1e9 + 0.1 * self.k

    @property
    def pose(self) -> Pose:
        return 0.01 * self.k, 0.0, 0.02 * self.k

    def odometry(self, parent: str = ODOM, child: str = BASE, stamp: float | None = None) -> TransformStamped:
        return transform(parent, child, rospy.Time.from_sec(self.now if stamp is None else stamp), self.pose)

    def scan(self, **fields: Any) -> LaserScan:
        seen = room_scan(*self.pose, self.now)
        message = LaserScan(
            angle_min=seen.angle_min,
            angle_max=seen.angle_min + seen.angle_increment * (len(seen.ranges) - 1),
            angle_increment=seen.angle_increment,
            range_min=seen.range_min,
            range_max=seen.range_max,
            ranges=seen.ranges.tolist(),
        )
        message.header.stamp = rospy.Time.from_sec(fields.pop("stamp", self.now))
        message.header.frame_id = fields.pop("frame", LASER)
        for name, value in fields.items():
            setattr(message, name, value)
        return message

    def send(self, message: TransformStamped | LaserScan) -> None:
        if isinstance(message, TransformStamped):
            self.transforms.set_transform(message, "robot")
        else:
            frame = message.header.frame_id.lstrip("/")
            self.live.add_scan(*self.laser.resolve_later(message, frame, time.monotonic()))

    def drive(self, scans: int, hostile: Callable[["Robot"], None] = lambda robot: None) -> None:
        for _ in range(scans):
            self.send(self.odometry())
            hostile(self)
            self.send(self.scan())
            self.k += 1


Hostile = Callable[[Robot], None]


def tf(**changes: Any) -> Hostile:
    """A transform beside the right one: its frames, stamp, translation or rotation are changed."""

    def send(robot: Robot) -> None:
        message = robot.odometry(changes.get("parent", ODOM), changes.get("child", BASE), changes.get("stamp"))
        message.transform.translation = changes.get("translation", message.transform.translation)
        message.transform.rotation = changes.get("rotation", message.transform.rotation)
        robot.send(message)

    return send


def scan(**fields: Any) -> Hostile:
    return lambda robot: robot.send(robot.scan(**fields))


def elsewhere(robot: Robot) -> None:
    """Another program that tells odometry, which says that the base is a metre off."""
    message = robot.odometry(stamp=robot.now - 0.05)
    message.transform.translation.x += 1.0
    robot.send(message)


MESSAGES: dict[str, Hostile] = {
    "rotation of zeros": tf(rotation=Quaternion(0.0, 0.0, 0.0, 0.0)),
    "rotation nan": tf(rotation=Quaternion(NAN, 0.0, 0.0, 1.0)),
    "rotation denormal": tf(rotation=Quaternion(0.0, 0.0, 5e-324, 1e-310)),
    "rotation 1e300": tf(rotation=Quaternion(0.0, 0.0, 1e300, 1e300)),
    "translation nan": tf(translation=Vector3(NAN, 0.0, 0.0)),
    "translation inf": tf(translation=Vector3(INF, -INF, 0.0)),
    "translation 1e300": tf(translation=Vector3(1e300, 0.0, 0.0)),
    "translation denormal": tf(parent="x", child="y", translation=Vector3(5e-324, 1e-310, 0.0)),
    "odometry's stamp 0": tf(stamp=0.0),
    "odometry's stamp years ago": tf(stamp=1e9 - YEAR),
    "odometry's stamp years ahead": tf(stamp=1e9 + YEAR),
    "odometry's stamp the last there is": tf(stamp=2.0**32 - 1),
    "odometry repeated": tf(),
    "a loop above odometry": tf(parent=LASER, child=ODOM),
    "a loop of two": tf(parent=BASE, child=ODOM),
    "a frame on itself": tf(parent=BASE, child=BASE),
    "no names of frames": tf(parent="", child=""),
    "a second parent of the base": tf(parent="elsewhere", child=BASE),
    "a second parent of the laser": tf(parent="elsewhere", child=LASER),
    "names of any kind": tf(parent="/" * 50, child="\0\n" + "x" * 10_000),
    "two programs tell odometry": elsewhere,
    "each scan twice": scan(),
    "a laser without a transform": scan(frame="nowhere"),
    "a scan's stamp 0": scan(stamp=0.0),
    "a scan's stamp the last there is": scan(stamp=2.0**32 - 1),
    "no beams": scan(ranges=[]),
    "a scan of nan": scan(ranges=[NAN] * 180, range_max=NAN),
    "beams of all counts": lambda robot: robot.send(robot.scan(ranges=[2.0] * (1 + 7 * (robot.k % 40)))),
    "increment 0": scan(angle_increment=0.0),
    "increment nan": scan(angle_increment=NAN, angle_min=NAN),
    "beams that take years": scan(time_increment=YEAR),
    "beams that take nan": scan(time_increment=NAN, scan_time=NAN),
    "limits crossed": scan(range_min=9.0, range_max=-9.0),
}


@pytest.mark.parametrize("name", MESSAGES)
def test_what_comes_after_is_mapped(name: str) -> None:
    robot = Robot()
    robot.drive(HALF)
    robot.drive(HOSTILE, MESSAGES[name])
    robot.drive(HALF)
    robot.send(robot.odometry())
    live = robot.live
    until(lambda: len(live.inbox) == 0 or live.inbox.waiting()[0] == len(live.inbox))
    live.call("map/stop")  # what waits for ever is left out
    map_, figures, result = live.run(lambda session: session.map), live.figures, live.figures.last_result
    live.close()
    robot.k -= 1
    assert result is not None
    assert result.T_map_base == pytest.approx(robot.pose, abs=0.1), robot.told.troubles
    left_out = sum(figures.drops.counts.values())
    assert figures.scans_arrived == figures.scans_mapped + left_out, dict(figures.drops.counts)
    assert figures.scans_mapped >= 2 * HALF
    assert left_out == 0 or robot.told.troubles, "scans were left out in silence"
    grid, _ = render_map(map_, Parameters())
    assert grid.width * grid.height < 200 * 200


def test_a_laser_that_nobody_places_holds_up_no_other_for_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("oort.node.laser._MOUNT_PATIENCE", 0.0)
    robot = Robot()
    robot.drive(HALF)
    started = time.monotonic()
    robot.drive(HALF, scan(frame="nowhere"))
    until(lambda: len(robot.live.inbox) == 0)
    assert time.monotonic() < started + 1.5
    assert robot.live.figures.drops.counts == {"no transform from the base to their frame nowhere": HALF}
    robot.live.close()
