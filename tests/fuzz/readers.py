# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What reads in Python: events, logs, bags, graphs, trajectories, pictures, maps by the command, requests to the page.

    .venv/bin/python tests/fuzz/readers.py READER [atheris's or libFuzzer's options]      with atheris, by coverage
    .venv/bin/python tests/fuzz/readers.py --count N [READER...]                          by chance alone
    .venv/bin/python tests/fuzz/readers.py --seeds READER FOLDER                          writes what to begin with

Whatever is read, nothing but an OortError may come of it. What is by chance is the same each time.
"""

import gc
import math
import os
import re
import struct
import sys
import tempfile
import time
import types
import warnings
from collections.abc import Callable
from pathlib import Path

import hostile_bags
import hostile_maps
import hostile_requests
import numpy as np

from oort import Parameters
from oort.errors import OortError
from oort.evaluation.graph import solve_graph
from oort.evaluation.trajectories import evaluate_ate, evaluate_relations
from oort.events import read_events
from oort.export.g2o import read_g2o
from oort.export.map_server import read_map_server
from oort.export.tum import read_tum
from oort.offline.replay import ReplayOptions, replay
from oort.offline.search_space import parse_axis
from oort.recording import open_recording
from oort.simulate.plan import furnish_plan
from oort.simulate.plan_files import read_plan

_TUM = b"0.0 0 0 0 0 0 0 1\n1.0 1 0.5 0 0 0 0.1 0.99\n2.0 2 1 0 0 0 0.2 0.98\n3.0 3 1 0 0 0 0.2 0.98\n"
_RANGES = " ".join(f"{2 + 0.01 * k:.2f}" for k in range(40))
_TEXTS = {
    "events": b'[{"t": 0, "call": "map/start", "args": [""]}, {"t": 1.5, "call": "graph_loc/create"'
    b', "args": ["a", "b"]}, {"t": 2, "call": "map/notify_docked"}, {"t": 2, "call": "graph_loc/create_points"'
    b', "args": [["a"], [[1, 0]], ["x"]]}]',
    "carmen": "".join(
        f"FLASER 40 {_RANGES} 0.{k} 0 0.1 0.{k} 0 0.1 {k}.5 host {k}.5\n# note\nODOM 0 0 0\n" for k in range(4)
    ).encode(),
    "robotlaser": "".join(
        f"ROBOTLASER1 0 -1.57 3.14 0.08 80.0 0.01 0 40 {_RANGES} 0 0.{k} 0 0 0.{k} 0 0 0 0 1 1 1 {k}.5 host {k}.5\n"
        for k in range(4)
    ).encode(),
    "g2o": b"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.1\nVERTEX_SE2 2 1 1 1.6\nFIX 0\n"
    b"EDGE_SE2 0 1 1 0 0.1 100 0 0 100 0 400\nEDGE_SE2 1 2 0 1 1.5 100 0 0 100 0 400\n"
    b"EDGE_SE2 2 0 1 -1 -1.6 100 0 0 100 0 400\nEDGE2 0 1 1 0 0.1 100 0 100 400 0 0\n",
    "tum": _TUM,
    "relations": b"0.0 1.0 1 0.5 0 0 0 0.2\n1.0 2.0 1 0.5 0 0 0 0.2\n",
    "yaml": b"image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1, -2, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
    b"free_thresh: 0.196\n",
    "house": b'{"rooms": [{"roomType": "LivingRoom", "floorPolygon": [{"x": 0, "z": 0}, {"x": 0, "z": 4}, '
    b'{"x": 5, "z": 4}, {"x": 5, "z": 0}]}, {"roomType": "Kitchen", "floorPolygon": [{"x": 5, "z": 0}, '
    b'{"x": 5, "z": 4}, {"x": 8, "z": 4}, {"x": 8, "z": 0}]}], "walls": [{"id": "w", "polygon": [{"x": 5, "z": 0}, '
    b'{"x": 5, "z": 4}]}], "doors": [{"room0": "a", "room1": "b", "wall0": "w", "holePolygon": [{"x": 1, "y": 0}, '
    b'{"x": 2, "y": 2}]}], "objects": [{"id": "o", "axisAlignedBoundingBox": {"center": {"x": 1, "y": 0.5, "z": 1}, '
    b'"size": {"x": 0.5, "y": 1, "z": 0.5}}}]}',
    "pgm": b"P5\n# made up\n4 3\n255\n" + bytes(12),
}
_AXES = (b"linear_update= 0.1 .. 0.9", b"keep_views= 1 .. 9", b"use_imu= true , false", b"linear_update")
_TOPICS = {"laser": "/scan", "echoes": "/echoes", "transform": "/tf", "static": "/tf_static", "imu": "/imu"}
"""Bags with hostile messages of a topic."""


def _read_events(path: Path) -> None:
    read_events(path)


def _read_carmen(path: Path) -> None:
    recording = open_recording(path)
    replay(recording, options=ReplayOptions(quiet=True))


def _read_g2o(path: Path) -> None:
    graph = read_g2o(path)
    if len(graph.ids) < 20:
        solve_graph(graph, "decide", 2.0)


def _read_tum(path: Path) -> None:
    evaluate_ate(read_tum(path), read_tum(_beside(path, "truth.tum", _TUM)))


def _read_relations(path: Path) -> None:
    evaluate_relations(read_tum(_beside(path, "truth.tum", _TUM)), path)


def _read_yaml(path: Path) -> None:
    _beside(path, "map.pgm", _TEXTS["pgm"])
    read_map_server(path)


def _read_pgm(path: Path) -> None:
    read_map_server(_beside(path, "m.yaml", _TEXTS["yaml"].replace(b"map.pgm", path.name.encode())))


def _read_house(path: Path) -> None:
    furnish_plan(read_plan(path), np.random.Generator(np.random.PCG64(1)))


def _read_axis(path: Path) -> None:
    axis = parse_axis(path.read_text(errors="surrogateescape").replace(" ", ""), Parameters())
    assert axis.choices or math.isfinite(axis.high - axis.low)


def seeds(reader: str) -> list[bytes]:
    """What to begin with."""
    if reader in _TOPICS:
        with tempfile.TemporaryDirectory() as folder:
            return [hostile_bags.seed(_TOPICS[reader], Path(folder))]
    if reader == "words":
        return [(hostile_maps.CORPUS / name).read_bytes() for name in ("loop", "small")]
    if reader == "axis":
        return list(_AXES)
    if reader == "requests":
        return list(hostile_requests.SEEDS)
    if reader == "house":  # numbers are words of their own, which can be changed alone
        return [re.sub(rb": (\d[\d.]*)", rb": \1 ", _TEXTS[reader])]
    return [_TEXTS[reader]]


def _beside(path: Path, name: str, data: bytes) -> Path:
    beside = path.with_name(name)
    beside.write_bytes(data)
    return beside


READERS: dict[str, Callable[[Path], None]] = {
    "events": _read_events,
    "carmen": _read_carmen,
    "robotlaser": _read_carmen,
    "g2o": _read_g2o,
    "tum": _read_tum,
    "relations": _read_relations,
    "yaml": _read_yaml,
    "pgm": _read_pgm,
    "axis": _read_axis,
    "house": _read_house,
    "words": hostile_maps.use,
    "requests": hostile_requests.send,
    **{name: hostile_bags.reader(topic) for name, topic in _TOPICS.items()},
}
_ENDINGS = {"house": ".json", "carmen": ".clf", "robotlaser": ".clf", "yaml": ".yaml", "pgm": ".pgm", "g2o": ".g2o"}
_WORDS = (
    *(b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e-320", b"1e17", b"0", b"-1", b"1_0", b"99999999999999999999"),
    *(b"\0", b"\xff", b"\xed\xa0\x80", b"\n", b" ", b"[", b'"', b"{", b"#", b"null", b"true", b"0x10", b"1" * 5000),
)


def changed(rng: np.random.Generator, data: bytes, most: int = 4) -> bytes:
    """Data with some bytes, words or lines changed."""
    text = bytearray(data)
    for _ in range(int(rng.integers(1, most + 1))):
        at, end = sorted(int(k) for k in rng.integers(0, len(text) + 1, 2))
        match int(rng.integers(0, 6)):
            case 0:
                text[at : at + 1] = bytes([int(rng.integers(0, 256))])
            case 1:
                text[at:end] = b""
            case 2:
                text[at:at] = text[at : min(end, at + 200)]
            case _:  # a word of the text by an odd one
                words = text.split(b" ")
                words[int(rng.integers(0, len(words)))] = bytearray(_WORDS[int(rng.integers(0, len(_WORDS)))])
                text = bytearray(b" ".join(words))
    return bytes(text)


def changed_message(rng: np.random.Generator, data: bytes) -> bytes:
    """A message with odd numbers, of any size, in the place of some bytes."""
    message = bytearray(data)
    for _ in range(int(rng.integers(1, 4))):
        odd = float(rng.choice([0.0, -1.0, 1e-310, 1e9, 1e300, -1e300, math.inf, -math.inf, math.nan]))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            choices = [
                struct.pack("<d", odd),
                np.float32(odd).tobytes(),
                struct.pack("<I", int(rng.choice([0, 1, 255, 1 << 16, 1 << 31, (1 << 32) - 1]))),
                bytes([int(rng.integers(0, 256))]),
            ]
        word = choices[int(rng.integers(0, len(choices)))]
        at = int(rng.integers(0, len(message) + 1))
        if rng.random() < 0.1:
            del message[at : at + int(rng.integers(0, 20))]
        else:
            message[at : at + len(word)] = word
    return bytes(message)


def changed_a_little(rng: np.random.Generator, data: bytes) -> bytes:
    """Data with one change."""
    return changed(rng, data, 1)


_CHANGES: dict[str, Callable[[np.random.Generator, bytes], bytes]] = {
    "axis": changed_a_little,
    "requests": changed_a_little,
    "house": changed_a_little,
    "words": hostile_maps.changed,
    **dict.fromkeys(_TOPICS, changed_message),
}


def try_one(reader: str, data: bytes, folder: Path) -> bool:
    """Reads data; whether it could be read."""
    path = folder / f"input{_ENDINGS.get(reader, '.txt')}"
    path.write_bytes(data)
    try:
        READERS[reader](path)
    except OortError:
        return False
    return True


def by_chance(reader: str, count: int, seed: int = 1) -> int:
    """Reads so many changed inputs; how many could be read."""
    rng = np.random.Generator(np.random.PCG64(seed))
    change, begin = _CHANGES.get(reader, changed), seeds(reader)
    readable = 0
    with tempfile.TemporaryDirectory() as folder:
        for data in begin:
            assert try_one(reader, data, Path(folder)) or reader == "requests", "the seed cannot be read"
        for k in range(count):
            data = change(rng, begin[k % len(begin)])
            try:
                readable += try_one(reader, data, Path(folder))
            except BaseException:
                found = Path(tempfile.mkdtemp(prefix="oort-fuzz-")) / reader
                found.write_bytes(data)
                print(f"{reader}: input {k} of seed {seed} is kept in {found}", file=sys.stderr)
                raise
    return readable


def _by_coverage(reader: str) -> None:
    import atheris

    folder, change, begin = Path(tempfile.mkdtemp()), _CHANGES.get(reader, changed), seeds(reader)

    def mutated(data: bytes, max_size: int, seed: int) -> bytes:
        """Half of them by libFuzzer, half as by chance alone, which knows what a file of this kind is made of."""
        if seed % 2:
            return bytes(atheris.Mutate(data, max_size))
        rng = np.random.Generator(np.random.PCG64(seed))
        return change(rng, data if len(data) > 16 else begin[seed // 2 % len(begin)])[:max_size]

    for data in begin:  # modules that are imported when they are first needed, would not be instrumented
        try_one(reader, data, folder)
    for function in [thing for thing in gc.get_objects() if isinstance(thing, types.FunctionType)]:
        if (function.__module__ or "").partition(".")[0] in ("oort", "rosbags"):  # all of Python would take a minute
            atheris.instrument_func(function)
    atheris.Setup(
        [sys.argv[0], *sys.argv[2:]], lambda data: try_one(reader, data, folder) and None, custom_mutator=mutated
    )
    atheris.Fuzz()


def _main(words: list[str]) -> None:
    warnings.simplefilter("ignore")
    os.environ["OORT_DEBUG"] = "1"  # faults of Oort's own come through
    if words[0] == "--seeds":
        for k, data in enumerate(seeds(words[1])):
            Path(words[2], f"seed{k}").write_bytes(data)
    elif words[0] == "--count":
        for name in words[2:] or READERS:
            started = time.monotonic()
            readable = by_chance(name, int(words[1]), int(os.environ.get("SEED", "1")))
            print(f"{name}: {readable} of {words[1]} could be read, {time.monotonic() - started:.1f} s", flush=True)
    else:
        _by_coverage(words[0])


if __name__ == "__main__":
    _main(sys.argv[1:])
