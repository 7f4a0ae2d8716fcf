#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Checks style and types, and looks for the mistakes that linters know. scripts/setup.sh --test installs what it needs.
#   scripts/lint.sh          what the test command runs
#   scripts/lint.sh --all    and clang's static analyser
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  "" | --all) ;;
  *) echo "usage: scripts/lint.sh [--all]" >&2; exit 2 ;;
esac
.venv/bin/ruff check
.venv/bin/ruff format --check
.venv/bin/mypy
find src tests third_party -name '*.[ch]pp' -print0 | xargs -0 clang-format-14 --dry-run --Werror
.venv/bin/python scripts/tidy.py build/dev "$@"
