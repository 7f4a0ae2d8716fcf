#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Sets Oort up on Debian 12: system packages, a virtual environment in .venv, and the package built into it.
#   scripts/setup.sh           what mapping needs
#   scripts/setup.sh --ros     and what the ROS node and the ROS command line tools need
#   scripts/setup.sh --ros2    and ROS 2's rclpy in .venv-ros2, for trying it where there is no ROS 2 distribution
#   scripts/setup.sh --test    and what the tests need, with ROS 1
# Without root and without sudo the system packages must be there already.
set -euo pipefail
cd "$(dirname "$0")/.."
ros=OFF ros2=OFF test=OFF extra=""
case "${1:-}" in
  "") ;;
  --ros) ros=ON ;;
  --ros2) ros2=ON ;;
  --test) ros=ON test=ON extra="[test]" ;;
  *) echo "usage: scripts/setup.sh [--ros | --ros2 | --test]" >&2; exit 2 ;;
esac

packages=(g++ cmake ninja-build python3 python3-venv python3-dev
  libceres-dev libeigen3-dev capnproto libcapnp-dev)
if [ $ros = ON ]; then
  packages+=(python3-roslaunch python3-rospy python3-tf2-ros rosout
    rosbash rospack-tools python3-rosbag python3-rosmsg python3-rosnode python3-rosparam python3-rosservice python3-rostopic)
  # Of each message package, Debian splits off the Python classes, the definitions and (for rospack) the package.xml.
  for messages in diagnostic-msgs geometry-msgs nav-msgs sensor-msgs std-msgs std-srvs tf2-msgs visualization-msgs; do
    packages+=("python3-$messages" "ros-$messages" "lib$messages-dev")
  done
  packages+=(python3-genpy)
fi
[ $test = ON ] && packages+=(libgtest-dev pkgconf clang-format-14 clang-tidy-14 chromium doxygen)
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
.venv/bin/pip install --quiet "scikit-build-core>=0.10" "pybind11==3.1.0"
echo "Building Oort; the first time that takes some minutes."
.venv/bin/pip install --quiet --no-build-isolation -C build-dir=build/dev \
  -C cmake.define.OORT_TESTS=$test -C cmake.define.OORT_WERROR=$test -e ".$extra"
if [ -d .venv/share/oort ]; then
  echo "The ROS node is there: source .venv/share/oort/setup.bash && rosrun oort oort_ros"
else
  echo "The ROS node is not there; scripts/setup.sh --ros adds it."
fi
[ $ros2 = OFF ] || scripts/ros2_environment.sh
