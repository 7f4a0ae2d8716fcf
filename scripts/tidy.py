#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over what the build compiles, on all cores; what passed is skipped until it or a header changes.

    scripts/tidy.py BUILD [--all]      BUILD holds compile_commands.json

Without --all the static analyser, other slow checks and the tests are left out. Stamps are in BUILD/tidy, of either way
in a folder of its own.
"""

import argparse
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TIDY = "clang-tidy-14"
SLOW = (
    "clang-analyzer-*",
    "bugprone-assert-side-effect",
    "bugprone-infinite-loop",
    "bugprone-misplaced-widening-cast",
    "bugprone-multiple-statement-macro",
    "bugprone-not-null-terminated-result",
    "bugprone-sizeof-expression",
    "bugprone-stringview-nullptr",
    "bugprone-suspicious-semicolon",
    "bugprone-suspicious-string-compare",
    "bugprone-unused-raii",
    "bugprone-unused-return-value",
    "misc-unused-using-decls",
    "performance-type-promotion-in-math-fn",
    "readability-redundant-control-flow",
    "readability-redundant-declaration",
)
"""Checks that only --all runs: those that --enable-check-profile shows to cost most, and that found nothing here."""

SLOW_FOLDERS = ("tests", "third_party/frsm/tests", "src/cpp/bindings")
"""Sources that only --all looks at: GoogleTest's and pybind11's headers cost more than all of the engine."""

_INCLUDE = re.compile(rb'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


@cache
def included(path: Path, folders: tuple[Path, ...]) -> frozenset[Path]:
    """The file itself and those of the project that it includes: in quotes, or as a library's (frsm) in brackets."""
    return frozenset([path]).union(*(included(header, folders) for header in _headers(path, folders)))


def _headers(path: Path, folders: tuple[Path, ...]) -> list[Path]:
    names = (os.fsdecode(name) for name in _INCLUDE.findall(path.read_bytes()))
    places = ([folder / name for folder in (path.parent, *folders)] for name in names)
    return [next(place for place in those if place.is_file()) for those in places if any(map(Path.is_file, those))]


def fingerprint(source: Path, command: str, settings: str) -> str:
    """A hash of all that the verdict on a source depends on, but for the system's headers."""
    folders = tuple(Path(word[2:]) for word in shlex.split(command) if word.startswith("-I"))
    texts = [settings.encode(), command.encode()]
    texts += [path.read_bytes() for path in sorted(included(source, folders))]
    return hashlib.sha256(b"\0".join(hashlib.sha256(text).digest() for text in texts)).hexdigest()


def is_due(source: Path, everything: bool) -> bool:
    """Whether a source, by its path in the project, is looked at; one that the build made never is."""
    skipped = ("build",) if everything else ("build", *SLOW_FOLDERS)
    return not any(source.is_relative_to(folder) for folder in skipped)


def tidy(source: Path, build: Path, checks: list[str]) -> tuple[bool, str]:
    """Whether it passed, and what clang-tidy said."""
    run = subprocess.run(
        [TIDY, "-p", str(build), "--quiet", *checks, str(source)], capture_output=True, text=True, check=False
    )
    return run.returncode == 0, run.stdout if run.stdout.strip() or run.returncode == 0 else run.stderr


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, help="the build folder")
    parser.add_argument("--all", action="store_true", help="every check of .clang-tidy")
    args = parser.parse_args()
    began = time.monotonic()
    checks = [] if args.all else ["--checks=" + ",".join(f"-{check}" for check in SLOW)]
    version = subprocess.run([TIDY, "--version"], capture_output=True, text=True, check=True).stdout
    settings = version + (ROOT / ".clang-tidy").read_text() + " ".join(checks)
    stamps = args.build / "tidy" / ("all" if args.all else "usual")
    stamps.mkdir(parents=True, exist_ok=True)
    commands = json.loads((args.build / "compile_commands.json").read_text())
    sources = {Path(entry["file"]): entry["command"] for entry in commands}
    keys = {
        source: stamps / fingerprint(source, command, settings)
        for source, command in sources.items()
        if is_due(source.relative_to(ROOT), args.all)
    }
    due = [source for source, stamp in keys.items() if not stamp.exists()]
    failed = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, (passed, text) in zip(due, pool.map(lambda s: tidy(s, args.build, checks), due), strict=True):
            if passed:
                keys[source].touch()
            else:
                failed += 1
                print(text, flush=True)
    for stamp in set(stamps.iterdir()) - set(keys.values()):
        stamp.unlink()
    seconds = time.monotonic() - began
    print(f"clang-tidy: {len(due)} of {len(keys)} files looked at in {seconds:.0f} s, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
