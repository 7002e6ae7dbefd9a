#!/usr/bin/env bash
# Runs the standard flight headless with both render paths on this machine's Vulkan device, and
# prints the figures as a table. Configures and builds psygen first.
#   tools/gpu_flight.sh [psygen fly options...]      e.g. --size 3840x2160 --error 1
# PSYGEN_FLIGHT_OUT: folder for the outputs of both flights (default out/gpu_flight).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=build/gpu_flight
out=${PSYGEN_FLIGHT_OUT:-out/gpu_flight}
cmake --preset release -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -B "$build" >/dev/null
cmake --build "$build" --target psygen

failed=0
for path in cpu gpu; do
  "$build/bin/psygen" fly --headless --world game/worlds/paper.toml --path game/paths/walk27.toml \
    --render-path "$path" --out "$out/$path" "$@" >/dev/null || {
    echo "the flight on the $path path failed" >&2
    failed=1
    rm -f "$out/$path/summary.json"
  }
done
python3 tools/flight_table.py "$out/cpu/summary.json" "$out/gpu/summary.json"
exit "$failed"
