# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Lays two runs side by side."""

from pathlib import Path
from typing import Any

from oort.errors import InputError
from oort.export.files import make_folder, write_atomically
from oort.report.arrays import unpack
from oort.report.compare_page import compare_page_data, make_compare_page
from oort.report.page import read_page_data

_REPORT = "report.html"


def compare(a: str, b: str, out: str) -> dict[str, Any]:
    """Writes a page that lays two replays side by side and over each other; returns what differs.

    ``a`` and ``b`` are folders of replays or their report.html. Raises InputError for anything else, OortError if the
    page cannot be written.
    """
    paths = [_report_of(Path(path)) for path in (a, b)]
    make_folder(Path(out).parent)
    data_a, data_b = (read_page_data(path) for path in paths)
    names = [_name(path) for path in paths]
    if names[0] == names[1]:
        names = [str(path) for path in paths]
    data = compare_page_data(data_a, data_b, (names[0], names[1]))
    write_atomically(Path(out), make_compare_page(data))
    apart = unpack(data["apart"]["distance"])
    return {
        "names": names,
        "figures": {name: each for name, *each in data["figures"]},
        "parameters": {name: each for name, *each in data["parameters"]},
        "apart": {"mean": float(apart.mean()), "max": float(apart.max())} if len(apart) else None,
        "written": [out],
    }


def _report_of(path: Path) -> Path:
    if path.is_dir():
        return path / _REPORT
    if not path.exists() and (path.parent / _REPORT).is_file():
        raise InputError(f"{path} is no replay's folder, but {path.parent} is one: give that")
    return path


def _name(path: Path) -> str:
    return path.absolute().parent.name if path.name == _REPORT else path.stem
