# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Solves pose graphs of any origin: ``oort graph solve IN.g2o OUT.g2o``."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort.cli.tool import Parser, add_json_argument, print_result, run_tool
from oort.evaluation.graph import (
    METHODS,
    Solution,
    chi_squared,
    find_closures,
    position_rmse,
    read_truth,
    solve_graph,
)
from oort.export import PoseGraph, read_g2o, write_g2o

_LISTED = 20  # edges that are printed


def _figures(before: PoseGraph, solution: Solution, truth: NDArray[np.float64] | None) -> dict[str, Any]:
    believed = solution.believed
    off = np.flatnonzero(~believed)
    start = chi_squared(before)
    figures: dict[str, Any] = {
        "nodes": len(before.ids),
        "edges": len(believed),
        "closures": int(find_closures(before).sum()),
        "converged": solution.summary.converged,
        "iterations": solution.summary.iterations,
        "chi2_before": float(start.sum()),
        "chi2": float(solution.chi_squared.sum()),
        "chi2_believed_before": float(start[believed].sum()),
        "chi2_believed": float(solution.chi_squared[believed].sum()),
        "switched_off": [
            {"i": i, "j": j, "chi2": chi2}
            for (i, j), chi2 in zip(before.edges[off].tolist(), solution.chi_squared[off].tolist(), strict=True)
        ],
    }
    if truth is not None:
        figures["rmse_before"] = position_rmse(before.poses, truth)
        figures["rmse"] = position_rmse(solution.graph.poses, truth)
    return figures


def _format(figures: dict[str, Any]) -> str:
    off = figures["switched_off"]
    lines = [
        f"nodes         {figures['nodes']}",
        f"edges         {figures['edges']}, {figures['closures']} of them closures",
        f"iterations    {figures['iterations']}{'' if figures['converged'] else ', where it was cut short'}",
        f"chi2          {figures['chi2_before']:.6g} before, {figures['chi2']:.6g} after",
        f"of believed   {figures['chi2_believed_before']:.6g} before, {figures['chi2_believed']:.6g} after",
        f"switched off  {len(off)} of {figures['closures']}",
        *(f"  {edge['i']} -> {edge['j']}  chi2 {edge['chi2']:.6g}" for edge in off[:_LISTED]),
    ]
    if len(off) > _LISTED:
        lines.append(f"  and {len(off) - _LISTED} more, which --json prints")
    if "rmse" in figures:
        lines.append(f"RMSE          {figures['rmse_before']:.4f} m before, {figures['rmse']:.4f} m after")
    return "\n".join(lines)


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort graph",
        epilog="Example: oort graph solve graph.g2o solved.g2o",
        description="Solves pose graphs in the format of g2o or TORO.",
    )
    solve = parser.add_subparsers(dest="command", required=True).add_parser("solve", help="solve one")
    solve.add_argument(
        "graph", metavar="IN.g2o", help="VERTEX_SE2 and EDGE_SE2 lines (g2o), or VERTEX2 and EDGE2 (TORO)"
    )
    solve.add_argument("out", metavar="OUT.g2o", help="the solved poses, with the edges that are believed")
    solve.add_argument(
        "--method",
        choices=METHODS,
        default="decide",
        help="; ".join(f"{name}: {what}" for name, what in METHODS.items()).replace("%", "%%") + " (default decide)",
    )
    solve.add_argument(
        "--scale", type=float, default=2.0, metavar="PHI", help="chi2 at which a closure is half off (default 2)"
    )
    solve.add_argument("--truth", metavar="FILE", help="the true poses: a .g2o file, or lines x y theta")
    add_json_argument(solve)
    return parser


def _run(arguments: argparse.Namespace) -> None:
    graph = read_g2o(arguments.graph)
    truth = read_truth(arguments.truth, graph) if arguments.truth else None
    solution = solve_graph(graph, arguments.method, arguments.scale)
    kept = solution.believed
    solved = solution.graph
    write_g2o(
        arguments.out,
        replace(
            solved,
            edges=solved.edges[kept],
            measurements=solved.measurements[kept],
            covariances=solved.covariances[kept],
        ),
    )
    figures = _figures(graph, solution, truth)
    print_result(arguments, figures, _format(figures))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    arguments = _parser().parse_args(argv)
    return run_tool("oort graph", lambda: _run(arguments), arguments.graph)
