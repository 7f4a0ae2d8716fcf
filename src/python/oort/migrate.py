# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.migrate IN OUT``: writes a saved map in the newest format; the tool is oort.cli.migrate."""

import sys

from oort.cli.migrate import main

if __name__ == "__main__":
    sys.exit(main())
