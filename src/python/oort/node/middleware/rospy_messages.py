# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps as messages of ROS 1 that write themselves at once instead of cell by cell."""

import io
import struct
from typing import BinaryIO

import numpy as np
from nav_msgs.msg import OccupancyGrid
from oort_msgs.srv import GetMapResponse


class FastGrid(OccupancyGrid):  # type: ignore[misc]
    """An OccupancyGrid whose `data` is an int8 array: the same bytes, written at once instead of cell by cell."""

    def serialize(self, buff: BinaryIO) -> None:
        """Writes the message; `data` that is not an int8 array goes the generated way, with its checks."""
        if getattr(self.data, "dtype", None) != np.int8:
            super().serialize(buff)
            return
        head = io.BytesIO()
        OccupancyGrid(self.header, self.info, []).serialize(head)  # ends in the count of cells, 0
        buff.write(head.getbuffer()[:-4])
        buff.write(struct.pack("<I", self.data.size))
        buff.write(self.data.tobytes())


class FastMapResponse(GetMapResponse):  # type: ignore[misc]
    """A GetMapResponse that lets its map write itself; rospy tells responses by their `_type`, so it takes this one."""

    def serialize(self, buff: BinaryIO) -> None:
        """Writes the message."""
        self.map.serialize(buff)
