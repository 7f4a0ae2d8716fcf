#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Writes the stub of the extension anew, src/python/oort/_core.pyi: after the bindings changed and scripts/setup.sh --test
# has built them. tests/py/test_stubs.py compares it with the extension.
set -euo pipefail
cd "$(dirname "$0")/.."
stub=$(.venv/bin/python scripts/stubs.py)
printf '%s\n' "$stub" >src/python/oort/_core.pyi
