# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a replay leaves in its folder."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import SWITCH_ON, Map, Mapper, OccupancyGrid, Parameters, save_map
from oort.areas import areas_of_map, is_area
from oort.diagnosis import Trouble
from oort.evaluation.attempts import judge_attempts, write_attempts
from oort.evaluation.histograms import make_histograms, panels
from oort.evaluation.truth import Judgement, Truth
from oort.export import (
    PoseGraph,
    Trajectory,
    write_closures_picture,
    write_g2o,
    write_map_server,
    write_picture,
    write_tum,
)
from oort.export.beside import Beside, set_beside
from oort.export.chart import write_chart
from oort.export.files import write_atomically
from oort.offline.drawing import draw_map
from oort.offline.outputs import Outputs
from oort.offline.trajectory import TrajectoryRecorder
from oort.recording import Recording
from oort.report.page import make_report_page
from oort.report.replay_report import make_report
from oort.report.run_page import Way, run_page_data
from oort.report.scan_log import ScanLog
from oort.report.stopwatch import Stopwatch
from oort.session import Session

_RESOLUTION = "output_map.probability_grid.resolution"


@dataclass(frozen=True)
class Drive:
    """A replayed drive."""

    recording: Recording
    parameters: Parameters
    session: Session
    recorder: TrajectoryRecorder
    watch: Stopwatch
    recorded_seconds: float
    keep_attempts: bool = False
    """whether to tell of each attempt to close a loop"""
    log: ScanLog = field(default_factory=ScanLog)
    """what became of each scan"""

    @property
    def troubles(self) -> list[Trouble]:
        """What is wrong with the recording or the robot's setup, as far as the drive shows it."""
        return self.session.troubles()

    @property
    def map(self) -> Map:
        """The map of the drive."""
        return self.session.map


@dataclass(frozen=True)
class Results:
    """What came of writing a drive's results."""

    report: dict[str, Any]
    written: Sequence[str]
    """names of files"""
    failed: Sequence[str]
    """a sentence for each file that could not be written"""


def write_results(drive: Drive, out: Path, map_path: str, truth: Truth | None = None) -> Results:
    """Writes the map, and trajectory.tum, map.pgm, .yaml and .png, histograms.png, graph.g2o, report.json to a folder.

    With a ``truth`` the reports say how far the trajectory is off it.
    If the drive keeps attempts, closures.csv and closures.png too. What cannot be written is told in the results, and
    all else is written all the same. Raises OSError if there can be no folder.
    """
    map_ = drive.map
    outputs = Outputs()
    out.mkdir(parents=True, exist_ok=True)
    outputs.write(f"the map {map_path}", lambda: save_map(map_path, map_))
    base_poses = drive.recorder.base_poses(map_)
    outputs.write("trajectory.tum", lambda: write_tum(out / "trajectory.tum", drive.recorder.stamps, base_poses))
    outputs.write("graph.g2o", lambda: write_g2o(out / "graph.g2o", pose_graph(map_)))
    drawn = outputs.work_out("any picture of the map", lambda: draw_map(map_, drive.parameters))
    grid, notes = (drawn[0][0], drawn[1]) if isinstance(drawn, tuple) else (None, [])
    beside = None
    if grid is not None and grid.cells.size:
        beside = set_beside(map_, grid, drive.parameters)
        _write_pictures(drive, out, map_, grid, beside, base_poses, outputs)
    histograms = _histograms(drive, map_)
    if panels_ := panels(histograms):
        outputs.write("histograms.png", lambda: write_chart(out / "histograms.png", panels_))
    judgement = _judge(drive, base_poses, truth, outputs) if truth else None
    report = _report(drive, map_, grid, histograms, [*notes, *outputs.failed])
    if judgement is not None:
        report["truth"] = judgement.figures
    text = json.dumps(report, indent=2) + "\n"
    outputs.write("report.json", lambda: write_atomically(out / "report.json", text.encode()))
    page = out / "report.html"
    outputs.write("report.html", lambda: _write_page(page, drive, report, map_, grid, beside, base_poses, judgement))
    return Results(report, outputs.written, outputs.failed)


def _judge(drive: Drive, base_poses: NDArray[np.float64], truth: Truth, outputs: Outputs) -> Judgement | None:
    trajectory = Trajectory(tuple(drive.recorder.stamps), base_poses)
    judged = outputs.work_out("how far the trajectory is off the truth", lambda: truth.judge(trajectory))
    return judged if isinstance(judged, Judgement) else None


def _write_pictures(
    drive: Drive,
    out: Path,
    map_: Map,
    grid: OccupancyGrid,
    beside: Beside,
    base_poses: NDArray[np.float64],
    outputs: Outputs,
) -> None:
    origin = (*grid.origin, 0.0)
    closures = _closure_ends(map_, beside)
    drawn = np.isfinite(closures).all(axis=(1, 2))
    on = map_.switchable_edges["switch"] >= SWITCH_ON
    outputs.write("map.pgm map.yaml", lambda: write_map_server(out / "map", grid.cells, grid.resolution, origin))
    outputs.write(
        "map.png",
        lambda: write_picture(
            out / "map.png",
            beside.cells,
            grid.resolution,
            origin,
            trajectory=_way(drive, base_poses, beside),
            accepted=closures[on & drawn],
            undone=closures[~on & drawn],
            locations=[(f"{space}/{id}", drive.session.locations.locate(space, id)) for space, id in _names(drive)],
            areas=areas_of_map(map_),
            captions=beside.captions,
        ),
    )
    if drive.keep_attempts:
        outputs.write("closures.csv closures.png", lambda: _write_attempts(out, drive.session.mapper, map_, grid))


def _histograms(drive: Drive, map_: Map) -> dict[str, Any]:
    attempts = drive.session.mapper.closure_attempts
    rejected = [hits for _, _, rejection, _, hits in attempts if rejection is not None and hits > 0.0]
    return make_histograms(map_, drive.log.matched_inlier_ratios.tolist(), rejected)


def _report(
    drive: Drive, map_: Map, grid: OccupancyGrid | None, histograms: dict[str, Any], notes: Sequence[str]
) -> dict[str, Any]:
    report = make_report(
        drive.recording,
        drive.session.mapper.statistics,
        drive.parameters.to_dict(),
        drive.recorded_seconds,
        drive.watch.figures(drive.recorded_seconds, drive.session.mapper.work_seconds),
        {
            "width": 0 if grid is None else grid.width,
            "height": 0 if grid is None else grid.height,
            "resolution": drive.parameters.get(_RESOLUTION) if grid is None else grid.resolution,
            "switchable_edges": len(map_.switchable_edges["switch"]),
            "switched_off": int((map_.switchable_edges["switch"] < SWITCH_ON).sum()),
        },
        histograms,
        [trouble.to_dict() for trouble in drive.troubles],
    )
    return {**report, "notes": [*report["notes"], *notes]}


def _write_attempts(out: Path, mapper: Mapper, map_: Map, grid: OccupancyGrid) -> None:
    attempts = judge_attempts(mapper.closure_attempts, map_)
    write_attempts(out / "closures.csv", attempts)
    positions = map_.node_poses[:, :2]
    ends: dict[str, list[NDArray[np.float64]]] = {}
    for attempt in attempts:
        ends.setdefault(attempt.verdict, []).append(positions[[attempt.query, attempt.candidate]])
    origin = (*grid.origin, 0.0)
    write_closures_picture(out / "closures.png", grid.cells, grid.resolution, origin, ends)


def _write_page(
    path: Path,
    drive: Drive,
    report: dict[str, Any],
    map_: Map,
    grid: OccupancyGrid | None,
    beside: Beside | None,
    base_poses: NDArray[np.float64],
    judgement: Judgement | None,
) -> None:
    attempts = judge_attempts(drive.session.mapper.closure_attempts, map_)
    way = Way(drive.log, base_poses, drive.recorder.carriers(), bool(drive.parameters.get("use_odometry")))
    data = run_page_data(report, drive.parameters, map_, grid, beside, attempts, way, judgement)
    write_atomically(path, make_report_page(f"Oort: {drive.recording.name}", data))


def _names(drive: Drive) -> list[tuple[str, str]]:
    return [(space, id) for space, id, *_ in drive.session.mapper.locations if not is_area(space)]


def _closure_ends(map_: Map, beside: Beside) -> NDArray[np.float64]:
    """(k, 2, 2): where each closure is in the picture; NaN for a closure of nodes that are not drawn."""
    edges = map_.switchable_edges
    positions: NDArray[np.float64] = map_.node_poses[:, :2] + beside.shift
    return positions[beside.ends(edges["i"], edges["j"])]


def _way(drive: Drive, base_poses: NDArray[np.float64], beside: Beside) -> NDArray[np.float64]:
    """(n, 2) the trajectory in the picture, interrupted from part to part."""
    carriers = drive.recorder.carriers()
    if not len(beside.part) or (carriers < 0).all():
        return base_poses[:, :2]
    way = base_poses[:, :2] + beside.shift[carriers]
    begins = np.flatnonzero(np.diff(beside.part[carriers])) + 1
    return np.insert(way, begins, np.nan, axis=0)


def pose_graph(map_: Map) -> PoseGraph:
    """The graph as solved; what a closure's switch took from it is taken from its information too."""
    chain, loops = map_.edges, map_.switchable_edges
    weight = np.maximum(loops["switch"], 1e-3)[:, None, None] ** 2
    return PoseGraph(
        ids=map_.node_ids.astype(np.int64),
        poses=map_.node_poses,
        edges=np.concatenate([np.stack([edges["i"], edges["j"]], axis=1).astype(np.int64) for edges in (chain, loops)]),
        measurements=np.concatenate([chain["pose"], loops["pose"]]),
        covariances=np.concatenate([chain["covariance"], loops["covariance"] / weight]),
    )
