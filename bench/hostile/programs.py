# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that use the library wrongly: ``programs.py NAME INPUTS FOLDER`` runs one; a failed assertion is a fault."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from hostile import input, places, values

_MAP = "use_"


def program(name: str) -> Callable[[Path], str]:
    """The program of a case: it takes the folder of inputs, and says what became of it."""
    if name.startswith(_MAP):
        return lambda inputs: places.use_map(str(inputs / name.removeprefix(_MAP) / "x"))
    for module in (input, places, values):
        if hasattr(module, name):
            found: Callable[[Path], str] = getattr(module, name)
            return found
    raise LookupError(name)


if __name__ == "__main__":
    os.chdir(sys.argv[3])
    print(program(sys.argv[1])(Path(sys.argv[2])))
