# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a live session, in a real browser and by hand-made requests."""

import asyncio
import json
import signal
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

import oort
from helpers.live_rig import driven, until
from helpers.scenes import room_scan
from oort.live import LiveSession
from oort.recording import open_recording
from oort.simulate import Drive
from oort.simulate.writers import write_carmen
from oort.view import Viewer
from oort.view.player import play

_HOSTILE = "</script><img src=x onerror=document.title='owned'>"


@pytest.fixture
def shown(live: LiveSession) -> Iterator[Viewer]:
    """A session on a page that may make calls."""
    with Viewer(live, title="a room", port=0, control=True) as viewer:
        yield viewer


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A page that fails the test for an error in a script or in what the policy forbids."""
    errors: list[str] = []
    context = browser.new_context(viewport={"width": 1400, "height": 1000})
    opened = context.new_page()
    opened.on("pageerror", lambda error: errors.append(str(error)))
    opened.on("console", lambda line: errors.append(line.text) if "Content Security" in line.text else None)
    opened.on("dialog", lambda dialog: dialog.accept())
    yield opened
    context.close()
    assert errors == []


def _open(page: Page, viewer: Viewer) -> None:
    page.goto(viewer.url)
    page.wait_for_selector("body[data-ready]")


def _ask(viewer: Viewer, path: str, headers: dict[str, str], body: bytes | None = None) -> tuple[int, str]:
    request = urllib.request.Request(viewer.url.partition("?")[0] + path, data=body, headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=10.0) as response:
            return response.status, response.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


def _origin(viewer: Viewer) -> str:
    return viewer.url.partition("?")[0].rstrip("/")


def _call(viewer: Viewer, call: str, args: object = None, **headers: str) -> tuple[int, str]:
    body = json.dumps({"call": call, "args": args}).encode()
    usual = {"Origin": _origin(viewer), "Content-Type": "application/json"}
    return _ask(viewer, "call", usual | headers, body)


# ---- in a browser ----


def test_the_page_follows_the_robot_and_the_map_grows(page: Page, shown: Viewer, live: LiveSession) -> None:
    _open(page, shown)
    assert page.locator("#name").inner_text() == "a room"
    assert "not mapping: 0 nodes" in page.locator("#status").inner_text()
    live.call("map/start", [""])
    driven(live)
    page.wait_for_selector("#map img.grid")
    page.wait_for_selector(".robot")
    nodes = live.snapshot.num_nodes
    page.get_by_text(f"mapping: {nodes} nodes").wait_for()
    page.get_by_text("60 mapped of 60 that came").wait_for()
    first = page.locator("body").get_attribute("data-drawing")
    driven(live, scans=30, start=6.0)
    page.wait_for_function("first => document.body.dataset.drawing !== first", arg=first)
    live.call("map/stop")
    page.get_by_text("not mapping:").wait_for()
    assert page.locator(".robot").count() == 0


def test_mapping_that_ends_by_a_fault_is_told(
    page: Page, shown: Viewer, live: LiveSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    _open(page, shown)
    live.call("map/start", [""])

    def fail(_: object) -> None:
        raise MemoryError("no memory is left")

    monkeypatch.setattr(live.keeper, "tick", fail)
    live.inbox.wake()
    page.get_by_text("mapping ended by a fault of Oort's own (MemoryError: no memory is left)").wait_for()
    assert page.locator("#tracking").inner_text() == "mapping ended"
    with pytest.raises(oort.StateError, match="no memory is left"):
        live.call("map/stop")


def test_buttons_make_the_calls(page: Page, shown: Viewer, live: LiveSession) -> None:
    live.call("map/start", [""])
    driven(live)
    _open(page, shown)
    page.get_by_role("button", name="Pause").click()
    page.get_by_text("paused:").wait_for()
    assert page.locator("#figures").get_by_text("none").count() == 1
    live.add_scan(lambda: room_scan(0.0, 0.0, 0.0, 6.5))
    page.locator("#figures").get_by_text("while paused: 1").wait_for()
    page.get_by_role("button", name="Resume").click()
    until(lambda: live.snapshot.state is oort.State.MAPPING)
    driven(live, scans=5, start=7.0)
    page.get_by_role("button", name="The robot is docked").click()
    page.get_by_role("button", name="Name where the robot is").click()
    page.locator("#id").fill("kitchen")
    page.locator("#id").press("Enter")
    page.locator("#places").get_by_text("places/kitchen").wait_for()
    assert ("places", "kitchen") in live.snapshot.places
    page.get_by_role("button", name="Forget places/kitchen").click()
    until(lambda: ("places", "kitchen") not in live.snapshot.places)
    page.get_by_role("button", name="Stop mapping").click()
    page.get_by_text("not mapping:").wait_for()


def test_a_click_on_the_map_names_a_point(page: Page, shown: Viewer, live: LiveSession) -> None:
    live.call("map/start", [""])
    driven(live)
    _open(page, shown)
    page.wait_for_selector("#map img.grid")
    at = page.evaluate("() => { const c = view.map.map.getCenter(); return [c.lng, c.lat]; }")
    page.locator("#map").click()
    page.locator("#id").fill(_HOSTILE)
    page.get_by_role("button", name="Name it").click()
    until(lambda: ("places", _HOSTILE) in live.snapshot.places)
    assert live.snapshot.places["places", _HOSTILE][:2] == pytest.approx(at, abs=0.05)
    page.locator("#places").get_by_text(_HOSTILE).wait_for()
    assert page.title() == "Oort: a room"


def test_what_a_call_says_is_shown(page: Page, shown: Viewer, live: LiveSession) -> None:
    live.call("map/start", [""])
    _open(page, shown)
    page.get_by_role("button", name="The robot is docked").click()
    page.get_by_text("no scan has been mapped yet").wait_for()


def test_the_page_says_when_the_view_is_gone(page: Page, live: LiveSession) -> None:
    with Viewer(live, port=0) as viewer:
        _open(page, viewer)
        assert page.locator("#calls").is_hidden()
    page.get_by_text("not connected").wait_for()


def test_a_view_for_others_opens_by_its_token(page: Page, live: LiveSession) -> None:
    with Viewer(live, port=0, address="0.0.0.0") as viewer:
        here = viewer.url.replace(viewer.url.split("/")[2].partition(":")[0], "127.0.0.1")
        page.goto(here.partition("?")[0])
        assert "the token is missing" in page.locator("body").inner_text()
        page.goto(here)
        page.wait_for_selector("body[data-ready]")
        assert "token" not in page.url


# ---- who is refused ----


def test_who_may_not_look(shown: Viewer) -> None:
    for path in ("", "map", "samples", "parts/view.js", "nothing"):
        assert _ask(shown, path, {"Host": "evil.example"})[0] == 403
    assert _ask(shown, "", {})[0] == 200
    assert _ask(shown, "parts/page.py", {})[0] == 404
    assert _ask(shown, "parts/../view.js", {})[0] == 404
    status, told = _ask(shown, "map", {})
    assert (status, told) == (404, "there is no map yet\n")


def test_who_may_not_call(shown: Viewer, live: LiveSession) -> None:
    live.call("map/start", [""])
    for headers in (
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Host": "evil.example", "Origin": "http://evil.example"},
    ):
        assert _call(shown, "map/stop", **headers)[0] == 403
    assert _call(shown, "map/stop", **{"Content-Type": "text/plain"})[0] == 415
    assert _ask(shown, "call", {"Content-Type": "application/json"}, b"{}")[0] == 403
    assert live.snapshot.state.value == "mapping"
    assert _call(shown, "map/stop") == (200, '{"result": null}')
    assert live.snapshot.state.value == "not_mapping"


def test_a_view_that_only_shows(live: LiveSession) -> None:
    live.call("map/start", [""])
    with Viewer(live, port=0) as viewer:
        status, told = _call(viewer, "map/stop")
    assert (status, live.snapshot.state.value) == (403, "mapping")
    assert "--control" in told


@pytest.mark.parametrize(
    ("call", "args", "told"),
    [
        ("map/load", ["/etc/passwd"], "no call that this page may make"),
        (["map/stop"], None, "no call that this page may make"),
        ("graph_loc/create", None, "space: give a name"),
        ("graph_loc/create_points", {"space": "a", "id": "b", "x": "1", "y": 0}, "x: give a number"),
        ("graph_loc/create_points", {"space": "a", "id": "b", "x": float("nan"), "y": 0}, "x: give a number"),
        ("graph_loc/create_points", {"space": "a", "id": "b", "x": 10**400, "y": 0}, "x: give a number"),
        ("graph_loc/delete", {"space": "a", "id": "x" * 300}, "id: give a name"),
    ],
)
def test_calls_that_cannot_be(shown: Viewer, call: object, args: object, told: str) -> None:
    status, answer = _call(shown, call, args)  # type: ignore[arg-type]
    assert (status, told in answer) == (409, True)


@pytest.mark.parametrize("body", [b"", b"{", b"[]", b"\xff\xfe", b'"x"', b"[" * 5000])
def test_bodies_that_are_no_call(shown: Viewer, body: bytes) -> None:
    headers = {"Origin": _origin(shown), "Content-Type": "application/json"}
    assert _ask(shown, "call", headers, body)[0] == 400
    assert _ask(shown, "", {})[0] == 200


def test_a_stream_only_for_the_page_itself(shown: Viewer) -> None:
    address = _origin(shown).replace("http", "ws") + "/stream"

    async def first(origin: str) -> str:
        stream = await websocket_connect(HTTPRequest(address, headers={"Origin": origin}))
        message = await stream.read_message()
        stream.close()
        return str(message)

    with ThreadPoolExecutor(1) as beside:  # the browser's loop may be this thread's
        assert json.loads(beside.submit(lambda: asyncio.run(first(_origin(shown)))).result())["title"] == "a room"
        with pytest.raises(Exception, match="403"):
            beside.submit(lambda: asyncio.run(first("http://evil.example"))).result()


def test_a_port_that_is_taken(shown: Viewer, live: LiveSession) -> None:
    port = int(_origin(shown).rpartition(":")[2])
    with pytest.raises(oort.OortError, match=f"127.0.0.1:{port} cannot be listened on: Address already in use"):
        Viewer(live, port=port)


@pytest.mark.parametrize(("address", "port"), [("127.0.0.1", 99_999), ("127.0.0.1", -1), ("a" * 100, 0), ("a\0b", 0)])
def test_a_port_and_an_address_that_cannot_be(live: LiveSession, address: str, port: int) -> None:
    with pytest.raises(oort.OortError, match="cannot be listened on"):
        Viewer(live, address=address, port=port)


# ---- what is shown ----


def test_a_live_mapper_is_shown_too() -> None:
    with oort.LiveMapper() as mapper, Viewer(mapper, port=0) as viewer:
        assert viewer.watch.state()["state"] == "mapping"
        assert json.loads(_ask(viewer, "samples", {})[1])["samples"]


def test_a_recording_that_is_watched_gives_the_map_of_a_replay(drive: Drive, tmp_path: Path, live: LiveSession) -> None:
    write_carmen(drive, tmp_path / "home.clf")
    recording = open_recording(str(tmp_path / "home.clf"))
    shares: list[float] = []
    with Viewer(live, port=0):
        play(recording, live, float("inf"), str(tmp_path / "map"), shares.append)
    assert shares[-1] == 1.0
    watched = oort.load_map(str(tmp_path / "map"))
    assert np.array_equal(watched.node_poses, oort.replay(recording).map.node_poses)


def test_the_command(drive: Drive, tmp_path: Path) -> None:
    write_carmen(drive, tmp_path / "home.clf")
    command = [f"{sys.prefix}/bin/oort", "view", str(tmp_path / "home.clf"), "--port", "0", "--speed", "inf"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    too_long = threading.Timer(60.0, process.kill)  # its output ends then, and nothing waits for ever
    too_long.start()
    try:
        assert process.stdout is not None
        address = process.stdout.readline().removeprefix("open ").strip()
        with urllib.request.urlopen(address, timeout=10.0) as response:
            assert b"/parts/view.js" in response.read()
        assert "home is mapped" in process.stdout.readline()
        process.send_signal(signal.SIGTERM)  # SIGINT is ignored where a script's job began the tests
        assert process.wait(20.0) == 0
    finally:
        too_long.cancel()
        process.kill()
        process.communicate()
