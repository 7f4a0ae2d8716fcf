# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Adds to a repaired wheel the licences of the libraries that it carries, as Debian's packages state them.

python scripts/wheel_licences.py RAW_WHEEL REPAIRED_FOLDER FOLDER
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

_HASH = re.compile(r"-[0-9a-f]{8}(?=\.)")
"""What auditwheel puts into the names of libraries."""
_STATIC = {"libceres-dev", "libeigen3-dev"}


def main(raw: str, repaired: Path, folder: Path) -> None:
    """Packs the wheel that was made of `raw` into `folder`."""
    name = "-".join(Path(raw).name.split("-")[:4])  # without the platform, which the repair changes
    (wheel,) = repaired.glob(f"{name}-*.whl")
    with tempfile.TemporaryDirectory() as place:
        subprocess.run([sys.executable, "-m", "wheel", "unpack", "-d", place, str(wheel)], check=True)
        (tree,) = Path(place).iterdir()
        (info,) = tree.glob("*.dist-info")
        for package in sorted(packages(tree)):
            shutil.copyfile(f"/usr/share/doc/{package}/copyright", info / "licenses" / f"{package}.txt")
        folder.mkdir(exist_ok=True)
        subprocess.run([sys.executable, "-m", "wheel", "pack", "-d", str(folder), str(tree)], check=True)


def packages(tree: Path) -> set[str]:
    """The packages of the libraries in a wheel's tree: those that auditwheel put in, and those linked statically."""
    names = {_HASH.sub("", path.name) for path in tree.glob("*.libs/*")}
    found = {line.split(":")[0] for name in names for line in _query(f"*/{name}").splitlines()}
    return found | _STATIC


def _query(pattern: str) -> str:
    """Debian's packages that have such a file. Raises CalledProcessError if there is none."""
    return subprocess.run(["dpkg-query", "-S", pattern], check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
