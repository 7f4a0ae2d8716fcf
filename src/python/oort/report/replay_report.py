# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of a replay: the table that people read and report.json."""

from collections.abc import Mapping, Sequence
from typing import Any

from oort._core import TrackingState
from oort.recording import Recording

REPORT_VERSION = 2
"""of report.json (docs/formats.md): another one if a key is renamed or changes its meaning"""


def make_report(
    recording: Recording,
    statistics: Mapping[str, Any],
    parameters: Mapping[str, Any],
    recorded_seconds: float,
    timings: Mapping[str, Any],
    map_figures: Mapping[str, Any],
    histograms: Mapping[str, Any],
    troubles: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any]:
    """Everything that report.json holds. Only ``timings`` differs between two replays of the same input."""
    return {
        "report_version": REPORT_VERSION,
        "input": recording.name,
        "kind": recording.kind,
        "notes": list(recording.notes),
        "troubles": list(troubles),
        "recorded_seconds": recorded_seconds,
        **statistics,
        "map": dict(map_figures),
        "histograms": dict(histograms),
        "timings": dict(timings),
        "parameters": dict(parameters),
    }


def format_troubles(report: Mapping[str, Any]) -> str:
    """The list of what is wrong with the recording or the setup; empty if nothing is."""
    lines = [f"- {trouble['text']}: {trouble['advice']}" for trouble in report["troubles"]]
    return "\n".join(["what is wrong with this recording or setup:", *lines] if lines else [])


def format_table(report: Mapping[str, Any]) -> str:
    """The figures as aligned lines of text."""
    rows = table_rows(report)
    width = max(len(name) for name, _ in rows)
    return "\n".join(f"{name:<{width}}  {value}" for name, value in rows)


def table_rows(report: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The figures that people look at, each with its name."""
    timings = report["timings"]
    per_scan = timings["ms_per_scan"]
    return [
        ("scans", f"{report['scans']} ({report['scans_matched']} matched, {report['scans_too_small']} too small)"),
        (
            "nodes",
            f"{report['nodes']} ({report['odometry_links']} linked by odometry{_reasons(report['match_rejections'])})",
        ),
        ("tracking", _tracking(report["tracking"])),
        ("loop closures", _closures(report["loops"])),
        ("dock closures", _closures(report["docks"])),
        (
            "solved",
            "{kept} closures kept, {contradicted} undone, {came_back} came back".format(**report["solved"]),
        ),
        ("map", f"{report['map']['width']} x {report['map']['height']} cells of {report['map']['resolution']} m"),
        ("ms per scan", "P50 {p50:.2f}  P95 {p95:.2f}  P99 {p99:.2f}  max {max:.1f}".format(**per_scan)),
        ("waited", "{seconds:.2f} s in all for global SLAM, at most {max_ms:.0f} ms".format(**timings["waited"])),
        ("times real time", f"{timings['times_real_time']:.0f}"),
        ("CPU seconds", f"{timings['cpu_seconds']:.2f}{_work(timings['cpu_seconds_by_work'])}"),
        ("peak memory", f"{timings['peak_memory_mb']:.0f} MB"),
        *_truth(report.get("truth", {})),
    ]


def _truth(truth: Mapping[str, Any]) -> list[tuple[str, str]]:
    rows = []
    if ate := truth.get("ate"):
        turned = f"heading {ate['heading_rmse']:.2f} deg"
        rows.append(("off the truth", f"{ate['position_rmse']:.4f} m, at most {ate['position_max']:.4f} m; {turned}"))
    if relations := truth.get("relations"):
        spread = f"at most {relations['translation_max']:.3f} m; {relations['rotation_mean']:.3f} deg"
        rows.append(("off the relations", f"{relations['translation_mean']:.4f} m on average, {spread}"))
    return rows


def _closures(counts: Mapping[str, Any]) -> str:
    return f"{counts['tried']} tried, {counts['accepted']} accepted{_reasons(counts['rejected'], ', rejected: ')}"


def _tracking(scans: Mapping[str, int]) -> str:
    states = ", ".join(f"{scans[state]} scans {state}" for state in TrackingState)
    return f"{states}; {scans['changes']} changes"


def _work(seconds: Mapping[str, float]) -> str:
    return f" ({', '.join(f'{work} {spent:.2f}' for work, spent in seconds.items())})"


def _reasons(reasons: Mapping[str, int], lead: str = ": ") -> str:
    return lead + ", ".join(f"{reason} {count}" for reason, count in sorted(reasons.items())) if reasons else ""
