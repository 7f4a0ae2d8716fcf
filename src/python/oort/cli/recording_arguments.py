# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a command line says which recording to open, and how."""

import argparse

from oort._core import Parameters
from oort.cli.tool import add_pose_argument
from oort.recording.open import open_recording
from oort.recording.types import Recording


def add_recording_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of open_recording(); the recording itself is to be an argument called ``input``."""
    parser.add_argument(
        "--scan-topic",
        metavar="TOPIC",
        action="append",
        help="which LaserScan topic of a bag; once for each of several lasers",
    )
    parser.add_argument("--odom-frame", metavar="FRAME", help="a bag's odometry frame, where it is not called odom")
    parser.add_argument(
        "--imu-topic", metavar="TOPIC", help="a bag's IMU: its gyro takes the place of odometry's turns"
    )
    parser.add_argument("--scan-frame", metavar="FRAME", help="which laser, where a topic has the scans of several")
    add_pose_argument(
        parser, "--mount", "where the laser sits on the base [m, rad], where the recording does not tell or tells wrong"
    )
    parser.add_argument("--min-range", type=float, metavar="M", help="readings below this are no return")
    parser.add_argument("--max-range", type=float, metavar="M", help="readings beyond this are no return")
    parser.add_argument(
        "--mask",
        type=float,
        nargs=2,
        action="append",
        default=[],
        metavar=("FROM", "TO"),
        help="no return counts from one bearing of the laser counter-clockwise to another [rad]; may be repeated",
    )


def recording_of(args: argparse.Namespace, parameters: Parameters) -> Recording:
    """Opens what the arguments name. Raises what open_recording() raises."""
    return open_recording(
        args.input,
        scan_topic=args.scan_topic,
        odom_frame=args.odom_frame,
        imu_topic=args.imu_topic,
        scan_frame=args.scan_frame,
        mount=tuple(args.mount) if args.mount else None,
        min_range=args.min_range,
        max_range=args.max_range,
        masks=[(begin, end) for begin, end in args.mask],
        parameters=parameters,
    )
