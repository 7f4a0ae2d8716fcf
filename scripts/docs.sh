#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Builds the documentation as a site with MkDocs, and in it the reference pages of both APIs: FOLDER/python with pdoc,
# FOLDER/cpp with Doxygen (Debian's package doxygen).
# scripts/setup.sh --test comes first.
#   scripts/docs.sh [FOLDER]      FOLDER is build/docs if not given
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/docs}
command -v doxygen >/dev/null || { echo "doxygen is not there: install Debian's package doxygen" >&2; exit 1; }
.venv/bin/python scripts/gather_pages.py build/site-source
# What Material announces goes to stderr as warnings do; --strict ends the build at a warning, which is then shown.
told=$(.venv/bin/mkdocs build --strict --site-dir "$(realpath -m "$folder")" 2>&1) || { echo "$told" >&2; exit 1; }
.venv/bin/python scripts/reference.py "$folder/python"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = \"$folder\""; } | doxygen -
echo "Open $folder/index.html, $folder/python/index.html and $folder/cpp/index.html."
