# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.check INPUT``: says what is wrong with a recording; the tool is oort.cli.check."""

import sys

from oort.cli.check import main

if __name__ == "__main__":
    sys.exit(main())
