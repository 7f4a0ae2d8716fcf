# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays within a page: little-endian, zlib, base64. The page's script unpacks them."""

import base64
import zlib
from typing import Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

_TYPES = ("f4", "i4", "i2", "u1")


class Packed(TypedDict):
    """An array as JSON."""

    type: str
    """f4, i4, i2 or u1, as numpy names them"""
    shape: list[int]
    data: str


def pack(values: ArrayLike, type_: str) -> Packed:
    """Packs an array as ``type_``, one of f4, i4, i2, u1. Whole numbers beyond the type's range become its ends."""
    if type_ not in _TYPES:
        raise ValueError(f"{type_!r} is none of {', '.join(_TYPES)}")
    array = np.asarray(values)
    if type_ != "f4":
        limits = np.iinfo(type_)
        array = np.clip(array, limits.min, limits.max)
    array = np.ascontiguousarray(array.astype(f"<{type_}"))
    return {
        "type": type_,
        "shape": list(array.shape),
        "data": base64.b64encode(zlib.compress(array.tobytes(), 9)).decode("ascii"),
    }


def unpack(packed: Packed) -> NDArray[Any]:
    """The array again."""
    data = zlib.decompress(base64.b64decode(packed["data"]))
    return np.frombuffer(data, dtype=f"<{packed['type']}").reshape(packed["shape"])
