# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads params.json, and finds the files that Oort ships."""

import os
import warnings
from pathlib import Path
from typing import Any

from oort import _core
from oort._core import Parameters, parameter_table
from oort.errors import ParameterError

PRESETS = ("params", "kuri_original", "cartographer")
"""The files that Oort ships: the defaults, the documented values, and Cartographer's matchers."""


def read_parameters(path: str | os.PathLike[str] | None = None) -> Parameters:
    """Reads a file; without a path, the packaged defaults.

    The file is strict JSON, or takes these liberties: comments from ``#``, ``//`` or a stray ``$`` to the end of the
    line, a missing comma between members, a comma after the last one, and a key given twice: the last one counts, and
    a UserWarning says so. Keys that it does not give have their defaults.

    Raises:
        ParameterError: the file cannot be read, or a key is unknown or its value not allowed. The message names the
            file, the line, the key's full path and, for an unknown key, the known key nearest to it.
    """
    parameters, notes = _core.read_parameters(str(packaged_path() if path is None else path))
    for note in [*notes, *missing_viewers(parameters)]:
        warnings.warn(note, stacklevel=2)
    return parameters


def missing_viewers(parameters: Parameters) -> list[str]:
    """A sentence for each of the original's viewers that is switched on: they are not there."""
    switches = [entry.path for entry in parameter_table() if entry.path.endswith(".debug")]
    return [
        f"{path}: the original's viewer is not there, so the key has no effect; oort view shows the map as it grows"
        for path in switches
        if parameters.get(path)
    ]


def packaged_path(name: str = "params") -> Path:
    """The path of a shipped file: ``params`` (the defaults), ``kuri_original`` (the documented values) or
    ``cartographer`` (the defaults with Cartographer's matchers)."""
    if name not in PRESETS:
        raise ParameterError(f'there are no packaged parameters "{name}"; there are {" and ".join(PRESETS)}')
    package = Path(__file__).resolve().parents[1]
    # Beside the modules once installed; in a checkout, and so in an editable install, in the root of the project.
    folders = [package / "params", package.parents[2] / "params"]
    for folder in folders:
        if (folder / f"{name}.json").is_file():
            return folder / f"{name}.json"
    raise ParameterError(f"{name}.json is in none of {', '.join(map(str, folders))}; install Oort again")


def packaged_parameters(name: str = "params") -> Parameters:
    """Reads a shipped file: ``params`` (the defaults), ``kuri_original`` (the documented values) or
    ``cartographer`` (the defaults with Cartographer's matchers)."""
    return read_parameters(packaged_path(name))


def set_parameter(parameters: Parameters, path: str, value: Any) -> None:
    """Sets a parameter; 3.0 counts as 3 where a whole number is meant, as programs that write JSON or YAML have it.

    Raises ParameterError.
    """
    whole = isinstance(value, float) and value.is_integer() and type(parameters.get(path)) is int
    parameters.set(path, int(value) if whole else value)
