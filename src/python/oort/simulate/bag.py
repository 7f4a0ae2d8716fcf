# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated drive as a bag of ROS 1, a bag of ROS 2, or a lone MCAP."""

import os
import tempfile
from pathlib import Path
from typing import Literal

from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from oort.simulate.drive import Drive
from oort.simulate.messages import TF_STATIC, Messages, topics_of

CALLER = "/simulate"
_METADATA_VERSION: Literal[9] = 9  # of ROS 2 Jazzy and later
_FOR_EVER = QosTime(9223372036, 854775807)


def write_bag(drive: Drive, path: Path) -> None:
    """Write the messages of a drive as a ROS 1 bag, by stamp. The file must not exist yet."""
    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage"))
    topics = topics_of(drive)
    with Writer1(path) as writer:
        connections = {
            topic: writer.add_connection(
                topic, kind, typestore=store, callerid=CALLER, latching=int(topic == TF_STATIC)
            )
            for topic, kind in topics.items()
        }
        for topic, stamp, message in Messages(store.types, drive, of_ros1=True).all():
            writer.write(connections[topic], stamp, store.serialize_ros1(message, topics[topic]))


def write_ros2_bag(drive: Drive, path: Path) -> None:
    """Write the messages of a drive as a ROS 2 bag: a folder, which must not exist yet, with an MCAP in it."""
    store = get_typestore(Stores.ROS2_JAZZY)
    topics = topics_of(drive)
    with Writer2(path, version=_METADATA_VERSION, storage_plugin=StoragePlugin.MCAP) as writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=store, offered_qos_profiles=[_qos(topic)])
            for topic, kind in topics.items()
        }
        for topic, stamp, message in Messages(store.types, drive, of_ros1=False).all():
            writer.write(connections[topic], stamp, store.serialize_cdr(message, topics[topic]))


def write_mcap(drive: Drive, path: Path) -> None:
    """Write the messages of a drive as one MCAP file."""
    with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=".oort-") as folder:
        bag = Path(folder) / "bag"
        write_ros2_bag(drive, bag)
        (written,) = bag.glob("*.mcap")
        os.replace(written, path)


def _qos(topic: str) -> Qos:
    """What a player offers: who comes late still gets what is told once."""
    durability = QosDurability.TRANSIENT_LOCAL if topic == TF_STATIC else QosDurability.VOLATILE
    return Qos(
        QosHistory.KEEP_LAST,
        depth=10,
        reliability=QosReliability.RELIABLE,
        durability=durability,
        deadline=_FOR_EVER,
        lifespan=_FOR_EVER,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=_FOR_EVER,
        avoid_ros_namespace_conventions=False,
    )
