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
_NAMED_AS_FILE = re.compile(r"\[[\w/]+\.md\]\((?P<target>[\w./-]+\.md)(?P<part>[^)]*)\)")
_IN_MENU = re.compile(r"^ *- (.+): (\S+\.md)$", re.MULTILINE)


def gather(folder: Path) -> None:
    """Copies README.md, docs/ and all that can be reached from there by links to files.

    A link called as the file that it leads to is called as the menu calls that page: on the site there is no such file.
    """
    shutil.rmtree(folder, ignore_errors=True)
    waiting, known = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))], set[Path]()
    waiting += [ROOT / "docs/site.css", ROOT / "docs/iframe-worker.js"]
    while waiting:
        path = waiting.pop()
        if path in known or not path.is_file() or ROOT not in path.parents:
            continue
        known.add(path)
        copy = folder / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix != ".md":
            shutil.copyfile(path, copy)
        else:
            text = path.read_text(encoding="utf-8")
            copy.write_text(_titled(text, path.parent), encoding="utf-8")
            links = _LINK.findall(text)
            waiting += [(path.parent / link).resolve() for link in links if "://" not in link]


def _titled(text: str, folder: Path) -> str:
    names = {ROOT / page: name for name, page in _IN_MENU.findall((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))}

    def link(match: re.Match[str]) -> str:
        name = names.get((folder / match["target"]).resolve())
        return f"[{name}]({match['target']}{match['part']})" if name else match[0]

    return _NAMED_AS_FILE.sub(link, text)


if __name__ == "__main__":
    gather(Path(sys.argv[1]))
