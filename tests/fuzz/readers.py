# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What reads files in Python: events, CARMEN logs, g2o, TUM, relations, map_server's picture and description.

    .venv/bin/python tests/fuzz/readers.py READER [atheris's or libFuzzer's options]      with atheris, by coverage
    .venv/bin/python tests/fuzz/readers.py --count N                                      all of them, by chance alone

Whatever is read, nothing but an OortError may come of it. What is by chance is the same each time.
"""

import os
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from oort.errors import OortError
from oort.evaluation.graph import solve_graph
from oort.evaluation.trajectories import evaluate_ate, evaluate_relations
from oort.events import read_events
from oort.export.g2o import read_g2o
from oort.export.map_server import read_map_server
from oort.export.tum import read_tum
from oort.offline.replay import ReplayOptions, replay
from oort.recording import open_recording

_TUM = b"0.0 0 0 0 0 0 0 1\n1.0 1 0.5 0 0 0 0.1 0.99\n2.0 2 1 0 0 0 0.2 0.98\n3.0 3 1 0 0 0 0.2 0.98\n"
_RANGES = " ".join(f"{2 + 0.01 * k:.2f}" for k in range(40))
SEEDS = {
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
    "pgm": b"P5\n# made up\n4 3\n255\n" + bytes(12),
}


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
    _beside(path, "map.pgm", SEEDS["pgm"])
    read_map_server(path)


def _read_pgm(path: Path) -> None:
    read_map_server(_beside(path, "m.yaml", SEEDS["yaml"].replace(b"map.pgm", path.name.encode())))


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
}
_ENDINGS = {"carmen": ".clf", "robotlaser": ".clf", "yaml": ".yaml", "pgm": ".pgm", "g2o": ".g2o"}
_WORDS = (
    *(b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e-320", b"1e17", b"0", b"-1", b"1_0", b"99999999999999999999"),
    *(b"\0", b"\xff", b"\xed\xa0\x80", b"\n", b" ", b"[", b'"', b"{", b"#", b"null", b"true", b"0x10", b"1" * 5000),
)


def changed(rng: np.random.Generator, data: bytes) -> bytes:
    """Data with some bytes, words or lines changed."""
    text = bytearray(data)
    for _ in range(int(rng.integers(1, 5))):
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
    with tempfile.TemporaryDirectory() as folder:
        assert try_one(reader, SEEDS[reader], Path(folder)), "the seed cannot be read"
        return sum(try_one(reader, changed(rng, SEEDS[reader]), Path(folder)) for _ in range(count))


def _by_coverage(reader: str) -> None:
    import atheris

    folder = Path(tempfile.mkdtemp())
    atheris.instrument_all()
    atheris.Setup([sys.argv[0], *sys.argv[2:]], lambda data: try_one(reader, data, folder) and None)
    atheris.Fuzz()


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    if sys.argv[1] == "--seed":
        sys.stdout.buffer.write(SEEDS[sys.argv[2]])
    elif sys.argv[1] == "--count":
        for name in READERS:
            print(f"{name}: {by_chance(name, int(sys.argv[2]), int(os.environ.get('SEED', '1')))} could be read")
    else:
        _by_coverage(sys.argv[1])
