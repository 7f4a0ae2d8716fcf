# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.evaluate ...``: compares trajectories with the truth; the tool is oort.cli.evaluate."""

import sys

from oort.cli.evaluate import main

if __name__ == "__main__":
    sys.exit(main())
