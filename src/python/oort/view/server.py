# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Serves the page of a live session from a thread of its own."""

import asyncio
import ipaddress
import os
import threading
from types import TracebackType

from oort.errors import OortError
from oort.live import LiveMapper, LiveSession
from oort.view.access import Access, access_for
from oort.view.watch import Watch

PORT = 8765
"""where the page is unless asked otherwise"""

_LOOPBACK = "127.0.0.1"
_LAST_PORT = 65_535
_START = 10.0  # [s] that the server may take to listen
_TOKEN = "OORT_VIEW_TOKEN"  # the environment variable


class Viewer:
    """Shows a live session on a page, until it is closed; a context manager.

    It only shows, unless ``control`` lets the page make calls. An address that other machines can reach wants a token:
    the one given, that of the environment variable OORT_VIEW_TOKEN, or one made up; ``url`` has it.
    """

    def __init__(
        self,
        live: LiveSession | LiveMapper,
        *,
        title: str = "Oort",
        address: str = _LOOPBACK,
        port: int = PORT,
        control: bool = False,
        token: str = "",
    ) -> None:
        """Begins to serve; port 0 is any that is free. Raises OortError without tornado, or if the port is taken."""
        if not 0 <= port <= _LAST_PORT:  # the system would take the rest of its division
            raise OortError(f"{address}:{port} cannot be listened on: ports go from 1 to {_LAST_PORT}")
        session = live.session if isinstance(live, LiveMapper) else live
        session.draws = True
        self._access = access_for(address, token or os.environ.get(_TOKEN, ""))
        self._session = session
        self.watch = Watch(session, title, control)
        self._address, self._port, self._control = address, port, control
        self._loop = asyncio.new_event_loop()
        self._stop = asyncio.Event()
        self._listening = threading.Event()
        self._failure: OortError | None = None
        self._thread = threading.Thread(target=self._run, name="oort-view", daemon=True)
        self._thread.start()
        if not self._listening.wait(_START) and self._failure is None:
            self._failure = OortError(f"the page on {address}:{port} does not come up")
        if self._failure is not None:
            self.close()
            raise self._failure

    @property
    def url(self) -> str:
        """What to open in a browser."""
        host = f"[{self._address}]" if ":" in self._address else self._address
        if _is_any(self._address):
            host = os.uname().nodename
        token = f"?token={self._access.token}" if self._access.token else ""
        return f"http://{host}:{self._port}/{token}"

    @property
    def access(self) -> Access:
        """Who may look."""
        return self._access

    def close(self) -> None:
        """Ends the page."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join()

    def __enter__(self) -> "Viewer":
        """Itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes."""
        self.close()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._serve())
        except OortError as error:
            self._failure = error
        finally:
            self._listening.set()
            self._loop.close()

    async def _serve(self) -> None:
        try:
            from tornado.httpserver import HTTPServer
            from tornado.netutil import bind_sockets

            from oort.view.pages import make_application
        except ImportError:
            raise OortError("the live view needs the package tornado: pip install 'oort[view]'") from None
        application = make_application(self.watch, self._session, self._access, self._control)
        server = HTTPServer(application, max_body_size=65_536, max_buffer_size=1_048_576, idle_connection_timeout=60.0)
        try:
            sockets = bind_sockets(self._port, self._address)
        except (OSError, ValueError) as error:  # ValueError: that is no address
            why = error.strerror if isinstance(error, OSError) else error
            raise OortError(
                f"{self._address}:{self._port} cannot be listened on: {why}; choose another port or address"
            ) from None
        server.add_sockets(sockets)
        self._port = int(sockets[0].getsockname()[1])
        self._listening.set()
        sampling = asyncio.create_task(application.settings["hub"].run())
        await self._stop.wait()
        sampling.cancel()
        server.stop()
        application.settings["hub"].close()
        await server.close_all_connections()


def _is_any(address: str) -> bool:
    try:
        return ipaddress.ip_address(address).is_unspecified
    except ValueError:
        return False
