# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A live session against a model of its states: calls in any order, from many clients, scans and faults between."""

import faulthandler
import shutil
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from helpers.live_rig import Recorder, until
from helpers.scenes import room_scan
from oort import MapFileError, Parameters, StateError, load_map
from oort.live import LiveSession
from oort.session import State

PATIENCE = 60.0  # [s] for a call
NAMES = ("", "kitchen", "attic")
CLIENTS = 20


class Service(RuleBasedStateMachine):
    """What the table of states of docs/ros.md says, beside what the session does."""

    def __init__(self) -> None:
        super().__init__()
        self.folder = Path(tempfile.mkdtemp())
        self.clients = ThreadPoolExecutor(CLIENTS)
        self.begin()

    def begin(self) -> None:
        self.live = LiveSession(Parameters(), Recorder(), draws=False)
        self.state, self.path, self.has_nodes = State.NOT_MAPPING, "", False
        self.step, self.clock, self.resumed = 0, 100.0, 0

    def ask(self, name: str, *args: Any) -> Any:
        return self._in_time([self.clients.submit(self.live.call, name, args)])[0].result()

    def expect(self, allowed: bool, name: str, *args: Any) -> bool:
        """Makes a call that is refused where the model says so; whether it was allowed."""
        try:
            self.ask(name, *args)
        except StateError as error:
            assert not allowed, f"{name}: {error}"
        else:
            assert allowed, f"{name} was not refused"
        return allowed

    def _in_time(self, futures: Sequence[Future[Any]]) -> Sequence[Future[Any]]:
        if wait(futures, PATIENCE).not_done:
            faulthandler.dump_traceback(sys.stderr, all_threads=True)
            raise AssertionError("a call is not answered")
        return futures

    def base(self, name: str) -> str:
        return str(self.folder / name) if name else ""

    # ---- scans ----

    @rule(scans=st.integers(1, 30))
    def drive(self, scans: int) -> None:
        for _ in range(scans):
            self._push(room_scan(0.01 * self.step, 0.0, 0.02 * self.step, self.clock))
            self.step += 1
            self.clock += 0.1
        until(lambda: len(self.live.inbox) == 0, PATIENCE)
        self.has_nodes |= self.state is State.MAPPING

    @rule(value=st.sampled_from([np.nan, np.inf, -1.0, 0.0, 1e20]))
    def see_nothing(self, value: float) -> None:
        scan = room_scan(0.01 * self.step, 0.0, 0.02 * self.step, self.clock)
        scan.ranges.fill(value)
        self._push(scan)
        until(lambda: len(self.live.inbox) == 0, PATIENCE)
        self.has_nodes = self.live.snapshot.num_nodes > 0

    @rule(seconds=st.sampled_from([-1e8, -50.0, 1.0, 3600.0, 1e8]))
    def jump(self, seconds: float) -> None:
        self.clock += seconds

    def _push(self, scan: Any) -> None:
        self.live.add_scan(lambda: scan)

    # ---- calls ----

    @rule(name=st.sampled_from(NAMES))
    def start(self, name: str) -> None:
        if self.expect(self.state is not State.NOT_MAPPING or not self.has_nodes, "map/start", self.base(name)):
            self.state, self.path = State.MAPPING, self.base(name)

    @rule()
    def stop(self) -> None:
        self.ask("map/stop")
        self.state = State.NOT_MAPPING

    @rule()
    def pause(self) -> None:
        if self.expect(self.state is not State.NOT_MAPPING, "map/pause"):
            self.state = State.PAUSED

    @rule()
    def resume_from_paused(self) -> None:
        if self.expect(self.state is not State.NOT_MAPPING, "map/resume_from_paused"):
            self.state = State.MAPPING

    @rule()
    def clear(self) -> None:
        self.ask("map/clear")
        self.state, self.path, self.has_nodes = State.NOT_MAPPING, "", False

    @rule(name=st.sampled_from(NAMES[1:]))
    def load(self, name: str) -> None:
        try:
            self.ask("map/load", self.base(name))
        except MapFileError:
            assert not Path(self.base(name) + ".md5").exists()
        else:
            self.state, self.path, self.has_nodes = State.NOT_MAPPING, self.base(name), True

    @rule()
    def resume(self) -> None:
        self.resumed += 1
        path = self.base(f"more{self.resumed}")
        if self.expect(self.state is State.NOT_MAPPING and self.has_nodes, "map/resume", path, [0.0, 0.0, 0.0]):
            self.state, self.path = State.MAPPING, path

    @precondition(lambda self: self.state is State.MAPPING and self.has_nodes)
    @rule()
    def name_a_place(self) -> None:
        assert self.ask("graph_loc/create", "rooms", f"place{self.step}") == f"place{self.step}"

    @rule(
        call=st.sampled_from(
            ["map/start", "map/load", "map/nothing", "graph_loc/create", "graph_loc/create_points", ""]
        ),
        args=st.lists(st.one_of(st.none(), st.text(max_size=5), st.floats(), st.just("\0")), min_size=4, max_size=6),
    )
    def call_wrongly(self, call: str, args: list[Any]) -> None:
        self.expect(False, call, *args)

    @rule()
    def storm(self) -> None:
        """Many at once, that change no state."""
        work: list[Callable[[], object]] = [
            lambda: self.live.snapshot,
            lambda: self.live.call("map/nothing"),
            lambda: self.live.call("graph_loc/delete", ["rooms", "nobody"]),
            lambda: self.live.run(lambda session: session.mapper.num_nodes),
        ]
        for future in self._in_time([self.clients.submit(work[k % len(work)]) for k in range(4 * CLIENTS)]):
            assert isinstance(future.exception(), StateError | None)

    @rule()
    def end_and_begin(self) -> None:
        path, nodes = self.path, self.live.snapshot.num_nodes
        self._in_time([self.clients.submit(self.live.close)])[0].result()
        if path and nodes:
            assert len(load_map(path)) == nodes
        assert not list(self.folder.glob(".*.lock")), "a claim is left"
        self.begin()

    # ---- what always holds ----

    @invariant()
    def agrees(self) -> None:
        snapshot = self.live.snapshot
        assert snapshot.state is self.state
        assert (snapshot.num_nodes > 0) == self.has_nodes

    def teardown(self) -> None:
        self._in_time([self.clients.submit(self.live.close)])[0].result()
        self.clients.shutdown()
        for checksums in self.folder.glob("*.md5"):
            load_map(str(checksums)[: -len(".md5")])
        shutil.rmtree(self.folder)


Service.TestCase.settings = settings(
    max_examples=15, stateful_step_count=30, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck)
)
TestService = Service.TestCase
