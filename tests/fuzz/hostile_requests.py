# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What somebody may send to the page of a live session, by hand.

An input is a request; HOST, ORIGIN and LENGTH in it are put right, so that more than the first check is reached.
"""

import atexit
import functools
import logging
import socket
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "py"))

from helpers.live_rig import driven
from oort import Parameters
from oort.errors import OortError
from oort.live import Listener, LiveSession
from oort.view import Viewer

_PATIENCE = 10.0  # [s] to be let in
_ENOUGH = 4096  # bytes
_SILENCE = 0.2  # [s] after which an answer is over
_POST = (
    b"POST /call HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\nOrigin: ORIGIN\r\nContent-Type: application/json\r\n"
    b"Content-Length: LENGTH\r\n\r\n"
)
SEEDS = (
    _POST + b'{"call": "graph_loc/create_points", "args": {"space": "rooms", "id": "k", "x": 1.5, "y": -2}}',
    _POST + b'{"call": "graph_loc/create", "args": {"space": "rooms", "id": "k"}}',
    _POST + b'{"call": "graph_loc/delete", "args": {"space": "rooms", "id": "k"}}',
    _POST + b'{"call": "map/notify_docked", "args": null}',
    b"GET /parts/view.js HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\nCookie: oort_token=x\r\n\r\n",
    b"GET /?token=x HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n",
    b"GET /map HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\nAccept-Encoding: gzip\r\n\r\n",
    b"GET /stream HTTP/1.1\r\nHost: HOST\r\nOrigin: ORIGIN\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n\x81\x85\x00\x00\x00\x00hello",
)


class _Complaints(logging.Handler):
    """Keeps what the server calls an error of its own."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.texts.append(self.format(record))


@functools.cache
def _server() -> tuple[Viewer, LiveSession, _Complaints]:
    complaints = _Complaints()
    for name in ("tornado.application", "tornado.general", "asyncio"):
        logging.getLogger(name).addHandler(complaints)
        logging.getLogger(name).propagate = False
    live = LiveSession(Parameters(), Listener())
    live.call("map/start", [""])
    driven(live, 30)
    viewer = Viewer(live, port=0, control=True)
    atexit.register(live.close)
    atexit.register(viewer.close)
    return viewer, live, complaints


def send(path: Path) -> None:
    """Sends what a file holds. Raises AssertionError for a fault of the server's, OortError for a refusal."""
    viewer, _, complaints = _server()
    host = viewer.url.removeprefix("http://").rstrip("/")
    data = path.read_bytes()
    _, _, body = data.partition(b"\r\n\r\n")
    for word, right in ((b"HOST", host), (b"ORIGIN", f"http://{host}"), (b"LENGTH", str(len(body)))):
        data = data.replace(word, right.encode(), 1)
    answer = _answer(host, data)
    assert not complaints.texts, complaints.texts[0]
    status = answer[9:12]
    assert not status.startswith(b"5") or status == b"503", answer[:500]
    page = _answer(host, f"GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode(), _PATIENCE)
    assert page.startswith(b"HTTP/1.1 200"), f"the page is gone: {page[:200]!r}"
    if not status.startswith((b"1", b"2", b"3")):
        raise OortError(f"refused: {answer[:200]!r}")


def _answer(host: str, data: bytes, silence: float = _SILENCE) -> bytes:
    """What comes back until the server has no more to say; the begin, if that is much."""
    name, _, port = host.rpartition(":")
    answer = b""
    with socket.create_connection((name, int(port)), _PATIENCE) as connection:
        connection.settimeout(silence)
        try:
            connection.sendall(data)
            while len(answer) < _ENOUGH and (part := connection.recv(_ENOUGH)):
                answer += part
                connection.settimeout(_SILENCE)
        except (ConnectionResetError, BrokenPipeError, TimeoutError):
            pass  # a request that is not whole gets no answer
    return answer
