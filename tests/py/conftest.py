# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests share: where the real data is, and one simulated drive."""

import os
from pathlib import Path

import pytest

from oort.simulate import Drive, simulate_drive

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def datasets() -> Path:
    """The folder with the real data; tests that need it say plainly that they were skipped where it is absent."""
    path = Path(os.environ.get("OORT_DATASETS", ROOT / "../shared/datasets")).resolve()
    if not path.is_dir():
        pytest.skip(f"real data not found at {path} (set OORT_DATASETS)")
    return path


@pytest.fixture(scope="session")
def drive() -> Drive:
    """A drive through a made-up home."""
    return simulate_drive(seed=3)
