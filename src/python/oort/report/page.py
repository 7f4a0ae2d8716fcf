# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""report.html: one file that opens from disk without a network, with all that there is to see of a run."""

import html
import json
import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from oort.errors import InputError

_STYLES = ("vendor/leaflet.css", "vendor/uplot.css", "page.css")
_LIBRARIES = ("vendor/leaflet.js", "vendor/uplot.js")
_DATA = '<script type="application/json" id="oort-data">'
_END = "</script>"


def make_page(body: str, scripts: Sequence[str], title: str, data: Mapping[str, Any]) -> bytes:
    """A page with a body of ``web/``, and styles, libraries, scripts and data within."""
    parts = {
        "body": asset(body),
        "title": html.escape(title),
        "styles": "\n".join(asset(name) for name in _STYLES),
        "data": f"{_DATA}{_json(data)}{_END}",
        "scripts": "\n".join(f"<script>\n{asset(name)}\n{_END}" for name in (*_LIBRARIES, *scripts)),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], asset("page.html")).encode()


def make_report_page(title: str, data: Mapping[str, Any]) -> bytes:
    """The page of one run."""
    return make_page("report.html", ("data.js", "map.js", "timeline.js", "closures.js", "report.js"), title, data)


def read_page_data(path: Path) -> dict[str, Any]:
    """The data of a page that make_report_page() made. Raises InputError for any other file."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is no text"
        raise InputError(f"{path} cannot be read: {why}; name a report.html, or the folder of a replay") from None
    start = text.find(_DATA)
    try:
        data = json.loads(text[start + len(_DATA) : text.index(_END, start)]) if start >= 0 else None
    except ValueError:
        data = None
    if not isinstance(data, dict) or "page_version" not in data:
        raise InputError(f"{path} is no report of a replay; name a report.html that this version of Oort wrote")
    return data


def _json(data: Mapping[str, Any]) -> str:
    """JSON that cannot end the script around it, whatever names hold; nan as null."""
    text = json.dumps(_finite(data), ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    if isinstance(value, float) and (value != value or value in (float("inf"), float("-inf"))):
        return None
    return value


def asset(name: str) -> str:
    """A file of ``web/`` as text."""
    text = (files("oort.report") / "web" / name).read_text(encoding="utf-8")
    # Pictures and behaviours of old browsers, which nothing on the page uses, would be looked for beside it.
    return re.sub(r"^.*url\(.*\);\n", "", text, flags=re.M) if name.endswith(".css") else text
