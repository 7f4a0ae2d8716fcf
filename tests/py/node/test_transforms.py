# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the node makes of tf: odometry at a scan's stamp, the laser's place on the base, and what is missing."""

import math
import time

import pytest

pytest.importorskip("rospy")
import rospy
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from sensor_msgs.msg import Imu

from node.client import this_process
from oort import Parameters
from oort.live import UnusableScanError
from oort.node.messages import transform
from oort.node.transforms import Mount, Transforms
from oort.recording import Pose
from oort.recording.motion import SNAPSHOT

LASER = "hokuyo_laser_link"


@pytest.fixture
def told() -> list[None]:
    """One entry for each time that odometry was said to have come."""
    return []


@pytest.fixture
def transforms(told: list[None]) -> Transforms:
    return Transforms(Parameters(), lambda: told.append(None), this_process())


def odometry(stamp: float, pose: Pose, parent: str = "odom", child: str = "base_footprint") -> TransformStamped:
    return transform(parent, child, rospy.Time.from_sec(stamp), pose)


def laser(roll: float = 0.0, pitch: float = 0.0) -> TransformStamped:
    sr, cr, sp, cp = math.sin(roll / 2), math.cos(roll / 2), math.sin(pitch / 2), math.cos(pitch / 2)
    message = transform("base_footprint", LASER, rospy.Time(), (0.0, 0.0, 0.0))
    message.transform.translation = Vector3(0.109, 0.0, 0.175)
    message.transform.rotation = Quaternion(sr * cp, cr * sp, -sr * sp, cr * cp)
    return message


def lookup(transforms: Transforms, stamp: float) -> Pose | None:
    placement = transforms.place(stamp, time.monotonic(), SNAPSHOT)
    return None if placement is None else placement.odometry


# ---- the laser ----


def test_the_lasers_place(transforms: Transforms) -> None:
    assert transforms.mount(LASER) is None
    transforms.set_transform_static(laser(), "robot")
    assert transforms.mount(LASER) == Mount((0.109, 0.0, 0.0), upside_down=False)
    assert transforms.mount("base_footprint") == Mount((0.0, 0.0, 0.0), upside_down=False)


def test_a_laser_that_hangs_upside_down(transforms: Transforms) -> None:
    transforms.set_transform_static(laser(roll=math.pi), "robot")
    mount = transforms.mount(LASER)
    assert mount is not None
    assert mount.upside_down
    assert mount.sensor_on_base == pytest.approx((0.109, 0.0, 0.0))


def test_a_laser_that_is_not_level(transforms: Transforms) -> None:
    transforms.set_transform_static(laser(pitch=0.5), "robot")
    with pytest.raises(UnusableScanError, match=LASER):
        transforms.mount(LASER)


def test_a_laser_by_a_moving_link(transforms: Transforms, told: list[None]) -> None:
    """A robot_state_publisher of old times says on /tf what holds for ever."""
    transforms.set_transform(laser(), "robot")
    assert transforms.mount(LASER) == Mount((0.109, 0.0, 0.0), upside_down=False)
    assert not told


def test_a_laser_that_moves_is_told_once(transforms: Transforms, monkeypatch: pytest.MonkeyPatch) -> None:
    warnings: list[str] = []
    monkeypatch.setattr("oort.node.transforms.log.warning", lambda text, *args: warnings.append(text % args))
    transforms.set_transform(laser(), "robot")
    mount = transforms.mount(LASER)
    for x in (0.11, 0.2, 0.3):
        transforms.set_transform(odometry(1.0, (x, 0.0, 0.0), "base_footprint", LASER), "robot")
    assert transforms.mount(LASER) == mount
    assert len(warnings) == 1, "not for a millimetre, and not again"
    assert f"base_footprint -> {LASER} between the robot's base and its sensor varies by 0.09 m" in warnings[0]


# ---- odometry ----


def test_odometry_between_two_messages(transforms: Transforms, told: list[None]) -> None:
    assert lookup(transforms, 100.5) is None
    transforms.set_transform(odometry(100.0, (1.0, 0.0, 0.0)), "robot")
    assert lookup(transforms, 100.5) is None
    transforms.set_transform(odometry(101.0, (2.0, 1.0, 0.4)), "robot")
    assert lookup(transforms, 100.5) == pytest.approx((1.5, 0.5, 0.2))
    assert len(told) == 2


def test_odometry_by_way_of_another_frame(transforms: Transforms) -> None:
    transforms.set_transform_static(odometry(0.0, (0.1, 0.0, 0.0), "base_link", "base_footprint"), "robot")
    transforms.set_transform(odometry(100.0, (1.0, 0.0, math.pi / 2), child="base_link"), "robot")
    assert lookup(transforms, 100.0) == pytest.approx((1.0, 0.1, math.pi / 2))


def imu(stamp: float, rate: tuple[float, float, float], frame: str = "imu") -> Imu:
    message = Imu()
    message.header.stamp, message.header.frame_id = rospy.Time.from_sec(stamp), frame
    message.angular_velocity = Vector3(*rate)
    return message


def test_a_gyro(told: list[None]) -> None:
    """An IMU that hangs upside down on a robot that stands for two seconds and then turns, untold by its wheels."""
    parameters = Parameters()
    parameters.set("use_imu", True)
    transforms = Transforms(parameters, lambda: told.append(None), this_process())
    assert not transforms.imu_trouble()
    transforms.add_imu(imu(99.0, (0.0, 0.0, 1.0)))  # before tf tells how it sits
    transforms.set_transform_static(laser(), "robot")
    upside_down = transform("base_footprint", "imu", rospy.Time(), (0.0, 0.0, 0.0))
    upside_down.transform.rotation = Quaternion(1.0, 0.0, 0.0, 0.0)
    transforms.set_transform_static(upside_down, "robot")
    assert transforms.mount(LASER) is not None
    for step in range(200):
        transforms.set_transform(odometry(100.0 + 0.02 * step, (1.0, 0.0, 0.0)), "robot")
        if step == 0:
            assert transforms.imu_trouble().startswith("no yaw rate on /imu; start the IMU, remap imu")
        transforms.add_imu(imu(100.0 + 0.02 * step, (0.5, 0.5, -1.0 if step > 100 else 0.0)))
        transforms.add_imu(imu(100.0 + 0.02 * step, (math.nan, 0.0, 0.0)))
    assert not transforms.imu_trouble()
    placement = transforms.place(103.0, time.monotonic(), SNAPSHOT)
    assert placement is not None
    assert placement.odometry == pytest.approx((1.0, 0.0, 1.0), abs=0.02)
    assert placement.reported_frame is not None


def test_an_imu_that_moves_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    warnings: list[str] = []
    monkeypatch.setattr("oort.node.transforms.log.warning", lambda text, *args: warnings.append(text % args))
    parameters = Parameters()
    parameters.set("use_imu", True)
    transforms = Transforms(parameters, lambda: None, this_process())
    for turned in (0.0, 0.001, 0.5, 1.0):
        transforms.set_transform(odometry(1.0, (0.0, 0.0, turned), "base_footprint", "imu"), "robot")
        transforms.add_imu(imu(100.0 + turned, (0.0, 0.0, 1.0)))
    assert len(warnings) == 1
    assert "base_footprint -> imu" in warnings[0]


def test_a_gyro_whose_transform_comes_late(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is taken to sit level only after a while, and only until tf tells that it hangs upside down."""
    parameters = Parameters()
    parameters.set("use_imu", True)
    transforms = Transforms(parameters, lambda: None, this_process())
    rates: list[float] = []
    monkeypatch.setattr("oort.live.odometry.Odometry.add_gyro", lambda _self, _stamp, rate: rates.append(rate))
    now = [time.monotonic()]
    monkeypatch.setattr("oort.node.transforms.time.monotonic", lambda: now[0])
    transforms.set_transform_static(laser(), "robot")
    assert transforms.mount(LASER) is not None
    transforms.set_transform(odometry(100.0, (1.0, 0.0, 0.0)), "robot")
    transforms.add_imu(imu(100.0, (0.0, 0.0, 1.0)))
    now[0] += 4.0
    transforms.add_imu(imu(104.0, (0.0, 0.0, 1.0)))
    assert not rates, "tf may still tell"
    now[0] += 2.0
    transforms.add_imu(imu(106.0, (0.0, 0.0, 1.0)))
    upside_down = transform("base_footprint", "imu", rospy.Time(), (0.0, 0.0, 0.0))
    upside_down.transform.rotation = Quaternion(1.0, 0.0, 0.0, 0.0)
    transforms.set_transform_static(upside_down, "robot")
    transforms.add_imu(imu(107.0, (0.0, 0.0, 1.0)))
    assert rates == [1.0, -1.0]


def test_a_scan_that_takes_time_by_way_of_another_frame(transforms: Transforms) -> None:
    fixed = odometry(0.0, (0.5, 0.0, 0.0), "base_link", "base_footprint")
    transforms.set_transform_static(fixed, "robot")
    transforms.set_transform(odometry(100.0, (1.0, 0.0, 0.0), child="base_link"), "robot")
    transforms.set_transform(odometry(101.0, (1.0, 0.0, math.pi / 2), child="base_link"), "robot")
    placement = transforms.place(100.0, time.monotonic(), (0.0, 1.0))
    assert placement is not None
    assert placement.odometry == pytest.approx((1.5, 0.0, 0.0))
    assert placement.sweep is not None
    assert placement.sweep[1] == pytest.approx((-0.5, 0.5, math.pi / 2))
    assert transforms.place(100.5, time.monotonic(), (0.0, 1.0)) is None


def test_odometry_with_slashes(transforms: Transforms) -> None:
    transforms.set_transform(odometry(100.0, (1.0, 2.0, 0.3), "/odom", "/base_footprint"), "robot")
    assert lookup(transforms, 100.0) == pytest.approx((1.0, 2.0, 0.3))


def test_odometry_that_will_not_come(transforms: Transforms) -> None:
    arrived = time.monotonic()
    for step in range(30):
        transforms.set_transform(odometry(100.0 + step, (0.1 * step, 0.0, 0.0)), "robot")
    for stamp in (99.9, 105.0):  # 20 s are kept
        with pytest.raises(UnusableScanError, match="older than the odometry"):
            transforms.place(stamp, arrived, SNAPSHOT)
    assert lookup(transforms, 110.0) == pytest.approx((1.0, 0.0, 0.0))
    assert lookup(transforms, 99.9) is None, "it came later than the odometry: the clock may have been set back"


def test_a_clock_that_is_set_back(transforms: Transforms) -> None:
    transforms.set_transform(odometry(100.0, (1.0, 0.0, 0.0)), "robot")
    arrived = time.monotonic()
    transforms.set_transform(odometry(50.0, (0.0, 0.0, 0.0)), "robot")
    transforms.set_transform(odometry(51.0, (1.0, 0.0, 0.0)), "robot")
    assert lookup(transforms, 50.5) == pytest.approx((0.5, 0.0, 0.0))
    with pytest.raises(UnusableScanError, match="before the clock was set back"):
        transforms.place(100.1, arrived, SNAPSHOT)


def test_what_is_no_pose_is_left_out(transforms: Transforms, told: list[None]) -> None:
    broken = odometry(100.0, (math.nan, 0.0, 0.0))
    transforms.set_transform(broken, "robot")
    unturned = odometry(100.0, (0.0, 0.0, 0.0))
    unturned.transform.rotation = Quaternion(0.0, 0.0, 0.0, 0.0)
    transforms.set_transform(unturned, "robot")
    assert not told
    assert lookup(transforms, 100.0) is None


# ---- what is missing ----


def test_missing(transforms: Transforms) -> None:
    assert transforms.missing(LASER).startswith(f"no base_footprint -> {LASER} (tf has ")
    transforms.set_transform_static(laser(), "robot")
    assert transforms.missing(LASER) == f"no odom -> base_footprint (tf has base_footprint -> {LASER})"
    transforms.set_transform(odometry(100.0, (0.0, 0.0, 0.0)), "robot")
    assert transforms.missing(LASER) == "no odom -> base_footprint since 0.0 s"


def test_odometry_that_is_static(transforms: Transforms) -> None:
    transforms.set_transform_static(laser(), "robot")
    transforms.set_transform_static(odometry(0.0, (0.0, 0.0, 0.0)), "robot")
    assert lookup(transforms, 1.0) is None
    assert transforms.missing(LASER) == "odom -> base_footprint is static: no odometry"


def test_scans_ahead_of_odometry(transforms: Transforms) -> None:
    transforms.set_transform_static(laser(), "robot")
    transforms.set_transform(odometry(100.0, (0.0, 0.0, 0.0)), "robot")
    assert lookup(transforms, 160.0) is None
    assert transforms.missing(LASER) == "check the clocks: scans are stamped 60.0 s ahead of odometry"


# ---- a localiser ----


@pytest.mark.usefixtures("rospy")
class TestLocaliser:
    def test_of_now(self, transforms: Transforms) -> None:
        assert transforms.sensor_on_map(LASER) is None
        self.say(transforms, rospy.get_time(), "amcl")
        assert transforms.sensor_on_map(LASER) == pytest.approx((3.109, 0.0, 0.0))

    def test_of_long_ago(self, transforms: Transforms) -> None:
        self.say(transforms, rospy.get_time() - 2.0, "amcl")
        assert transforms.sensor_on_map(LASER) is None

    def test_oort_itself_is_none(self, transforms: Transforms) -> None:
        self.say(transforms, rospy.get_time(), rospy.get_name())
        assert transforms.sensor_on_map(LASER) is None

    @staticmethod
    def say(transforms: Transforms, stamp: float, who: str) -> None:
        transforms.set_transform_static(laser(), "robot")
        transforms.set_transform(odometry(stamp, (1.0, 0.0, 0.0)), "robot")
        transforms.set_transform(odometry(stamp, (2.0, 0.0, 0.0), "map", "odom"), who)

    def test_that_fell_silent_while_the_clock_stands(
        self, transforms: Transforms, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        self.say(transforms, rospy.get_time(), "amcl")
        now = time.monotonic() + 3.0
        monkeypatch.setattr("oort.node.transforms.time.monotonic", lambda: now)
        assert transforms.sensor_on_map(LASER) is None

    def test_that_holds_for_ever(self, transforms: Transforms, monkeypatch: pytest.MonkeyPatch) -> None:
        transforms.set_transform_static(odometry(0.0, (2.0, 0.0, 0.0), "map", "odom"), "a fixed start")
        transforms.set_transform_static(laser(), "robot")
        transforms.set_transform(odometry(rospy.get_time(), (1.0, 0.0, 0.0)), "robot")
        now = time.monotonic() + 3.0
        monkeypatch.setattr("oort.node.transforms.time.monotonic", lambda: now)
        assert transforms.sensor_on_map(LASER) == pytest.approx((3.109, 0.0, 0.0))
