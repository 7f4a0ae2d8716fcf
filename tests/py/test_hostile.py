# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The cases of bench/faults.py whose inputs can be made here, each in a process of its own."""

import json
import os
import sys
from pathlib import Path

import pytest

from conftest import ROOT
from helpers.recording_files import flaser
from helpers.scenes import room_scan

sys.path.insert(0, str(ROOT / "bench"))

from faults import run
from hostile.cases import CASES, Case

ELSEWHERE = {
    "denormal_turn": "LearnedOdometry.LearnsNothingFromAlmostNoMotion",
    "merge_far_point": "Codec.AReturnThatNoLaserCanSeeIsNone",
    "map_over_1_gib": "Defect.FindsWhatMakesAMapUnusable",
}
"""Cases whose inputs are recordings or maps, and the C++ test that has their kind; those of maps are all Defect.*."""
ROOT_ONLY = {"output_is_a_device"}
HERE = [case for case in CASES if case.name not in ELSEWHERE and not case.name.startswith("use_")]


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small inputs, as in the folder that bench/faults.py is given."""
    folder = tmp_path_factory.mktemp("inputs")
    scans = [room_scan(0.02 * k, 0.0, 0.02 * k, 0.1 * k) for k in range(60)]
    lines = [flaser(s.stamp, s.ranges.tolist(), s.odometry) + "\n" for s in scans]
    (folder / "small.clf").write_text("".join(lines))
    (folder / "digits.clf").write_text(f"FLASER {'1' * 5000}\n")
    (folder / "events_deep.json").write_text("[" * 100_000 + "]" * 100_000)
    (folder / "events_surrogate.json").write_text(r'[{"t": 0, "call": "graph_loc/create", "args": ["\ud800", "x"]}]')
    far = {"t": 3e9, "call": "graph_loc/create_points", "args": [["a"], [[1e300, 0]], ["x"]]}
    (folder / "place_far.json").write_text(json.dumps([{"t": 0, "call": "map/start", "args": [""]}, far]))
    matcher = {"scanmatcher": "cartographer_matcher", "cartographer_matcher": {"linear_search_window": 100.0}}
    (folder / "params_memory.json").write_text(json.dumps({"incremental_graph_builder": matcher}))
    return folder


@pytest.mark.parametrize("case", HERE, ids=lambda case: f"{case.row}-{case.name}")
def test_nothing_hostile_gets_through(case: Case, inputs: Path) -> None:
    if case.name in ROOT_ONLY and os.geteuid() != 0:
        pytest.skip("only root can make a device")
    outcome = run(case, inputs)
    assert not outcome.wrong, f"{outcome.wrong}: {outcome.told}"
