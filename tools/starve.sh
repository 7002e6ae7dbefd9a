#!/usr/bin/env bash
# Runs the tests of a preset on a starved machine: beside four busy processes, on one core, and at the lowest
# priority beside one busy process. No test may fail: a failing test depends on free processor time.
# Takes hours, so it is not part of the complete check.
#   tools/starve.sh [PRESET [RUNS]]     default: release, 3 runs of each
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset="${1:-release}" runs="${2:-3}"

busy=()
trap 'kill "${busy[@]}" 2>/dev/null || true' EXIT
keep_busy() { # N: that many processes that do nothing, all the time
  for _ in $(seq "$1"); do
    sh -c 'while :; do :; done' &
    busy+=($!)
  done
}
failed=0
run() { # NAME BUSY COMMAND…
  local name="$1"
  keep_busy "$2"
  shift 2
  for i in $(seq "$runs"); do
    echo "== $name, run $i of $runs"
    "$@" ctest --preset "$preset" --parallel 2 || failed=1
  done
  kill "${busy[@]}" 2>/dev/null || true
  busy=()
}

tools/setup.sh --test
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
run "beside four busy processes" 4
run "on one core" 0 taskset -c 0
run "at the lowest priority" 1 nice -n 19
exit "$failed"
