#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Sets Oort up with what its tests need and runs them all: linters, ctest, pytest. Words after it go to pytest.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --test
scripts/lint.sh
ctest --test-dir build/dev --output-on-failure -j 2
.venv/bin/python -m pytest -q "$@"
