# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.graph solve IN OUT``: solves a pose graph; the tool is oort.cli.graph."""

import sys

from oort.cli.graph import main

if __name__ == "__main__":
    sys.exit(main())
