# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The shipped stub of the extension is the one that the extension gives."""

import subprocess
import sys
from importlib import resources

from conftest import ROOT


def test_the_stub_is_the_extensions() -> None:
    run = subprocess.run([sys.executable, str(ROOT / "scripts/stubs.py")], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    shipped = (resources.files("oort") / "_core.pyi").read_text(encoding="utf-8")
    assert shipped == run.stdout, "the bindings have changed: run scripts/stubs.sh"


def test_package_is_marked_as_typed() -> None:
    assert (resources.files("oort") / "py.typed").is_file()
