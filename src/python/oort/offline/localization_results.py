# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What following a drive on a saved map leaves in its folder."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from oort._core import LocalizationState, Map, Parameters
from oort.export import write_picture, write_tum
from oort.export.files import write_atomically
from oort.offline.drawing import draw_map
from oort.offline.follow import LocalizedDrive
from oort.report.replay_report import REPORT_VERSION


def write_localization(
    drive: LocalizedDrive, map_: Map, map_path: str, parameters: Parameters, out: Path
) -> dict[str, Any]:
    """Writes trajectory.tum, map.png and report.json into a folder; returns the report.

    The trajectory has the scans whose pose was known. Raises OortError if something cannot be written.
    """
    out.mkdir(parents=True, exist_ok=True)
    write_tum(out / "trajectory.tum", drive.stamps, drive.base_poses)
    (grid, _), notes = draw_map(map_, parameters)
    if grid.cells.size:
        write_picture(out / "map.png", grid.cells, grid.resolution, (*grid.origin, 0.0), trajectory=drive.base_poses)
    report = _report(drive, map_path, parameters)
    report["notes"] += notes
    write_atomically(out / "report.json", (json.dumps(report, indent=2) + "\n").encode())
    return report


def _report(drive: LocalizedDrive, map_path: str, parameters: Parameters) -> dict[str, Any]:
    deviations = np.array(drive.deviations)
    return {
        "report_version": REPORT_VERSION,
        "input": drive.recording.name,
        "kind": drive.recording.kind,
        "notes": list(drive.recording.notes),
        "map": map_path,
        "recorded_seconds": drive.recorded_seconds,
        **drive.localizer.statistics,
        "scans_with_pose": len(drive.stamps),
        "states": {state: n for state in LocalizationState if (n := _count(drive, state))},
        "stretches": [{"state": s.state, "begin": s.begin, "end": s.end, "scans": s.scans} for s in drive.stretches],
        "position_deviation": {
            "median": round(float(np.median(deviations)), 4) if len(deviations) else None,
            "max": round(float(deviations.max()), 4) if len(deviations) else None,
        },
        "timings": drive.watch.figures(drive.recorded_seconds),
        "parameters": parameters.to_dict(),
    }


def _count(drive: LocalizedDrive, state: LocalizationState) -> int:
    return sum(stretch.scans for stretch in drive.stretches if stretch.state == state)


def format_localization(report: dict[str, Any]) -> str:
    """The figures as aligned lines of text."""
    per_scan = report["timings"]["ms_per_scan"]
    rows = [
        ("scans", f"{report['scans']} ({report['matched']} matched{_reasons(report['match_rejections'])})"),
        ("states", ", ".join(f"{state} {n}" for state, n in report["states"].items())),
        ("searches", f"{report['searches']}{_reasons(report['search_rejections'])}, {report['jumps']} jumps"),
        ("deviation", _deviation(**report["position_deviation"])),
        ("ms per scan", "P50 {p50:.2f}  P95 {p95:.2f}  P99 {p99:.2f}  max {max:.1f}".format(**per_scan)),
    ]
    width = max(len(name) for name, _ in rows)
    return "\n".join(f"{name:<{width}}  {value}" for name, value in rows)


def _deviation(median: float | None, max: float | None) -> str:
    return "-" if median is None else f"median {median:.3f} m, max {max:.3f} m"


def _reasons(reasons: dict[str, int]) -> str:
    return "; rejected: " + ", ".join(f"{why} {n}" for why, n in sorted(reasons.items())) if reasons else ""
