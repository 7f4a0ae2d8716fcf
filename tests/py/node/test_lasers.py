# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Robots that are set up wrongly: what the node says of it, and that it lives on."""

import time
from typing import Any

import pytest

pytest.importorskip("rospy")
from diagnostic_msgs.msg import DiagnosticArray
from tf2_msgs.msg import TFMessage

from node.client import Client, Heard, figures
from node.conftest import NodeFactory
from node.robot import BASE, LASER, ODOM, SHORT, Robot
from oort.node.messages import transform


def test_a_second_laser_on_the_topic_joins_the_first(rospy: Any, node: NodeFactory) -> None:
    client = Client(node())
    with Robot(SHORT, laser="depth_camera_link") as other:
        other.base_on = False
        other.wait_for_node()  # before its place is replaced in the latch, which both share
        with Robot(SHORT) as robot:
            robot.wait_for_node()
            client.call("map/start", "")
            robot.drive(SHORT)
            other.drive(SHORT[-5:], odometry=False)
            with Heard("/diagnostics", DiagnosticArray) as told:
                message = told.wait_for(lambda message: figures(message)["queue size"] == "0", "an empty queue", 8.0)
            client.call("map/stop")
    assert figures(message)["scans processed"] == str(len(SHORT))
    assert figures(message)["scans received"] == str(len(SHORT) + 5)
    assert figures(message)["scans dropped"] == "0"


def test_static_odometry(rospy: Any, node: NodeFactory) -> None:
    client = Client(node())
    still = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
    links = [
        transform(ODOM, BASE, rospy.Time(), (0.0, 0.0, 0.0)),
        transform(BASE, LASER, rospy.Time(), (0.1, 0.0, 0.0)),
    ]
    with Robot(SHORT) as robot:
        robot.base_on = False
        still.publish(TFMessage(links))
        robot.wait_for_node()
        time.sleep(0.5)
        client.call("map/start", "")
        robot.drive(SHORT[:3], odometry=False)
        with Heard("/diagnostics", DiagnosticArray) as told:
            message = told.wait_for(lambda message: "scans wait" in message.status[0].message, "a warning", 5.0)
        client.call("map/stop")
    still.unregister()
    assert "3 scans wait: odom -> base_footprint is static: no odometry; check" in message.status[0].message
