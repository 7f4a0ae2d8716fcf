#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Sets Oort up with what its tests need and runs them all: linters, ctest, pytest. Words after it go to pytest,
# which runs once more for the nodes over ROS 2 where its wheels can be had. TEST_JOBS is how many files pytest has at
# work, 2 unless given; each process has ROS cores of its own.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --test

# The nodes over ROS 2: a Python of its own, because both ROS have message packages of the same names. Making it is
# waiting for the network for the most part, so it is made beside the rest, in a process group that the end of this takes along.
set -m
scripts/ros2_environment.sh > build/ros2_environment.log 2>&1 &
ros2=$!
set +m
trap 'kill -- -$ros2 2> /dev/null || true' EXIT

scripts/lint.sh
ctest --test-dir build/dev --output-on-failure -j 2
beside=(-n "${TEST_JOBS:-2}" --dist loadfile --no-loadscope-reorder)
.venv/bin/python -m pytest -q "${beside[@]}" "$@"

made=0
wait $ros2 || made=$?
trap - EXIT
cat build/ros2_environment.log
[ $made = 0 ] || exit $made
if [ -x .venv-ros2/bin/python ]; then
  code=0
  .venv-ros2/bin/python -m pytest -q "${beside[@]}" tests/py/node/test_both_*.py tests/py/node/test_ros2_*.py "$@" || code=$?
  [ $code = 0 ] || [ $code = 5 ] || exit $code  # 5: what was asked for is not among these
fi
