# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Files that are packed: gzip, bzip2 and zstd."""

import bz2
import gzip
import zlib
from collections.abc import Callable
from typing import IO, Any

from backports import zstd

PACKED: dict[bytes, Callable[..., IO[bytes] | Any]] = {
    b"\x1f\x8b": gzip.open,
    b"BZh": bz2.open,
    b"\x28\xb5\x2f\xfd": zstd.open,
}
"""How to open such a file for reading, by what it begins with."""

SUFFIXES = (".gz", ".bz2", ".zst")

DAMAGED = (EOFError, zlib.error, zstd.ZstdError, OSError)
"""What reading a damaged one raises."""
