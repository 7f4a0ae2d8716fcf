# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Prints summaries as Markdown tables, and how two runs differ."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Rows = Mapping[str, Mapping[str, Any]]
"""By a row's name: summary, drives and failed, as the results file holds them."""

Summary = Mapping[str, Any]

_TIMES = ("cpu_s", "ms_", "seconds_", "memory_mb", "share_closing", "over_5_ms")


@dataclass(frozen=True)
class _Table:
    title: str
    needs: str
    """a figure that the rows of this table have"""
    columns: Mapping[str, Callable[[Summary], str]]


def _pair(name: str, digits: int = 3) -> Callable[[Summary], str]:
    return lambda s: f"{s[name + '_median']:.{digits}f} / {s[name + '_worst']:.{digits}f}"


def _number(name: str, digits: int = 2) -> Callable[[Summary], str]:
    return lambda s: f"{s[name]:.{digits}f}"


def _percent(name: str) -> Callable[[Summary], str]:
    return lambda s: f"{100.0 * s[name]:.1f}"


def _axes(kind: str) -> Callable[[Summary], str]:
    return lambda s: " / ".join(f"{s[f'{kind}_nees_{axis}']:.2f}" for axis in ("x", "y", "theta"))


def _direction(kind: str) -> Callable[[Summary], str]:
    return lambda s: (
        f"{100.0 * s[f'{kind}_share']:.1f} % / {s[f'{kind}_nees']:.2f} / "
        f"{100.0 * s[f'{kind}_error']:.1f} / {100.0 * s[f'{kind}_std']:.1f}"
    )


def _named(name: str, digits: int = 3) -> Callable[[Summary], str]:
    return lambda s: ", ".join(f"{drive.split('/')[1]}: {value:.{digits}f}" for drive, value in s[name].items())


_TABLES = (
    _Table(
        "Trajectories (ATE in m; broken: above 0.5 m)",
        "ate_mean",
        {
            "median": _number("ate_median", 4),
            "worst": _number("ate_worst", 4),
            "above 6 cm": _number("above_6_cm", 0),
            "broken": _number("broken", 0),
            "odometry alone, median": _number("odometry_ate_median"),
            "minutes": lambda s: f"{s['minutes_least']:.1f}-{s['minutes_most']:.1f}",
            "CPU s, mean": _number("cpu_s_mean"),
            "worst five": _named("worst"),
        },
    ),
    _Table(
        "Corridor (m; median / worst; along its axis and across; of odometry also with the true headings)",
        "chain_along_nees",
        {
            "along, end": _pair("along_end", 2),
            "along, most": _pair("along_max", 2),
            "odometry": _pair("odometry_along_max", 2),
            "odometry steered": _pair("odometry_steered_along_max", 2),
            "rms against odometry steered": _number("against_odometry"),
            "across, most": _pair("across_max", 2),
            "odometry across": _pair("odometry_across_max", 2),
            "chain along": _pair("chain_along", 2),
            "its std": _pair("chain_along_std", 2),
            "NEES along (1)": _number("chain_along_nees"),
            "NEES across (1)": _number("chain_across_nees"),
        },
    ),
    _Table(
        "Odometry faults (median / worst)",
        "never_found",
        {
            "lost, s": _pair("lost_s", 1),
            "never lost": _number("never_lost", 0),
            "never found": _number("never_found", 0),
            "told uncertain or lost, of lost": _percent("told"),
            "of not lost": _percent("told_wrongly"),
            "ATE after, m": _pair("ate_after"),
            "ATE, m": _pair("ate"),
            "broken": _number("broken", 0),
            "worst five": _named("worst"),
        },
    ),
    _Table(
        "Closures (false: off by more than 0.3 m or 10 degrees; poor: 0.1 m; RMSE of nodes, median / worst)",
        "false_kept",
        {
            "true kept": _number("true_kept", 0),
            "true off": _number("true_off", 0),
            "false kept": _number("false_kept", 0),
            "false off": _number("false_off", 0),
            "poor kept": _number("poor_kept", 0),
            "NEES of kept (3), median": lambda s: f"{s['kept_nees']:.1f}, {s['kept_nees_median']:.2f}",
            "above 99 %, % (1)": _percent("kept_over_99"),
            "RMSE": _pair("nodes_rmse"),
            "chain alone": _pair("nodes_rmse_chain"),
            "with true closures": _pair("nodes_rmse_true_closures"),
            "false ones kept in": _named("false_kept_in", 0),
        },
    ),
    _Table(
        "Calibration of the chain (NEES; in brackets what an honest one is)",
        "laser_nees",
        {
            "laser edges": _number("laser_edges", 0),
            "NEES (3)": _number("laser_nees"),
            "of drives": lambda s: f"{s['laser_nees_least']:.1f}-{s['laser_nees_most']:.1f}",
            "x / y / theta (1)": _axes("laser"),
            "above 99 %, % (1)": _percent("laser_over_99"),
            "ten in a row (3)": _number("span_nees"),
            "ways too long, %": lambda s: f"{100.0 * s['laser_stretch']:+.2f}",
            "odometry edges (3)": _number("odometry_nees"),
            "odometry links, %": _percent("odometry_links"),
            "free: share / NEES (1) / error / std, cm": _direction("free"),
            "wide: the same": _direction("wide"),
        },
    ),
    _Table(
        "Cost (CPU ms per scan, the median over drives; without solving: less the time in the solver; not closing: "
        "scans that try no closure and solve nothing)",
        "ms_p99_no_closing",
        {
            "P50": _number("ms_p50"),
            "P99": _number("ms_p99", 1),
            "P99 without solving": _number("ms_p99_no_solving", 1),
            "most, without solving": _number("ms_max_no_solving", 1),
            "over 5 ms, without solving": lambda s: f"{s['over_5_ms_no_solving']:.0f} of {s['scans']:.0f}",
            "P99 not closing": _number("ms_p99_no_closing"),
            "most, not closing": _number("ms_max_no_closing", 1),
            "time spent closing, %": _percent("share_closing"),
            "MB, most": _number("memory_mb_most", 0),
        },
    ),
)


def print_table(head: Sequence[str], rows: Mapping[str, Sequence[str]]) -> None:
    """Prints rows of cells by their names, and nothing if there is none."""
    if not rows:
        return
    print(f"| {' | '.join(head)} |", "|" + "---|" * len(head), sep="\n")
    for name, cells in rows.items():
        print(f"| {name} | {' | '.join(cells)} |")
    print()


def tables(rows: Rows) -> Iterator[str]:
    """The lines of all tables that the rows have something for."""
    if "logs" in rows:
        yield from _log_table(rows["logs"]["drives"])
    for table in _TABLES:
        chosen = {name: row for name, row in rows.items() if table.needs in row["summary"]}
        if chosen:
            yield from ("", f"**{table.title}**", "", f"| row | drives | {' | '.join(table.columns)} |")
            yield "|---" * (len(table.columns) + 2) + "|"
        for name, row in chosen.items():
            cells = [column(row["summary"]) for column in table.columns.values()]
            yield f"| {name} | {len(row['drives'])} | {' | '.join(cells)} |"
    for name, row in rows.items():
        for drive, reason in row["failed"].items():
            yield f"failed, {name}: {drive}: {reason}"


def _log_table(drives: Mapping[str, Mapping[str, float]]) -> Iterator[str]:
    head = "error: mean of the absolute errors over all relations; without solving, not closing: see below"
    yield from ("", f"**Logs** ({head})", "")
    yield (
        "| log | error, m | deg | nodes | by odometry | closures on / off | CPU s | ms/scan P50 / P99 / most | "
        "without solving P99 / most, over 5 ms | not closing P99 / most | MB |"
    )
    yield "|---" * 11 + "|"
    for name, f in drives.items():
        yield (
            f"| {name.split('/')[1]} | {f['error']:.4f} ± {f['error_std']:.4f} (most {f['error_max']:.2f}) | "
            f"{f['degrees']:.3f} | {f['nodes']:.0f} | {f['odometry_links']:.0f} | "
            f"{f['closures_on']:.0f} / {f['closures_off']:.0f} | {f['cpu_s']:.1f} | "
            f"{f['ms_p50']:.2f} / {f['ms_p99']:.1f} / {f['ms_max']:.0f} | {f['ms_p99_no_solving']:.1f} / "
            f"{f['ms_max_no_solving']:.1f}, {f['over_5_ms_no_solving']:.0f} of {f['scans']:.0f} | "
            f"{f['ms_p99_no_closing']:.2f} / {f['ms_max_no_closing']:.1f} | {f['memory_mb']:.0f} |"
        )


def comparison(old: Rows, new: Rows, ranks: Mapping[str, str]) -> Iterator[str]:
    """The lines that say what differs between two runs, row by row: the summaries' figures, then the drives."""
    for name in new:
        if name not in old:
            yield f"\n{name}: only in the second"
            continue
        yield f"\n{name}"
        before, after = old[name]["summary"], new[name]["summary"]
        for figure in after:
            a, b = before.get(figure), after[figure]
            if isinstance(a, int | float) and isinstance(b, int | float) and _differ(figure, a, b):
                yield f"  {figure:<36} {a:>11.4f} -> {b:>11.4f}{_change(a, b)}"
        yield from _compare_drives(old[name]["drives"], new[name]["drives"], ranks[name])
        yield from (
            f"  newly failed: {d}: {why}" for d, why in new[name]["failed"].items() if d not in old[name]["failed"]
        )


def _compare_drives(old: Summary, new: Summary, rank: str) -> Iterator[str]:
    changes = sorted((new[d][rank] - old[d][rank], d) for d in new if d in old and new[d][rank] != old[d][rank])
    better, worse = [c for c in changes if c[0] < 0.0], [c for c in changes[::-1] if c[0] > 0.0]
    yield f"  {rank}: {len(better)} drives better, {len(worse)} worse, {len(new) - len(changes)} the same or new"
    for word, chosen in (("better", better), ("worse", worse)):
        for _, drive in chosen[:5]:
            yield f"    {word:<7} {drive:<20} {old[drive][rank]:.4f} -> {new[drive][rank]:.4f}"


def _differ(figure: str, a: float, b: float) -> bool:
    """Times differ from run to run, so small changes of them are none."""
    threshold = 0.1 if any(part in figure for part in _TIMES) else 1e-9
    return abs(b - a) > threshold * max(abs(a), abs(b))


def _change(a: float, b: float) -> str:
    return f"  {100.0 * (b - a) / a:+.0f} %" if a else ""
