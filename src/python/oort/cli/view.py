# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort view INPUT``: shows a recording as it is mapped, or a saved map, on a page."""

import argparse
import math
import os
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from oort._core import Parameters, normalise_map_path
from oort.cli.recording_arguments import add_recording_arguments, recording_of
from oort.cli.tool import FAULT, Parser, add_json_argument, parse_arguments, print_result, run_tool
from oort.errors import InputError, OortError
from oort.live import Listener, LiveSession
from oort.offline.info import is_saved_map
from oort.parameters import read_parameters
from oort.recording import Recording
from oort.view import PORT, Viewer
from oort.view.player import play

_EXAMPLE = "Example: oort view drive.bag --speed 20, then open the address that it prints."


_LOOK = 0.5  # [s] between looks whether mapping goes on
_LAST_WORDS = 5.0  # [s] that the page still says why it does not


class _Teller(Listener):
    """Says on standard error what nobody waits to hear of."""

    def trouble(self, text: str) -> None:
        print(f"oort view: {text}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort view",
        description="Shows a recording as it is mapped, or a saved map, on a page for the browser: the map as it "
        f"grows, the robot, the queue, how long things take. Ends with Ctrl-C or SIGTERM. {_EXAMPLE}",
    )
    parser.add_argument("input", nargs="+", help="a recording, as for oort replay, or the path of a saved map")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    add_recording_arguments(parser)
    parser.add_argument(
        "--speed",
        type=float,
        default=10.0,
        metavar="N",
        help="times as fast as recorded, inf: all it can (default: 10)",
    )
    parser.add_argument("--map", metavar="BASE", help="save the map of a recording at this path (default: nowhere)")
    parser.add_argument("--port", type=int, default=PORT, metavar="N", help=f"of the page (default: {PORT})")
    parser.add_argument(
        "--address",
        default="127.0.0.1",
        metavar="ADDRESS",
        help="where to listen (default: 127.0.0.1, for this machine alone; for others to look, 0.0.0.0: the address "
        "printed then holds a token, which OORT_VIEW_TOKEN may set)",
    )
    parser.add_argument("--control", action="store_true", help="let the page make calls: pause, docked, places, stop")
    add_json_argument(parser)
    return parser


def _recording(args: argparse.Namespace, parameters: Parameters) -> Recording | None:
    """The recording that is named, or None for a saved map."""
    if len(args.input) == 1 and is_saved_map(args.input[0]):
        return None
    recording = recording_of(args, parameters)
    if recording.without_odometry:
        parameters.set("use_odometry", False)
    for note in recording.notes:
        print(f"note: {note}", file=sys.stderr)
    return recording


def _run(args: argparse.Namespace) -> int:
    if not args.speed > 0.0 or math.isnan(args.speed):
        raise InputError(f"--speed {args.speed:g}: it must be above 0")
    parameters = read_parameters(args.params)
    recording = _recording(args, parameters)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends as by Ctrl-C, which a script's job may not hear
    live = LiveSession(parameters, _Teller())
    try:
        title = Path(args.input[0]).name if recording is None else recording.name
        with Viewer(live, title=title, address=args.address, port=args.port, control=args.control) as viewer:
            print_result(args, {"url": viewer.url}, f"open {viewer.url}")
            if recording is None:
                live.call("map/load", [os.path.abspath(normalise_map_path(args.input[0]))])
            else:
                _play(recording, live, args, viewer)
            while not live.failure:
                time.sleep(_LOOK)
            time.sleep(_LAST_WORDS)
    except KeyboardInterrupt:
        pass
    except OortError:
        if not live.failure:
            raise
        time.sleep(_LAST_WORDS)
    finally:
        live.close()
    return FAULT if live.failure else 0


def _play(recording: Recording, live: LiveSession, args: argparse.Namespace, viewer: Viewer) -> None:
    path = os.path.abspath(args.map) if args.map else ""
    play(recording, live, args.speed, path, viewer.watch.tell_progress)
    if not args.json:
        print(f"{recording.name} is mapped; the page stays until Ctrl-C", flush=True)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0 after Ctrl-C, or that of run_tool()."""
    args = parse_arguments(_parser(), argv)
    return run_tool("oort view", lambda: _run(args), args.input[0])
