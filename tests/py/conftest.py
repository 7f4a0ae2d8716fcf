# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests share: where the real data is, one simulated drive, and a live session."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from helpers.live_rig import Recorder
from oort import Parameters
from oort.live import LiveSession
from oort.simulate import Drive, simulate_drive

if TYPE_CHECKING:
    from playwright.sync_api import Browser

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def datasets() -> Path:
    """The folder with the real data; tests that need it say plainly that they were skipped where it is absent."""
    folder = os.environ.get("OORT_DATASETS")
    if not folder:
        pytest.skip("OORT_DATASETS is not set: it names the folder with real data, see docs/datasets.md")
    path = Path(folder).resolve()
    assert path.is_dir(), f"OORT_DATASETS is {folder}, which is not a folder"
    return path


@pytest.fixture(scope="session")
def drive() -> Drive:
    """A drive through a made-up home."""
    return simulate_drive(seed=3)


@pytest.fixture
def recorder() -> Recorder:
    """What hears all that `live` tells."""
    return Recorder()


@pytest.fixture
def live(recorder: Recorder) -> Iterator[LiveSession]:
    """A live session with the default parameters."""
    session = LiveSession(Parameters(), recorder)
    yield session
    session.close()


@pytest.fixture(scope="module")
def browser() -> Iterator["Browser"]:
    """A real browser without a window."""
    from playwright.sync_api import sync_playwright  # not there for the nodes over ROS 2

    chromium = shutil.which("chromium")
    assert chromium, "chromium is missing: scripts/setup.sh --test installs it"
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        yield opened
        opened.close()
