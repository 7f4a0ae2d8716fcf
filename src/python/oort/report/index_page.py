# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""index.html of a batch: a table of the drives with their pictures, each row leading to the drive's report."""

import html
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from oort.report.page import asset

_COLUMNS = (
    ("scans", "scans", "{:d}"),
    ("nodes", "nodes", "{:d}"),
    ("closures", "loop closures", "{:d}"),
    ("uncertain", "uncertain or lost", "{:.1%}"),
    ("recorded_seconds", "recorded [s]", "{:.0f}"),
    ("cpu_seconds", "CPU [s]", "{:.1f}"),
    ("worst_ms", "worst scan [ms]", "{:.1f}"),
)


def make_index_page(rows: Sequence[Mapping[str, Any]]) -> bytes:
    """A page of rows with ``name`` (of the folder beside the page), ``error`` (or None) and ``figures``."""
    failed = sum(row["error"] is not None for row in rows)
    head = "".join(f"<th>{title}</th>" for _, title, _ in _COLUMNS)
    body = "\n".join(_row(row) for row in rows)
    told = f"{len(rows)} recordings, {failed} of them could not be mapped" if failed else f"{len(rows)} recordings"
    page = f"""<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>Oort: {told}</title><link rel="icon" href="data:,">
<style>
{asset("page.css")}
td img {{ max-width: 160px; max-height: 110px; display: block; }}
.failed {{ color: #b91c1c; }}
</style></head>
<body><header><h1>{told}</h1></header><main><section>
<table><tr><th>map</th><th>recording</th>{head}</tr>
{body}
</table></section></main></body></html>
"""
    return page.encode()


def _row(row: Mapping[str, Any]) -> str:
    name, link = html.escape(row["name"]), quote(row["name"])
    if row["error"] is not None:
        told = f'<td class="failed" colspan="{len(_COLUMNS)}">{html.escape(row["error"])}</td>'
        return f"<tr><td></td><th>{name}</th>{told}</tr>"
    picture = f'<a href="{link}/report.html"><img loading="lazy" src="{link}/map.png" alt="map of {name}"></a>'
    cells = "".join(f"<td>{form.format(row['figures'][key])}</td>" for key, _, form in _COLUMNS)
    return f'<tr><td>{picture}</td><th><a href="{link}/report.html">{name}</a></th>{cells}</tr>'
