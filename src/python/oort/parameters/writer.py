# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes what is made from the table of parameters: the shipped files and docs/parameters.md."""

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from oort._core import ParameterEntry, parameter_table

_HEADER = """<!-- SPDX-FileCopyrightText: 2026 The Oort authors -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
<!-- Written by `python -m oort.parameters write .` from the table in src/cpp/oort/parameters: do not edit. -->
# Parameters

`params/params.json` holds the defaults, `params/kuri_original.json` the documented values, and
`params/cartographer.json` the defaults with Cartographer's matchers ([matchers.md](matchers.md)) and the time of its
motion filter. A file of your own needs only the keys that differ from the defaults. It may be strict JSON, or have
comments (`#`, `//`), a comma too few between members or one after the last. A key given twice is a warning and the last
one counts; an unknown key, a value of the wrong type or out of its range is an error that names the file, the line and
the key.

A dot stands for a section: `output_map.robot_radius` is `{"output_map": {"robot_radius": 0.15}}`.
"""
_CARTOGRAPHER: dict[str, bool | int | float | str] = {
    "incremental_graph_builder.scanmatcher": "cartographer_matcher",
    "loop_closure_graph_builder.scanmatcher": "branch_and_bound_matcher",
    "time_update": 5.0,
}
"""What params/cartographer.json chooses."""


def files() -> dict[str, str]:
    """The content of each file by its path in the project."""
    table = parameter_table()
    defaults = {entry.path: entry.default for entry in table}
    return {
        "params/params.json": to_json(defaults),
        "params/cartographer.json": to_json(defaults | _CARTOGRAPHER),
        "params/kuri_original.json": to_json({entry.path: entry.documented for entry in table}),
        "docs/parameters.md": documentation(table),
    }


def write(root: Path) -> list[Path]:
    """Writes the files below the root of the project; returns their paths."""
    written = []
    for name, content in files().items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
        written.append(path)
    return written


def to_json(values: Mapping[str, bool | int | float | str]) -> str:
    """Values by their paths as the text of a params.json."""
    root: dict[str, Any] = {}
    for path, value in values.items():
        *sections, key = path.split(".")
        section = root
        for name in sections:
            section = section.setdefault(name, {})
        section[key] = value
    return json.dumps(root, indent=2) + "\n"


def documentation(table: Iterable[ParameterEntry]) -> str:
    """The page: the keys that have an effect, those that have none, and where defaults differ from the documented."""
    entries = list(table)
    parts = [_HEADER]
    sections: dict[str, list[ParameterEntry]] = {}
    for entry in entries:
        if entry.status == "used":
            sections.setdefault(entry.path.rpartition(".")[0], []).append(entry)
    for section, members in sections.items():
        parts.append(f"\n## {section or 'At the top'}\n\n")
        parts.extend(_key_table(members))
    parts.append("\n## Keys without effect\n\n")
    parts.append("Kept for files of the original Oort: read and checked, so that they can be used as they are.\n")
    parts.append("The viewers that some are for are not there.\n\n")
    parts.extend(_effectless_table(entry for entry in entries if entry.status != "used"))
    parts.append("\n## Where the defaults differ from the documented values\n\n")
    parts.extend(_difference_table(entry for entry in entries if entry.default != entry.documented))
    return "".join(parts)


def _key_table(entries: Iterable[ParameterEntry]) -> Iterator[str]:
    yield _row("key", "default", "unit", "range", "meaning") + _row(*["---"] * 5)
    for entry in entries:
        key = entry.path.rpartition(".")[2]
        yield _row(f"`{key}`", _code(entry.default), entry.unit, _range(entry), entry.meaning)


def _effectless_table(entries: Iterable[ParameterEntry]) -> Iterator[str]:
    yield _row("key", "default", "unit", "range", "meaning") + _row(*["---"] * 5)
    for entry in entries:
        yield _row(f"`{entry.path}`", _code(entry.default), entry.unit, _range(entry), entry.meaning)


def _difference_table(entries: Iterable[ParameterEntry]) -> Iterator[str]:
    yield _row("key", "default", "documented", "unit", "reason") + _row(*["---"] * 5)
    for entry in entries:
        documented = _code(entry.documented)
        if entry.own:
            documented += " (the key is new: this gives the documented behaviour)"
        yield _row(f"`{entry.path}`", _code(entry.default), documented, entry.unit, entry.reason)


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |\n"


def _code(value: object) -> str:
    return f"`{json.dumps(value)}`"


def _range(entry: ParameterEntry) -> str:
    if entry.min is not None and entry.max is not None:
        return f"{'integer ' if entry.type == 'integer' else ''}{entry.min:.9g} to {entry.max:.9g}"
    if entry.type == "bool":
        return "true, false"
    return ", ".join(entry.choices) or "text"
