# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Names what a file is that stands where a recording or a map is expected, and says what to do with it."""

import re
from pathlib import Path

_ARCHIVES = {
    b"PK\x03\x04": "a zip archive: unpack it",
    b"7z\xbc\xaf\x27\x1c": "a 7z archive: unpack it",
    b"\xfd7zXZ\0": "compressed with xz: unpack it with 'unxz'",
}


def name_foreign(path: Path, head: bytes) -> str:
    """What a file with these first bytes is and what to do, after "X is"; empty for what is not known here."""
    for magic, what in _ARCHIVES.items():
        if head.startswith(magic):
            return f"{what} and give what was in it"
    if head[257:262] == b"ustar":
        return "a tar archive: unpack it and give what was in it"
    for tell in (_git_lfs, _git_annex, _old_bag, _web_page):
        if said := tell(path, head):
            return said
    return ""


def _git_lfs(path: Path, head: bytes) -> str:
    if not head.startswith(b"version https://git-lfs.github.com/spec/"):
        return ""
    size = re.search(rb"^size (\d+)$", head, re.MULTILINE)
    much = f" of {int(size[1])} bytes" if size else ""
    return f"a Git LFS pointer, which stands for a file{much}: run 'git lfs pull' where the repository was cloned"


def _git_annex(path: Path, head: bytes) -> str:
    if len(head) > 1024 or b"/annex/objects/" not in head.split(b"\n")[0]:
        return ""
    return "a git-annex pointer, not the file itself: run 'git annex get' where the repository was cloned"


def _old_bag(path: Path, head: bytes) -> str:
    version = re.match(rb"#ROS(?:RECORD|LOG|BAG) V(\d+)\.(\d+)\r?\n", head)
    if not version or head.startswith(b"#ROSBAG V2.0\n"):
        return ""
    return (
        f"a ROS 1 bag of format {int(version[1])}.{int(version[2])}; only format 2.0 is read. With ROS 1, "
        f"'rosbag fix {path.name} new.bag' writes it in format 2.0"
    )


def _web_page(path: Path, head: bytes) -> str:
    if not re.match(rb"\s*<(!doctype html|html)", head, re.IGNORECASE):
        return ""
    return "a web page, probably saved in place of the file: download it again by the link to the raw file"
