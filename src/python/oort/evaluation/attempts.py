# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What became of each attempt to close a loop, for people who tune."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from oort._core import SWITCH_ON, Map
from oort.export.files import write_atomically
from oort.recording import Pose

ACCEPTED, CONTRADICTED, FOLDED = "accepted", "contradicted", "folded"
MOST = 200_000
"""attempts that are kept at most: the newest; some 30 MB"""


@dataclass(frozen=True)
class Attempt:
    """One attempt: where was the node ``query`` looked for, and what was said of it."""

    query: int
    candidate: int
    verdict: str
    """accepted; contradicted: accepted, but the last solution leaves it out; folded: accepted, and gone or carried to
    other nodes when the map was reduced (docs/lifelong.md); else why it was rejected"""
    T_candidate_query: Pose
    """where the match put the query; where the graph had it if there was no match"""
    inlier_ratio: float
    switch: float | None
    """of an accepted one at the last solution; None if it was rejected or is not in the map any more"""


def judge_attempts(told: Sequence[tuple[int, int, str | None, Pose, float]], map_: Map) -> list[Attempt]:
    """The attempts of ``Mapper.closure_attempts`` with what the map's solution says of those that were accepted."""
    edges = map_.switchable_edges
    ends = zip(edges["i"].tolist(), edges["j"].tolist(), strict=True)
    switches = dict(zip(ends, edges["switch"].tolist(), strict=True))
    attempts = []
    for query, candidate, rejection, pose, hits in told:
        switch = None if rejection is not None else switches.get((query, candidate))
        accepted = FOLDED if switch is None else CONTRADICTED if switch < SWITCH_ON else ACCEPTED
        attempts.append(Attempt(query, candidate, rejection or accepted, pose, hits, switch))
    return attempts


def write_attempts(path: Path, attempts: Sequence[Attempt]) -> None:
    """Writes a table of one line per attempt. Raises OortError if the file cannot be written."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["query", "candidate", "verdict", "x", "y", "theta", "hit_fraction", "switch"])
    for a in attempts:
        numbers = [f"{value:.4f}" for value in (*a.T_candidate_query, a.inlier_ratio)]
        table.writerow([a.query, a.candidate, a.verdict, *numbers, "" if a.switch is None else f"{a.switch:.4f}"])
    write_atomically(path, text.getvalue().encode())
