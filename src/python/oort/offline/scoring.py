# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How well a set of parameters maps one recording, as one number: the smaller, the better.

Against the truth beside the recording (NAME.truth.tum: the position error in metres), else against its relations
(NAME.relations: their mean error in metres), else by how far the map contradicts itself.
"""

import json
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

from oort.errors import InputError, OortError
from oort.evaluation.consistency import consistency
from oort.evaluation.trajectories import evaluate_ate, evaluate_relations
from oort.export.tum import Trajectory, read_tum
from oort.offline.replay import replay
from oort.offline.results import Drive
from oort.offline.workers import local_copy
from oort.parameters import read_parameters
from oort.recording import open_recording
from oort.recording.open import recording_name

_BESIDE = (".truth.tum", ".relations")


@dataclass(frozen=True)
class Trial:
    """A recording and the text of a parameter file to map it with."""

    recording: str
    parameters: str


@dataclass(frozen=True)
class Score:
    """What came of it."""

    kind: str
    """`truth`, `relations` or `agreement`, by what it was judged; `failed` if it could not be mapped"""
    error: float
    """[m] of truth and relations; of agreement from 0, for a map without a contradiction, to about 3"""
    why: str = ""
    """of a failure"""


def score(trial: Trial) -> Score:
    """Maps and judges in a process of its own, so that nothing that happens there costs more than this trial."""
    try:
        with local_copy(trial.recording, _BESIDE) as path, tempfile.TemporaryDirectory(prefix="oort-") as place:
            parameters = Path(place) / "params.json"
            parameters.write_text(trial.parameters)
            command = [sys.executable, "-m", __name__, path, str(parameters)]
            done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    except (OSError, OortError) as error:
        return Score("failed", 0.0, str(error))
    if done.returncode:
        last = (done.stderr.strip().splitlines() or [f"ended with status {done.returncode}"])[-1]
        return Score("failed", 0.0, last)
    return Score(**json.loads(done.stdout))


def judge(drive: Drive, recording: str) -> Score:
    """Judges a mapped drive by what lies beside its recording."""
    base = Path(recording).with_name(recording_name(Path(recording)))
    trajectory = Trajectory(tuple(drive.recorder.stamps), drive.recorder.base_poses(drive.session.map))
    if (truth := base.with_name(f"{base.name}.truth.tum")).is_file():
        return Score("truth", evaluate_ate(trajectory, read_tum(truth)).position_rmse)
    if (relations := base.with_name(f"{base.name}.relations")).is_file():
        return Score("relations", evaluate_relations(trajectory, relations).translation_mean)
    agreement = consistency(drive.session.map)
    if not agreement.pairs:
        raise InputError("the drive never comes back to a place, so its map cannot contradict itself; give a truth")
    # What the place and the sensor allow is the agreement of scans taken right after each other.
    lost = max(0.0, agreement.agreement_near - agreement.agreement)
    return Score("agreement", agreement.contradicting + lost + agreement.untied_nodes / len(drive.session.map))


def _main(recording: str, parameters: str) -> int:
    try:
        values = read_parameters(parameters)
        told = judge(replay(open_recording(recording, parameters=values), values), recording)
    except OortError as error:
        print(error, file=sys.stderr)
        return 2
    print(json.dumps(asdict(told)))
    return 0


if __name__ == "__main__":
    sys.exit(_main(*sys.argv[1:]))
