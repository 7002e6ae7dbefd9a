#!/usr/bin/env bash
# Checks the golden hashes of worlds, and runs all tests of models, in builds with little optimisation:
# at -O0 compilers call functions that they otherwise inline. Builds only the targets that this needs.
#   tools/world_hashes.sh [LEVEL ...]     optimisation levels, default: 0 1
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh --test
[ $# -gt 0 ] || set -- 0 1
for level in "$@"; do
  echo "== -O$level"
  build="build/O$level"
  cmake --preset release -B "$build" -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O$level -g0" \
    -DPSYGEN_BENCHMARKS=OFF -DPSYGEN_EDITOR=OFF >/dev/null
  cmake --build "$build" --target psygen_test_amplify psygen_test_models
  "$build/bin/psygen_test_amplify" --gtest_brief=1 --gtest_filter='*GoldenHash*'
  "$build/bin/psygen_test_models" --gtest_brief=1 --gtest_filter='-*AMillion*'
done
