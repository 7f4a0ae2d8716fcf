# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.merge A B OUT``: joins two saved maps; the tool is oort.cli.merge."""

import sys

from oort.cli.merge import main

if __name__ == "__main__":
    sys.exit(main())
