# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.simulate``."""

import sys

from oort.cli.simulate import main

sys.exit(main())
