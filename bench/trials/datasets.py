# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the recordings and graphs are."""

import os
from pathlib import Path


def datasets() -> Path:
    """The folder that OORT_DATASETS names; ends the program where it names none."""
    folder = os.environ.get("OORT_DATASETS")
    if not folder:
        raise SystemExit("OORT_DATASETS is not set: it names the folder with real data, see docs/datasets.md")
    return Path(folder)
