# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The command ``oort``: one word for each tool."""

import importlib
import sys
from collections.abc import Sequence

TOOLS = {
    "replay": "map a recorded drive",
    "batch": "map many recordings in parallel",
    "tune": "search parameters with which recordings map better",
    "view": "show a recording as it is mapped, or a saved map, on a page",
    "check": "say what is wrong with a recording or a robot's setup",
    "info": "say what a saved map or a recording is",
    "localize": "follow a recorded drive on a saved map",
    "render": "draw a saved map as pictures for map_server",
    "export": "write a saved map in the formats of other programs",
    "rooms": "list the rooms of a saved map with their areas, and name them",
    "areas": "list, add and remove areas where the robot shall not go",
    "compare": "lay two replays side by side",
    "merge": "join two saved maps of the same home",
    "simulate": "make up a home and a drive through it",
    "evaluate": "compare a trajectory with what is known to be true",
    "graph": "solve a pose graph in the format of g2o or TORO",
    "prune": "write a saved map with only the views that it needs",
    "history": "list the earlier versions of a saved map, or go back to one",
    "migrate": "write a saved map in the newest format",
    "parameters": "print the table of parameters",
    "completion": "print what makes a shell complete all these",
}
"""what each is for"""


def main(argv: Sequence[str] | None = None) -> int:
    """Runs one tool; exit code 2 for a wrong call."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if not arguments or arguments[0] not in TOOLS:
        stream = sys.stdout if arguments[:1] in (["-h"], ["--help"]) else sys.stderr
        print("usage: oort TOOL ...", *(f"  {name:<11}{what}" for name, what in TOOLS.items()), sep="\n", file=stream)
        return 0 if stream is sys.stdout else 2
    module = importlib.import_module(f"oort.cli.{arguments[0]}")
    result: int = module.main(arguments[1:])
    return result
