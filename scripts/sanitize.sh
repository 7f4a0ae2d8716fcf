#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Builds the C++ tests with GCC's sanitizers and runs them. scripts/setup.sh --test installs what they need.
#   scripts/sanitize.sh [address] [ctest's options]    wrong memory accesses, leaks and undefined behaviour
#   scripts/sanitize.sh thread    [ctest's options]    data races
# SANITIZE_LOGS names CARMEN logs (.clf) that are mapped besides, with the global lane's thread; SANITIZE_JOBS how much is
# done at a time.
set -euo pipefail
cd "$(dirname "$0")/.."
kind=address
case "${1:-}" in
  address | thread) kind=$1; shift ;;
  "" | -*) ;;
  *) echo "usage: scripts/sanitize.sh [address | thread] [ctest's options]" >&2; exit 2 ;;
esac
build=build/sanitize-$kind
jobs=${SANITIZE_JOBS:-$(nproc)}
cmake -S . -B "$build" -G Ninja -D CMAKE_BUILD_TYPE=Sanitize -D CMAKE_CXX_FLAGS_SANITIZE="-O1 -g" \
  -D OORT_TESTS=ON -D OORT_PYTHON=OFF -D OORT_ROS=OFF -D OORT_SANITIZE="$kind"
# Without address space layout randomisation: GCC 12's thread sanitizer ends at once where the kernel puts things in places
# that it does not expect ("unexpected memory mapping"). The tests are run by the build too, to list their cases.
setarch -R cmake --build "$build" -j "$jobs"
export UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS="halt_on_error=1 second_deadlock_stack=1"
setarch -R ctest --test-dir "$build" --output-on-failure -j "$jobs" "$@"
for log in ${SANITIZE_LOGS:-}; do
  echo "== $log"
  setarch -R "$build/examples/cpp/01_map_a_log" "$log" "$build/mapped"
done
