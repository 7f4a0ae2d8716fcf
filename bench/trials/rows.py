# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The rows of the table: which drives each holds, and the figures of all its drives together."""

import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from trials.corridor import measure_corridor
from trials.drives import Recipe
from trials.faults import measure_fault
from trials.jobs import Figures, Job, Log, Measure

Results = Mapping[str, Figures]
Summary = dict[str, Any]

GOOD, BROKEN = 0.06, 0.5  # m of ATE: the most that the homes are to have, and from where a map is broken
CORRIDORS, FAULTY_HOMES = 10, 20  # drives of these rows at most


@dataclass(frozen=True)
class Row:
    """A row of the table."""

    name: str
    jobs: Callable[[int], list[Job]]
    """from the number of homes asked for"""
    rank: str
    """the figure by which drives are the worst"""
    summarise: Callable[[Results], Summary]


def _simulated(row: str, recipe: Callable[[int], Recipe], *measures: Measure, at_most: int = 1000) -> Any:
    def jobs(homes: int) -> list[Job]:
        return [Job(f"{row}/{seed}", recipe(seed), measures) for seed in range(1, min(homes, at_most) + 1)]

    return jobs


def _logs(_: int) -> list[Job]:
    ranges = (("full", None), ("3.0", 3.0), ("2.2", 2.2))
    return [Job(f"logs/{log}-{name}", Log(log, limit)) for name, limit in ranges for log in ("fr079", "intel")]


def _logs_without_odometry(_: int) -> list[Job]:
    return [Job(f"logs-alone/{log}", Log(log, None), use_odometry=False) for log in ("fr079", "intel")]


def _homes_without_odometry(homes: int) -> list[Job]:
    return [Job(f"homes-alone/{seed}", Recipe(seed), use_odometry=False) for seed in range(1, homes + 1)]


def _summarise_logs(results: Results) -> Summary:
    kept = ("error", "error_std", "degrees", "cpu_s", "ms_p50", "ms_p99", "closures_on", "closures_off", "nodes")
    return {f"{name} {key}": figures[key] for name, figures in results.items() for key in kept}


def _summarise_homes(results: Results) -> Summary:
    ates = _values(results, "ate")
    return {
        "ate_median": statistics.median(ates),
        "ate_worst": max(ates),
        "ate_mean": statistics.fmean(ates),
        "above_6_cm": sum(ate > GOOD for ate in ates),
        "broken": sum(ate > BROKEN for ate in ates),
        "odometry_ate_median": statistics.median(_values(results, "ate_odometry")),
        "heading_median": statistics.median(_values(results, "heading")),
        "minutes_least": min(_values(results, "minutes")),
        "minutes_most": max(_values(results, "minutes")),
        "worst": _worst(results, "ate"),
        "cpu_s_mean": statistics.fmean(_values(results, "cpu_s")),
        **_cost(results),
        **_closures(results),
        **_calibration(results),
    }


def _summarise_corridor(results: Results) -> Summary:
    summary: Summary = {}
    for name in ("along_end", "along_max", "across_max", "chain_along", "chain_along_std", "chain_across"):
        summary |= _median_and_worst(results, name)
    for name in ("odometry", "odometry_steered"):
        for part in ("along_end", "along_max", "across_max"):
            summary |= _median_and_worst(results, f"{name}_{part}")
    own, odometry = (np.array(_values(results, name)) for name in ("along_max", "odometry_steered_along_max"))
    return summary | {
        "against_odometry": float(np.sqrt(np.mean(own**2) / np.mean(odometry**2))),
        "chain_along_nees": statistics.fmean(_values(results, "chain_along_nees")),
        "chain_across_nees": statistics.fmean(_values(results, "chain_across_nees")),
        "worst": _worst(results, "along_max"),
        **_cost(results),
        **_closures(results),
        **_calibration(results),
    }


def _summarise_faults(results: Results) -> Summary:
    summary: Summary = {"broken": sum(ate > BROKEN for ate in _values(results, "ate"))}
    for name in ("lost_s", "ate_after", "ate"):
        summary |= _median_and_worst(results, name)
    return summary | {
        "never_lost": sum(value == 0.0 for value in _values(results, "lost_s")),
        "never_found": sum(value == 0.0 for value in _values(results, "recovered")),
        "told": _ratio(results, "told_lost", ("scans_lost",)),
        "told_wrongly": _ratio(results, "told_found", ("scans_found",)),
        "worst": _worst(results, "ate"),
        **_cost(results),
        **_closures(results),
        **_calibration(results),
    }


def _median_and_worst(results: Results, name: str) -> Summary:
    values = _values(results, name)
    return {f"{name}_median": statistics.median(values), f"{name}_worst": max(values)}


def _cost(results: Results) -> Summary:
    """Of all drives, weighted by nothing: medians over drives of their percentiles, and the worst scan of all."""
    return {
        "ms_p50": statistics.median(_values(results, "ms_p50")),
        "ms_p99": statistics.median(_values(results, "ms_p99")),
        "ms_p99_no_closing": statistics.median(_values(results, "ms_p99_no_closing")),
        "ms_max_no_closing": max(_values(results, "ms_max_no_closing")),
        "ms_p99_no_solving": statistics.median(_values(results, "ms_p99_no_solving")),
        "ms_max_no_solving": max(_values(results, "ms_max_no_solving")),
        "over_5_ms_no_solving": sum(_values(results, "over_5_ms_no_solving")),
        "scans": sum(_values(results, "scans")),
        "share_closing": _ratio(results, "seconds_closing", ("seconds_closing", "seconds_no_closing")),
        "memory_mb_most": max(_values(results, "memory_mb")),
    }


def _closures(results: Results) -> Summary:
    kinds = ("true_kept", "true_off", "false_kept", "false_off", "poor_kept")
    counts: Summary = {kind: int(sum(_values(results, kind))) for kind in kinds}
    with_false = {name: int(figures["false_kept"]) for name, figures in results.items() if figures["false_kept"]}
    for part in ("nees", "over_99"):
        counts[f"kept_{part}"] = _ratio(results, f"kept_{part}", ("true_kept", "false_kept"))
    counts["kept_nees_median"] = statistics.median(_values(results, "kept_nees_median"))
    for name in ("nodes_rmse", "nodes_rmse_chain", "nodes_rmse_true_closures"):
        counts |= _median_and_worst(results, name)
    return counts | {"drives_with_false_kept": len(with_false), "false_kept_in": with_false}


def _calibration(results: Results) -> Summary:
    summary: Summary = {
        "odometry_links": _ratio(results, "odometry_links", ("nodes",)),
        "laser_stretch": _ratio(results, "laser_way_error", ("laser_way",)),
    }
    for kind in ("laser", "odometry", "span"):
        summary[f"{kind}_edges"] = sum(_values(results, f"{kind}_edges"))
        for part in ("nees", "nees_x", "nees_y", "nees_theta", "over_99"):
            summary[f"{kind}_{part}"] = _ratio(results, f"{kind}_{part}", (f"{kind}_edges",))
    nees = [f["laser_nees"] / max(f["laser_edges"], 1.0) for f in results.values()]
    summary |= {"laser_nees_least": min(nees), "laser_nees_most": max(nees)}
    for kind in ("wide", "free"):
        summary[f"{kind}_share"] = _ratio(results, f"{kind}_edges", ("laser_edges",))
        summary[f"{kind}_nees"] = _ratio(results, f"{kind}_nees", (f"{kind}_edges",))
        summary[f"{kind}_error"] = float(np.sqrt(_ratio(results, f"{kind}_squared_error", (f"{kind}_edges",))))
        summary[f"{kind}_std"] = float(np.sqrt(_ratio(results, f"{kind}_variance", (f"{kind}_edges",))))
    return summary


def _values(results: Results, name: str) -> list[float]:
    return [figures[name] for figures in results.values()]


def _ratio(results: Results, above: str, below: Sequence[str]) -> float:
    total = sum(sum(_values(results, name)) for name in below)
    return sum(_values(results, above)) / total if total else 0.0


def _worst(results: Results, rank: str) -> dict[str, float]:
    order = sorted(results, key=lambda name: -results[name][rank])
    return {name: results[name][rank] for name in order[:5]}


def _fov(degrees: int) -> Row:
    jobs = _simulated(f"fov{degrees}", lambda seed: Recipe(seed, field_of_view=degrees))
    return Row(f"fov{degrees}", jobs, "ate", _summarise_homes)


def _corridor(name: str) -> Row:
    jobs = _simulated(
        name, lambda seed: Recipe(seed, scene=name, odometry_error=1.0), measure_corridor, at_most=CORRIDORS
    )
    return Row(name, jobs, "along_max", _summarise_corridor)


def _fault(fault: str) -> Row:
    jobs = _simulated(fault, lambda seed: Recipe(seed, fault=fault), measure_fault, at_most=FAULTY_HOMES)
    return Row(fault, jobs, "ate", _summarise_faults)


ROWS = (
    Row("logs", _logs, "error", _summarise_logs),
    Row("homes", _simulated("homes", Recipe), "ate", _summarise_homes),
    Row("logs-alone", _logs_without_odometry, "error", _summarise_logs),
    Row("homes-alone", _homes_without_odometry, "ate", _summarise_homes),
    _fov(120),
    _fov(90),
    _fov(60),
    _corridor("corridor"),
    _corridor("corridor-return"),
    Row("alike", _simulated("alike", lambda seed: Recipe(seed, scene="alike")), "ate", _summarise_homes),
    _fault("freeze"),
    _fault("bump"),
    _fault("carried"),
)
