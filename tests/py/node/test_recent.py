# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where a frame is now in another: what tf2 says, for any tree of moving and fixed transforms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rospy")
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

from oort.node.recent import RecentTransforms, Sample

SECOND = 1_000_000_000
coordinates = st.floats(-10.0, 10.0)
angles = st.floats(-math.pi, math.pi)


def turned(yaw: float, roll: float) -> tuple[float, float, float, float]:
    sy, cy, sr, cr = math.sin(yaw / 2), math.cos(yaw / 2), math.sin(roll / 2), math.cos(roll / 2)
    return cy * sr, sy * sr, sy * cr, cy * cr


samples = st.builds(
    lambda ms, x, y, yaw, roll: (SECOND * 100 + ms * 1_000_000, (x, y, 0.1), turned(yaw, roll)),
    st.integers(0, 900),
    coordinates,
    coordinates,
    angles,
    st.sampled_from([0.0, math.pi, 0.3]),
)


def tell(buffer: tf2_ros.BufferCore, parent: str, child: str, sample: Sample, fixed: bool) -> None:
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp = rospy.Time(*divmod(sample[0], SECOND))
    t, r = message.transform.translation, message.transform.rotation
    (t.x, t.y, t.z), (r.x, r.y, r.z, r.w) = sample[1:]
    (buffer.set_transform_static if fixed else buffer.set_transform)(message, "somebody")


@given(
    localiser=st.lists(samples, min_size=1, max_size=5, unique_by=lambda sample: sample[0]),
    odometry=st.lists(samples, min_size=1, max_size=5, unique_by=lambda sample: sample[0]),
    mount=samples,
)
def test_as_tf2_says(localiser: list[Sample], odometry: list[Sample], mount: Sample) -> None:
    recent, buffer = RecentTransforms(), tf2_ros.BufferCore(rospy.Duration(10.0))
    told = [("map", "odom", one, False) for one in localiser] + [("odom", "base", one, False) for one in odometry]
    for parent, child, sample, fixed in [*told, ("base", "laser", mount, True)]:
        recent.add(parent, child, sample, fixed)
        tell(buffer, parent, child, sample, fixed)
    for target, source in (("map", "laser"), ("laser", "odom"), ("base", "laser")):
        found = recent.latest(target, source)
        try:
            expected = buffer.lookup_transform_core(target, source, rospy.Time(0))
        except tf2_ros.TransformException:
            assert found is None
            continue
        assert found is not None
        time, matrix = found
        assert time == expected.header.stamp.to_nsec()
        t, r = expected.transform.translation, expected.transform.rotation
        assert matrix[:3, 3] == pytest.approx([t.x, t.y, t.z], abs=1e-6)
        forward = [1 - 2 * (r.y**2 + r.z**2), 2 * (r.x * r.y + r.z * r.w), 2 * (r.x * r.z - r.y * r.w)]
        assert matrix[:3, 0] == pytest.approx(forward, abs=1e-6)


def test_frames_that_do_not_meet() -> None:
    recent = RecentTransforms()
    assert recent.latest("map", "laser") is None
    recent.add("map", "odom", (1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), False)
    assert recent.latest("map", "laser") is None


def test_a_clock_that_is_set_back_begins_anew() -> None:
    recent = RecentTransforms()
    for time, x in ((100 * SECOND, 1.0), (50 * SECOND, 2.0)):
        recent.add("map", "odom", (time, (x, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), False)
    found = recent.latest("map", "odom")
    assert found is not None
    assert found[0] == 50 * SECOND
    np.testing.assert_allclose(found[1][:2, 3], (2.0, 0.0))


def test_old_ones_are_forgotten() -> None:
    recent = RecentTransforms()
    for step in range(2000):
        recent.add("map", "odom", (step * SECOND // 50, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), False)
    assert len(recent._links["odom"].samples) < 600
