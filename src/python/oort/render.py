# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.render MAP PREFIX``: draws a saved map; the tool is oort.cli.render."""

import sys

from oort.cli.render import main

if __name__ == "__main__":
    sys.exit(main())
