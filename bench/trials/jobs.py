# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""One drive of a row: what it is, and what is measured of it."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from oort import Parameters
from oort.evaluation.trajectories import AteResult, evaluate_ate, evaluate_relations
from oort.export import Trajectory
from oort.offline.results import write_results
from oort.poses import Array
from oort.recording import open_recording
from oort.simulate import Drive
from trials.closures import closure_figures
from trials.datasets import datasets
from trials.drives import DriveStore, Recipe, events_of, recording_of
from trials.pictures import draw
from trials.replays import Replayed, cost, counts, replay
from trials.truth import calibration_figures, true_nodes

Figures = dict[str, float]
Measure = Callable[[Drive, Replayed], Figures]

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Log:
    """A recorded drive with relations (Kuemmerle et al. 2009)."""

    name: str
    max_range: float | None


@dataclass(frozen=True)
class Job:
    """One drive of a row."""

    name: str
    source: Recipe | Log
    measures: tuple[Measure, ...] = ()
    """of a simulated drive, beyond what is measured of all"""
    use_odometry: bool = True


@dataclass(frozen=True)
class Bench:
    """What all drives of a run share."""

    store: DriveStore
    parameters: Parameters
    keep: Path
    """where maps and pictures go"""

    def run(self, job: Job) -> Figures:
        """Replays a drive and measures it. Of a log, the results are written too, as its cost is that of the whole."""
        if isinstance(job.source, Log):
            return self._run_log(job, job.source)
        drive = self.store.load(job.source)
        replayed = self._replay(drive, job)
        figures = cost(replayed) | counts(replayed)
        for measure in (measure_all, *job.measures):
            figures |= measure(drive, replayed)
        return figures

    def draw(self, job: Job) -> Figures:
        """Replays a simulated drive once more and leaves its map and a picture that compares it with the truth."""
        assert isinstance(job.source, Recipe)
        drive = self.store.load(job.source)
        replayed = self._replay(drive, job)
        folder = self.keep / job.name
        write_results(replayed.drive, folder, str(folder.absolute() / "map"))
        draw(folder / "truth.png", drive, replayed)
        return {}

    def _parameters(self, job: Job) -> Parameters:
        parameters = self.parameters.copy()
        if not job.use_odometry:
            parameters.set("use_odometry", False)
        return parameters

    def _replay(self, drive: Drive, job: Job) -> Replayed:
        mark = drive.fault_times[0] - 1e-6 if drive.fault_times is not None else math.inf
        return replay(recording_of(drive, job.name), self._parameters(job), events_of(drive), mark)

    def _run_log(self, job: Job, log: Log) -> Figures:
        folder = datasets() / "radish"
        parameters = self._parameters(job)
        recording = open_recording(folder / f"{log.name}.clf.bz2", max_range=log.max_range, parameters=parameters)
        replayed = replay(recording, parameters)
        out = self.keep / job.name
        write_results(replayed.drive, out, str(out.absolute() / "map"))
        figures = cost(replayed) | counts(replayed)
        trajectory = Trajectory(tuple(replayed.drive.recorder.stamps), replayed.T_map_base)
        error = evaluate_relations(trajectory, folder / f"{log.name}.relations")
        return {
            "error": error.translation_mean,
            "error_std": error.translation_std,
            "error_max": error.translation_max,
            "degrees": error.rotation_mean,
            "degrees_std": error.rotation_std,
            "relations_missing": float(error.missing),
        } | figures


def measure_all(drive: Drive, replayed: Replayed) -> Figures:
    """The trajectory's error, the odometry's for scale, and what the truth says of the graph."""
    map_ = replayed.drive.session.map
    truth, _ = true_nodes(map_, drive)
    ate, odometry = ate_of(drive, replayed.T_map_base), ate_of(drive, drive.T_odom_base_at_scans)
    figures = {
        "ate": ate.position_rmse,
        "ate_max": ate.position_max,
        "heading": ate.heading_rmse,
        "ate_odometry": odometry.position_rmse,
        "metres": drive.length,
        "minutes": drive.duration / 60.0,
    }
    return figures | closure_figures(map_, truth) | calibration_figures(map_, drive)


def ate_of(drive: Drive, T_frame_base: Array, part: slice = slice(None)) -> AteResult:  # noqa: N803
    """The error of poses (n, 3), one per scan of the drive, or of a part of them."""
    stamps = tuple(f"{time:.6f}" for time in drive.scan_times[part].tolist())
    return evaluate_ate(Trajectory(stamps, T_frame_base[part]), Trajectory(stamps, np.asarray(drive.T_map_base[part])))
