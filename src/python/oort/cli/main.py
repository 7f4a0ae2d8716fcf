# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The command ``oort``: one word for each tool."""

import difflib
import importlib
import sys
from collections.abc import Sequence

from oort._core import __version__

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

_USAGE = "\n".join(
    [
        "usage: oort TOOL ...",
        *(f"  {name:<11}{what}" for name, what in TOOLS.items()),
        "oort TOOL --help tells the options of one, with an example; oort --version the version",
    ]
)


def main(argv: Sequence[str] | None = None) -> int:
    """Runs one tool; exit code 2 for a wrong call."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    word = arguments[0] if arguments else ""
    if word in ("-h", "--help"):
        print(_USAGE)
        return 0
    if word == "--version":
        print(f"oort {__version__}")
        return 0
    if word not in TOOLS:
        near = difflib.get_close_matches(word, TOOLS, 1)
        meant = f"; perhaps {near[0]} is meant" if near else ""
        print(f"oort: there is no tool {word!r}{meant}; oort --help lists them" if word else _USAGE, file=sys.stderr)
        return 2
    module = importlib.import_module(f"oort.cli.{arguments[0]}")
    result: int = module.main(arguments[1:])
    return result
