# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How mapping goes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from oort.live import LiveSession
from oort.node.diagnostics import ERROR, WARN, Health, Problem, health_of_input, number


@dataclass(frozen=True, kw_only=True, slots=True)
class MappingHealth(Health):
    """Of a live session."""

    state: str
    """not_mapping, mapping or paused"""
    path: str
    """where the map is saved; empty for nowhere"""
    tracking: str
    """tracking, uncertain, lost or idle"""
    inlier_ratio: float | None
    """share of the last scan's returns that lie on what was seen before"""
    nodes: int
    closures: int
    """loops and docks that were closed"""
    last_save: str
    """map, or meta where only the places were written; empty if nothing was"""
    seconds_since_save: float | None
    save_error: str
    """why the last save failed; empty if it did not"""
    troubles: Sequence[str]
    """what is wrong with the robot's setup, and what to do"""
    clock_jumps: int
    """how often the scans' clock was set back"""

    @property
    def part(self) -> str:
        """What the node does."""
        return "mapping"

    @property
    def all_well(self) -> str:
        """The sentence when nothing is wrong."""
        if self.state == "mapping":
            return f"Mapping, {self.nodes} nodes"
        if self.state == "paused":
            return "Paused; map/resume_from_paused goes on"
        return "Not mapping" + (f", a map of {self.nodes} nodes is loaded" if self.nodes else "")

    def problems(self) -> Iterator[Problem]:
        """What is wrong; without mapping nothing is missed."""
        if self.save_error:
            yield ERROR, f"The map was not saved ({self.save_error}); correct that, then call map/stop or map on"
        if self.state != "mapping":
            return
        yield from self.problems_of_input()
        if self.tracking == "lost":
            yield WARN, "Tracking is lost, mapping goes on by odometry alone; drive slowly to a place with more in view"
        for trouble in self.troubles:
            yield WARN, trouble[:1].upper() + trouble[1:]
        yield from self.problems_of_queue()

    def figures(self) -> Iterator[tuple[str, str]]:
        """Keys and values, always in this order."""
        yield "state", self.state
        yield "path", self.path or "-"
        yield from self.figures_of_scans()
        yield "tracking", self.tracking
        yield "inlier ratio", number(self.inlier_ratio, 2)
        yield "nodes", str(self.nodes)
        yield "closures", str(self.closures)
        yield "last save", self.last_save or "-"
        yield "time since last save [s]", number(self.seconds_since_save, 1)
        yield "save error", self.save_error or "-"
        yield from self.figures_of_waiting()
        yield "clock jumps", str(self.clock_jumps)


def look_over(live: LiveSession, scan_topic: str, waiting_for: str, imu_trouble: str) -> MappingHealth:
    """How mapping goes now; ``waiting_for`` says which transform the waiting scans lack, ``imu_trouble`` as Health."""
    snapshot = live.snapshot
    figures, saver = live.figures, live.keeper.saver
    result = figures.last_result
    return MappingHealth(
        **health_of_input(figures, live.inbox),
        state=snapshot.state.value,
        path=snapshot.path,
        scan_topic=scan_topic,
        tracking=figures.tracking(snapshot.state).value,
        inlier_ratio=None if result is None else result.inlier_ratio,
        nodes=snapshot.num_nodes,
        closures=snapshot.closures,
        last_save=saver.last_saved,
        seconds_since_save=saver.seconds_since_save,
        save_error=saver.error,
        waiting_for=waiting_for,
        imu_trouble=imu_trouble,
        troubles=[str(trouble) for trouble in live.troubles],
        clock_jumps=figures.clock_jumps,
    )
