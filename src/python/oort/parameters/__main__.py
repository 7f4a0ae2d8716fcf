# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.parameters``."""

import sys

from oort.cli.parameters import main

sys.exit(main())
