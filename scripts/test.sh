#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Sets Oort up with what its tests need and runs them all: linters, ctest, pytest. Words after it go to pytest,
# which runs once more for the nodes over ROS 2 where its wheels can be had.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --test
scripts/lint.sh
ctest --test-dir build/dev --output-on-failure -j 2
.venv/bin/python -m pytest -q "$@"

# The nodes over ROS 2: a Python of its own, because both ROS have message packages of the same names.
scripts/ros2_environment.sh
if [ -x .venv-ros2/bin/python ]; then
  code=0
  .venv-ros2/bin/python -m pytest -q tests/py/node/test_both_*.py tests/py/node/test_ros2_*.py "$@" || code=$?
  [ $code = 0 ] || [ $code = 5 ] || exit $code  # 5: what was asked for is not among these
fi
