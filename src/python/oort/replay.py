# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.replay INPUT``: maps a recorded drive; the tool is oort.cli.replay."""

import sys

from oort.cli.replay import main

if __name__ == "__main__":
    sys.exit(main())
