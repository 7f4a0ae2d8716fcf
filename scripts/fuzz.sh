#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Fuzzes what reads files, guided by coverage: libFuzzer with the address and undefined-behaviour sanitizers for C++,
# atheris for Python. What it learns is kept in build/fuzz/corpus; what it finds lies in build/fuzz as crash-* or slow-*.
#   scripts/fuzz.sh [SECONDS [TARGET...]]    so long for each target (default 60), or for those named
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
[ $# -gt 0 ] && shift
in_cpp=(map parameters)
in_python=(events carmen robotlaser g2o tum relations yaml pgm house axis words requests laser echoes transform static imu)
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=("${in_cpp[@]}" "${in_python[@]}")

command -v clang++-14 > /dev/null || { echo "fuzz.sh: clang++-14 is missing: apt-get install clang-14" >&2; exit 2; }
cmake -S . -B build/fuzz -G Ninja -D CMAKE_BUILD_TYPE=Fuzz -D CMAKE_CXX_FLAGS_FUZZ="-O1 -g" \
  -D CMAKE_C_COMPILER=clang-14 -D CMAKE_CXX_COMPILER=clang++-14 \
  -D OORT_FUZZ=ON -D OORT_TESTS=OFF -D OORT_PYTHON=OFF -D OORT_ROS=OFF > /dev/null
cmake --build build/fuzz --target "${in_cpp[@]/#/fuzz_}"
.venv/bin/python -c "import atheris" 2> /dev/null || .venv/bin/pip install --quiet "atheris>=3.0"

failed=0
for target in "${targets[@]}"; do
  corpus=build/fuzz/corpus/$target
  mkdir -p "$corpus"
  options=(-max_total_time="$seconds" -timeout=60 -rss_limit_mb=4096 -max_len=65536 -print_final_stats=1
    -artifact_prefix="$PWD/build/fuzz/$target-" -verbosity=1)
  if [[ " ${in_cpp[*]} " == *" $target "* ]]; then
    command=("build/fuzz/fuzz_$target" "${options[@]}" "$corpus" "tests/fuzz/corpus/$target")
  else
    .venv/bin/python tests/fuzz/readers.py --seeds "$target" "$corpus"
    command=(.venv/bin/python tests/fuzz/readers.py "$target" "${options[@]}" "$corpus")
  fi
  echo "== $target"
  "${command[@]}" > "build/fuzz/$target.log" 2>&1 || { failed=1; tail -n 30 "build/fuzz/$target.log"; }
  grep -E "cov:" "build/fuzz/$target.log" | tail -n 1 || true
  grep -E "number_of_executed_units|ERROR|Uncaught" "build/fuzz/$target.log" || true
done
exit $failed
