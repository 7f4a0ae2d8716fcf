#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Sets Oort up on Debian 12: system packages, a virtual environment in .venv, and the package built into it.
#   scripts/setup.sh           what mapping needs
#   scripts/setup.sh --test    and what the tests need
# Without root and without sudo the system packages must be there already.
set -euo pipefail
cd "$(dirname "$0")/.."
test=OFF extra=""
case "${1:-}" in
  "") ;;
  --test) test=ON extra="[test]" ;;
  *) echo "usage: scripts/setup.sh [--test]" >&2; exit 2 ;;
esac

packages=(g++ cmake ninja-build python3 python3-venv python3-dev
  libceres-dev libeigen3-dev libopencv-core-dev libopencv-imgproc-dev capnproto libcapnp-dev)
[ $test = ON ] && packages+=(libgtest-dev)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "Oort needs root or sudo to install: ${missing[*]}" >&2; exit 1; }
    root=(sudo)
  fi
  "${root[@]}" apt-get update -q
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
fi

# Debian's own interpreter, with its site packages: rospy lives there.
[ -x .venv/bin/python ] || /usr/bin/python3 -m venv --system-site-packages .venv
.venv/bin/python -m pip install --quiet --disable-pip-version-check "pip>=23.1"  # the first with -C
.venv/bin/pip install --quiet "scikit-build-core>=0.10" "pybind11>=2.12"
echo "Building Oort; the first time that takes some minutes."
.venv/bin/pip install --quiet --no-build-isolation -C build-dir=build/dev -C cmake.define.OORT_TESTS=$test -e ".$extra"
