# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Which parameters a search may change, and between which values."""

import math
from dataclasses import dataclass

from oort._core import ParameterEntry, Parameters, parameter_table, unknown_parameter
from oort.errors import ParameterError

Value = bool | int | float | str

_FACTOR = 4.0
"""A number is searched between its start over and times this, unless bounds are given: enough to find a better one, and
not so much that a search of some dozen trials gets lost."""


@dataclass(frozen=True)
class Axis:
    """One parameter and its values: numbers from low to high, or choices."""

    path: str
    low: float = 0.0
    high: float = 0.0
    whole: bool = False
    logarithmic: bool = False
    choices: tuple[Value, ...] = ()


def parse_axis(text: str, start: Parameters) -> Axis:
    """An axis of KEY, KEY=LOW..HIGH or KEY=ONE,OTHER. Raises ParameterError."""
    path, _, values = text.partition("=")
    entry = next((entry for entry in parameter_table() if entry.path == path), None)
    if entry is None:
        raise ParameterError(
            unknown_parameter(path.encode(errors="replace").decode())
        )  # a terminal's bytes may be no text
    if entry.type in ("bool", "string"):
        return _choices(entry, values)
    whole = entry.type == "integer"
    low, high = _bounds(entry, values, float(start.get(path)))
    if whole and math.floor(high) < math.ceil(low):
        raise ParameterError(f"{path}={values}: there is no whole number between the bounds")
    return Axis(path, low, high, whole, logarithmic=low > 0.0 and high / low >= _FACTOR)


def _choices(entry: ParameterEntry, values: str) -> Axis:
    allowed: dict[str, Value] = {choice: choice for choice in entry.choices}
    if entry.type == "bool":
        allowed = {"true": True, "false": False}
    chosen = values.split(",") if values else list(allowed)
    if len(chosen) < 2 or not all(choice in allowed for choice in chosen):
        raise ParameterError(f"{entry.path}: to search it takes two or more of {', '.join(allowed)}, not {values!r}")
    return Axis(entry.path, choices=tuple(allowed[choice] for choice in chosen))


def _bounds(entry: ParameterEntry, values: str, start: float) -> tuple[float, float]:
    least = -float("inf") if entry.min is None else entry.min
    most = float("inf") if entry.max is None else entry.max
    if not values:
        if start <= 0.0:
            raise ParameterError(
                f"{entry.path} is {start:g}: say between which values to search, {entry.path}=LOW..HIGH"
            )
        return max(least, start / _FACTOR), min(most, start * _FACTOR)
    first, _, last = values.partition("..")
    try:
        low, high = float(first), float(last)
    except ValueError as error:
        raise ParameterError(f"{entry.path}={values}: bounds are two numbers, LOW..HIGH") from error
    if not least <= low < high <= most or not math.isfinite(high - low):
        raise ParameterError(f"{entry.path}={values}: bounds must grow and lie within {least:g} to {most:g}")
    return low, high
