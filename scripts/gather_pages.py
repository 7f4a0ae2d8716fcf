# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Gathers the pages of the documentation, with what they link to, in the tree that they have here.

python scripts/gather_pages.py FOLDER
"""

import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_LINK = re.compile(r"\]\(([^)#\s]+)")


def gather(folder: Path) -> None:
    """Copies README.md, docs/ and all that can be reached from there by links to files."""
    shutil.rmtree(folder, ignore_errors=True)
    waiting, known = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))], set[Path]()
    while waiting:
        path = waiting.pop()
        if path in known or not path.is_file() or ROOT not in path.parents:
            continue
        known.add(path)
        copy = folder / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, copy)
        if path.suffix == ".md":
            links = _LINK.findall(path.read_text(encoding="utf-8"))
            waiting += [(path.parent / link).resolve() for link in links if "://" not in link]


if __name__ == "__main__":
    gather(Path(sys.argv[1]))
