# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Compares trajectories with the truth: `python -m oort.evaluate relations TRAJ FILE` and `... ate TRAJ TRUTH`.

`... autogenerate MAP FILE` makes relations from a solved map. Trajectories are of the robot's base, in the TUM format.
"""

import argparse
from collections.abc import Sequence
from dataclasses import asdict

from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, print_result, run_tool
from oort.evaluation.ground_truth import RelationLimits, autogenerate_relations, write_relations
from oort.evaluation.trajectories import AteResult, RelationsResult, evaluate_ate, evaluate_relations
from oort.export import read_tum
from oort.saved_maps import open_map


def _format(result: RelationsResult | AteResult) -> str:
    """The result as a few lines for people."""
    if isinstance(result, AteResult):
        return (
            f"poses        {result.n} ({result.missing} without truth)\n"
            f"position     rmse {result.position_rmse:.4f} m  max {result.position_max:.4f} m\n"
            f"heading      rmse {result.heading_rmse:.4f} deg"
        )
    r = result
    return (
        f"relations    {r.n} ({r.missing} missing)\n"
        f"translation  mean {r.translation_mean:.4f} m  std {r.translation_std:.4f} m  max {r.translation_max:.4f} m\n"
        f"rotation     mean {r.rotation_mean:.4f} deg  std {r.rotation_std:.4f} deg  max {r.rotation_max:.4f} deg\n"
        f"squared      mean {r.squared_translation_mean:.6f} m^2  std {r.squared_translation_std:.6f} m^2\n"
        f"squared      mean {r.squared_rotation_mean:.4f} deg^2  std {r.squared_rotation_std:.4f} deg^2"
    )


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort evaluate",
        epilog="Example: oort evaluate ate trajectory.tum truth.tum",
        description="Compares trajectories with the truth.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    relations = commands.add_parser("relations", help="errors of relative poses (Kuemmerle et al. 2009)")
    ate = commands.add_parser("ate", help="errors of poses after the best rigid alignment")
    for command in (relations, ate):
        command.add_argument("trajectory", metavar="TRAJ", help="the trajectory of the robot's base, in the TUM format")
    relations.add_argument("reference", metavar="FILE", help="lines t1 t2 x y z roll pitch yaw")
    relations.add_argument("--max-seconds", type=float, help="only relations over less than this time [s]")
    ate.add_argument("reference", metavar="TRUTH", help="the true trajectory, in the TUM format")
    autogenerate = commands.add_parser("autogenerate", help="relations from the closures of a solved map")
    _add_limits(autogenerate)
    for command in (relations, ate, autogenerate):
        add_json_argument(command)
    return parser


def _add_limits(command: argparse.ArgumentParser) -> None:
    """The arguments of autogenerate."""
    limits = RelationLimits()
    command.add_argument("map", metavar="MAP", help="the saved map's path")
    command.add_argument("reference", metavar="FILE", help="where the relations go")
    command.add_argument(
        "--min-covered-distance",
        type=float,
        default=limits.min_covered_distance,
        metavar="M",
        help="least way driven between the ends of a closure [m] (default %(default)s)",
    )
    command.add_argument(
        "--outlier-threshold-meters",
        type=float,
        default=limits.outlier_threshold_meters,
        metavar="M",
        help="closures farther from the solution are left out (default %(default)s)",
    )
    command.add_argument(
        "--outlier-threshold-radians",
        type=float,
        default=limits.outlier_threshold_radians,
        metavar="RAD",
        help="likewise (default %(default)s)",
    )
    command.add_argument(
        "--sensor-on-base",
        type=float,
        nargs=3,
        default=(0.0, 0.0, 0.0),
        metavar=("X", "Y", "THETA"),
        help="where the sensor sits on the base [m, rad] (default: at its origin)",
    )
    add_checksum_argument(command)


def _autogenerate(arguments: argparse.Namespace) -> None:
    """Writes the relations that the command line asks for, and tells of them. Raises OortError."""
    limits = RelationLimits(
        arguments.min_covered_distance, arguments.outlier_threshold_meters, arguments.outlier_threshold_radians
    )
    map_ = open_map(arguments.map, ignore_checksum=arguments.ignore_checksum)
    truth = autogenerate_relations(map_, arguments.sensor_on_base, limits)
    write_relations(arguments.reference, truth.relations)
    left_out = {
        "switched_off": truth.switched_off,
        "too_short": truth.too_short,
        "outliers": truth.outliers,
        "repeated": truth.repeated,
    }
    listed = "  ".join(f"{count} {reason.replace('_', ' ')}" for reason, count in left_out.items())
    print_result(
        arguments,
        {"relations": len(truth.relations), "closures": truth.closures, "left_out": left_out},
        f"relations    {len(truth.relations)} of {truth.closures} closures\nleft out     {listed}",
    )


def _compare(arguments: argparse.Namespace) -> RelationsResult | AteResult:
    trajectory = read_tum(arguments.trajectory)
    if arguments.command == "relations":
        return evaluate_relations(trajectory, arguments.reference, max_seconds=arguments.max_seconds)
    return evaluate_ate(trajectory, read_tum(arguments.reference))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    arguments = _parser().parse_args(argv)
    return run_tool("oort evaluate", lambda: _run(arguments), arguments.reference)


def _run(arguments: argparse.Namespace) -> None:
    if arguments.command == "autogenerate":
        _autogenerate(arguments)
        return
    result = _compare(arguments)
    print_result(arguments, asdict(result), _format(result))
