# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the server answers: the page, its parts, the map, the stream of states, and calls where they are allowed."""

import asyncio
import json
from importlib.resources import files
from typing import Any

from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from oort.errors import OortError
from oort.live import LiveSession
from oort.report.page import asset
from oort.view.access import Access
from oort.view.calls import make_call
from oort.view.watch import Watch

_PERIOD = 0.2  # [s] between states
_VISITORS = 16  # pages that may be open at a time
_COOKIE = "oort_token"
_PARTS = {
    **{name: ("oort.report", f"vendor/{name}") for name in ("leaflet.js", "leaflet.css", "uplot.js", "uplot.css")},
    **{name: ("oort.report", name) for name in ("data.js", "page.css")},
    **{name: ("oort.view", name) for name in ("view.js", "live_map.js", "charts.js", "calls.js", "view.css")},
}
_TYPES = {"js": "text/javascript; charset=utf-8", "css": "text/css; charset=utf-8"}
# Leaflet sets styles of elements. Nothing is taken from elsewhere, and no other page may frame this one.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


class Hub:
    """Samples the session and sends each state to all pages that are open."""

    def __init__(self, watch: Watch) -> None:
        """No page is open."""
        self.watch = watch
        self.pages: set[Stream] = set()

    async def run(self) -> None:
        """Sends states until it is cancelled. A page that does not keep up misses some."""
        while True:
            state = json.dumps(self.watch.state())
            for page in list(self.pages):
                page.offer(state)
            await asyncio.sleep(_PERIOD)

    def close(self) -> None:
        """Says goodbye to the pages."""
        for page in list(self.pages):
            page.close(1001, "the view ends")


class Guarded(RequestHandler):
    """Refuses who may not look, before anything else."""

    def prepare(self) -> None:
        """Checks the Host and the token."""
        check_visitor(self)

    def set_default_headers(self) -> None:
        """Nothing from elsewhere, nothing kept."""
        self.clear_header("Server")
        self.set_header("Content-Security-Policy", _POLICY)
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cache-Control", "no-store")

    def write_error(self, status_code: int, **how: Any) -> None:
        """A sentence, and nothing of the inside."""
        error = how.get("exc_info", (None, None, None))[1]
        told = error.log_message % error.args if isinstance(error, HTTPError) and error.log_message else self._reason
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"{told}\n")


def check_visitor(handler: RequestHandler) -> None:
    """Raises HTTPError for a Host that this server is not, or a visitor without the token."""
    access: Access = handler.settings["access"]
    if not access.admits_host(handler.request.headers.get("Host", "")):
        raise HTTPError(403, "this server does not go by that name; open the address that oort view printed")
    given = handler.get_query_argument("token", "") or handler.get_cookie(_COOKIE, "") or ""
    if not access.admits_token(given):
        raise HTTPError(403, "the token is missing or wrong; open the whole address that oort view printed")


class Page(Guarded):
    """The page. Its address with the token becomes one without, which no history and no screen shows."""

    def get(self) -> None:
        """Answers."""
        if self.get_query_argument("token", ""):
            self.set_cookie(_COOKIE, self.get_query_argument("token"), httponly=True, samesite="Strict")
            self.redirect("/")
            return
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish(_own("view.html"))


class Part(Guarded):
    """Scripts and styles."""

    def get(self, name: str) -> None:
        """Answers."""
        if name not in _PARTS:
            raise HTTPError(404, "there is no such part")
        package, path = _PARTS[name]
        self.set_header("Content-Type", _TYPES[name.rpartition(".")[2]])
        self.finish(_own(path) if package == "oort.view" else asset(path))


class Nowhere(Guarded):
    """Any other address."""

    def prepare(self) -> None:
        """Says so, to who may look."""
        super().prepare()
        raise HTTPError(404, "there is no such page")


class MapLayers(Guarded):
    """The newest drawing of the map; each is packed once, by a thread."""

    async def get(self) -> None:
        """Answers."""
        settings = self.settings
        try:
            async with settings["packing"]:
                drawing = settings["live"].gallery.drawing
                if settings["packed"].get("drawing") is not drawing or drawing is None:
                    packed = await asyncio.to_thread(lambda: json.dumps(settings["watch"].map_layers()))
                    settings["packed"].update(drawing=drawing, text=packed)
        except OortError as error:
            raise HTTPError(404, "%s", str(error)) from None
        self.set_header("Content-Type", "application/json")
        self.finish(settings["packed"]["text"])


class Samples(Guarded):
    """The rows of the charts so far."""

    def get(self) -> None:
        """Answers."""
        self.finish({"samples": list(self.settings["watch"].samples)})


class Calls(Guarded):
    """Calls, where they are allowed and come from the page itself."""

    async def post(self) -> None:
        """Makes a call; answers when it took effect."""
        request = self.request
        if not self.settings["control"]:
            raise HTTPError(403, "this view only shows; start it with --control to make calls")
        if not self.settings["access"].admits_origin(request.headers.get("Origin"), request.headers.get("Host", "")):
            raise HTTPError(403, "a call must come from the view's own page")
        if request.headers.get("Content-Type", "").partition(";")[0].strip() != "application/json":
            raise HTTPError(415, "a call is JSON")
        try:
            wanted = json.loads(request.body)
        except (ValueError, RecursionError):
            raise HTTPError(400, "a call is JSON") from None
        if not isinstance(wanted, dict):
            raise HTTPError(400, "a call is an object with call and args")
        try:
            result = await asyncio.to_thread(make_call, self.settings["live"], wanted.get("call"), wanted.get("args"))
        except OortError as error:
            self.set_status(409)
            self.finish({"error": str(error)})
            return
        self.finish({"result": result})


class Stream(WebSocketHandler):
    """States, one after another, to one page."""

    def prepare(self) -> None:
        """Checks the Host and the token."""
        check_visitor(self)
        if len(self.settings["hub"].pages) >= _VISITORS:
            raise HTTPError(503, "too many pages are open")

    def check_origin(self, origin: str) -> bool:
        """Only the page itself may listen."""
        admitted: bool = self.settings["access"].admits_origin(origin, self.request.headers.get("Host", ""))
        return admitted

    def open(self, *args: str, **kwargs: str) -> None:
        """A page was opened."""
        self._sending: asyncio.Task[None] | None = None
        self.settings["hub"].pages.add(self)

    def on_message(self, message: str | bytes) -> None:
        """Nothing is expected."""

    def on_close(self) -> None:
        """The page was closed."""
        self.settings["hub"].pages.discard(self)

    def offer(self, state: str) -> None:
        """Sends a state, unless the one before is still on its way."""
        if self._sending is None or self._sending.done():
            self._sending = asyncio.create_task(self._send(state))

    async def _send(self, state: str) -> None:
        try:
            await self.write_message(state)
        except WebSocketClosedError:
            self.settings["hub"].pages.discard(self)


def make_application(watch: Watch, live: LiveSession, access: Access, control: bool) -> Application:
    """All that the server answers."""
    handlers = [
        (r"/", Page),
        (r"/parts/([a-z_.]+)", Part),
        (r"/map", MapLayers),
        (r"/samples", Samples),
        (r"/call", Calls),
        (r"/stream", Stream),
    ]
    return Application(
        handlers,
        default_handler_class=Nowhere,
        websocket_ping_interval=20.0,
        websocket_max_message_size=1024,
        log_function=lambda handler: None,
        hub=Hub(watch),
        watch=watch,
        live=live,
        access=access,
        control=control,
        packing=asyncio.Lock(),
        packed={},
    )


def _own(name: str) -> str:
    return (files("oort.view") / "web" / name).read_text(encoding="utf-8")
