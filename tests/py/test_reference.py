# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The reference pages of both APIs are made without a warning."""

import shutil
import subprocess
from pathlib import Path

import pytest

from conftest import ROOT


def test_reference_pages(tmp_path: Path) -> None:
    if shutil.which("doxygen") is None:
        pytest.skip("doxygen is not there: scripts/setup.sh --test installs it")
    run = subprocess.run([ROOT / "scripts/docs.sh", tmp_path], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stderr == ""
    mapper = (tmp_path / "cpp/classoort_1_1Mapper.html").read_text(encoding="utf-8")
    assert "add_scan" in mapper
    page = (tmp_path / "python/oort.html").read_text(encoding="utf-8")
    assert "A map as a map file holds it." in page
    assert "arg0" not in page
