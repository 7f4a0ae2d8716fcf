# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the command does with a changed map: its words that read maps, in this process.

An input is an unpacked message, as for tests/fuzz/fuzz_map.cpp, whose corpus serves here too.
"""

import contextlib
import io
import os
import struct
import zlib
from pathlib import Path

import numpy as np

from oort.cli.main import main
from oort.errors import OortError
from oort.offline.export import FORMATS

CORPUS = Path(__file__).parent / "corpus" / "map"

_AT_A_TIME = 4  # words that are tried with one map
_ODD = (
    0.0,
    -0.0,
    1.0,
    -1.0,
    5e-324,
    1e-9,
    3.2,
    149.0,
    151.0,
    1e5,
    -1e5,
    1e9,
    1e17,
    1e154,
    1e300,
    -1e300,
    np.inf,
    np.nan,
)
_WORDS: tuple[tuple[str, ...], ...] = (
    ("info", "MAP", "--json", "--ignore-checksum"),
    ("info", "MAP", "--ignore-checksum"),
    ("rooms", "MAP", "--json", "--ignore-checksum"),
    ("rooms", "MAP", "--name", "1", "kitchen", "--ignore-checksum"),
    ("areas", "MAP", "--json", "--ignore-checksum"),
    ("areas", "MAP", "--ignore-checksum", "--add", "no_go_area", "x", "--points", "1", "1", "2", "1", "1e5", "-1e5"),
    ("areas", "MAP", "--ignore-checksum", "--remove", "no_go_area", "x"),
    ("render", "MAP", "drawn", "--ignore-checksum"),
    ("prune", "MAP", "pruned", "--ignore-checksum"),
    ("migrate", "MAP", "migrated", "--ignore-checksum"),
    ("history", "MAP", "--json"),
    ("history", "MAP", "--restore", "1"),
    *(("export", "MAP", format_, "exported", "--ignore-checksum") for format_ in FORMATS),
)


def packed(data: bytes) -> bytes:
    """In Cap'n Proto's packed encoding."""
    out = bytearray()
    data = data[: len(data) // 8 * 8]
    at = 0
    while at < len(data):
        word = data[at : at + 8]
        at += 8
        kept = bytes(byte for byte in word if byte)
        out.append(sum(1 << k for k in range(8) if word[k]))
        out += kept
        if len(kept) in (0, 8):  # then a count of words follows: of further zeros, or of words as they are
            run = 0
            while len(kept) == 0 and run < 255 and data[at : at + 8] == bytes(8):
                run += 1
                at += 8
            out.append(run)
    return bytes(out)


def changed(rng: np.random.Generator, data: bytes) -> bytes:
    """A message with odd numbers, small ones or others of its own in the place of some words."""
    words = bytearray(data[: len(data) // 8 * 8])
    count = len(words) // 8
    for _ in range(int(rng.integers(1, 4))):
        at, other = 8 * int(rng.integers(0, count)), 8 * int(rng.integers(0, count))
        match int(rng.integers(0, 4)):
            case 0:
                words[at : at + 8] = words[other : other + 8]
            case 1:
                words[at + int(rng.integers(0, 8))] = int(rng.integers(0, 256))
            case _:
                words[at : at + 8] = struct.pack("<d", _ODD[int(rng.integers(0, len(_ODD)))])
    return bytes(words)


def use(path: Path) -> None:
    """Runs some words, chosen by the input itself, with the map that a file holds."""
    data = path.read_bytes()
    folder = path.parent
    for name in ("home", "home.previous"):
        (folder / f"{name}.map_capnp").write_bytes(packed(data))
        (folder / f"{name}.map_meta_capnp").unlink(missing_ok=True)
        (folder / f"{name}.md5").unlink(missing_ok=True)
    number = zlib.crc32(data)
    read = False
    for k in range(_AT_A_TIME):
        words = _WORDS[(number + k * 7) % len(_WORDS)]
        read |= _run([str(folder / "home") if word == "MAP" else word for word in words], folder) == 0
    if not read:
        raise OortError("no word could use it")


def _run(words: list[str], folder: Path) -> int:
    """The exit status of the command; faults of Oort's own are raised."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            status = main(words)
    finally:
        os.chdir(before)
    if status not in (0, 2):
        raise AssertionError(f"{words}: status {status}")
    return status
