# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads params.json into the engine's Parameters."""

import difflib
import warnings
from pathlib import Path
from typing import Any

from oort._core import Parameters, parameter_table
from oort.errors import ParameterError
from oort.parameters.relaxed_json import Section, parse

PRESETS = ("params", "kuri_original", "cartographer")
"""The files that Oort ships: the defaults, and the documented values."""


def read_parameters(path: str | Path | None = None) -> Parameters:
    """Reads a file; without a path, the packaged defaults.

    The file is strict JSON or takes the liberties that ``relaxed_json`` lists. Keys that it does not give have their
    defaults. A key given twice is a UserWarning.

    Raises:
        ParameterError: the file cannot be read, or a key is unknown or its value not allowed. The message names the
            file, the line, the key's full path and, for an unknown key, the known key nearest to it.
    """
    source = packaged_path() if path is None else Path(path)
    try:
        text = source.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise ParameterError(f"cannot read the parameters {source}: {error}") from error
    section, duplicates = parse(text, str(source))
    for message in duplicates:
        warnings.warn(message, stacklevel=2)
    return _Reader(str(source)).read(section)


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


class _Reader:
    def __init__(self, source: str) -> None:
        self._source = source
        self._parameters = Parameters()
        self._types = {entry.path: entry.type for entry in parameter_table()}
        self._sections = {path[:i] for path in self._types for i, letter in enumerate(path) if letter == "."}

    def read(self, section: Section) -> Parameters:
        self._apply(section, "")
        try:
            self._parameters.check()
        except ParameterError as error:
            raise ParameterError(f"{self._source}: {error}") from None
        return self._parameters

    def _apply(self, section: Section, prefix: str) -> None:
        for key, member in section.items():
            path = prefix + key
            try:
                if "." in key or (path not in self._types and path not in self._sections):
                    raise ParameterError(unknown_parameter(path))
                if isinstance(member.value, dict) and path in self._types:
                    raise ParameterError(f"{path}: takes one value ({self._types[path]}), not a section {{ }}")
                if not isinstance(member.value, dict):
                    if path in self._sections:
                        raise ParameterError(f"{path}: is a section; it takes {{ }}, not {member.value!r}")
                    set_parameter(self._parameters, path, member.value)
            except ParameterError as error:
                raise ParameterError(f"{self._source}:{member.line}: {error}") from None
            if isinstance(member.value, dict):
                self._apply(member.value, path + ".")


def set_parameter(parameters: Parameters, path: str, value: Any) -> None:
    """Sets a parameter; 3.0 counts as 3 where a whole number is meant, as programs that write JSON or YAML have it.

    Raises ParameterError.
    """
    whole = isinstance(value, float) and value.is_integer() and type(parameters.get(path)) is int
    parameters.set(path, int(value) if whole else value)


def unknown_parameter(path: str) -> str:
    """The message for a path that is in no table, with the nearest one that is."""
    known = {entry.path: None for entry in parameter_table()}
    known.update((path[:i], None) for path in list(known) for i, letter in enumerate(path) if letter == ".")
    nearest = difflib.get_close_matches(path, known, n=1, cutoff=0.0)[0]
    return f'unknown parameter "{path}"; the nearest known is "{nearest}"'
