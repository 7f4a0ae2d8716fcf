# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that end without closing their live session: what they mapped is saved, and nothing is shown of it."""

import subprocess
import sys
from pathlib import Path

import pytest

from oort import load_map

HELPERS = Path(__file__).parents[1]
PROGRAM = """
import sys
sys.path.insert(0, sys.argv[2])
from helpers.live_rig import driven
from oort import Parameters
from oort.live import Listener, LiveSession

live = LiveSession(Parameters(), Listener())
live.call("map/start", [sys.argv[1]])
driven(live, 300)
print(live.snapshot.num_nodes)
{ending}
"""


@pytest.mark.parametrize("ending", ["", "sys.exit(3)", "raise SystemExit"])
def test_a_session_that_is_left_open_is_saved_when_the_program_ends(tmp_path: Path, ending: str) -> None:
    base = str(tmp_path / "home")
    program = PROGRAM.format(ending=ending)
    done = subprocess.run([sys.executable, "-c", program, base, str(HELPERS)], capture_output=True, text=True)
    assert done.stderr == ""
    assert len(load_map(base)) == int(done.stdout) > 5
    assert not list(tmp_path.glob(".*.lock"))
