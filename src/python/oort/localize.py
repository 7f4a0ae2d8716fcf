# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.localize MAP RECORDING``: follows a recorded drive on a saved map; the tool is oort.cli.localize."""

import sys

from oort.cli.localize import main

if __name__ == "__main__":
    sys.exit(main())
