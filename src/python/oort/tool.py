# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How every command line tool ends."""

import sys
from collections.abc import Callable

from oort.errors import OortError


def run_tool(name: str, run: Callable[[], None], reading: str = "") -> int:
    """Runs a tool; the exit status is 0, or 2 for an error, which is printed without a traceback.

    ``reading`` is the file that an error of the operating system is about if it names none.
    """
    try:
        run()
    except OortError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{name}: {error.filename or reading}: {error.strerror}", file=sys.stderr)
        return 2
    return 0
