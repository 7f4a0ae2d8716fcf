# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Lists the links of the documents that lead elsewhere, each with its pages. Tests check only that they can be links.

.venv/bin/python scripts/external_links.py | cut -f1 | xargs -n1 curl -sSfIL -o /dev/null    # where there is a network
"""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_LINK = re.compile(r"\]\((\w+:[^)\s]*)\)|<(https?:[^>]*)>")


def external_links() -> dict[str, list[str]]:
    """The pages that each leads from."""
    found: dict[str, list[str]] = {}
    for page in sorted(
        [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("bench/*.md"), *ROOT.glob("examples/*.md")]
    ):
        for match in _LINK.finditer(page.read_text(encoding="utf-8")):
            found.setdefault(match[1] or match[2], []).append(str(page.relative_to(ROOT)))
    return found


if __name__ == "__main__":
    for link, pages in sorted(external_links().items()):
        print(f"{link}\t{', '.join(dict.fromkeys(pages))}")
