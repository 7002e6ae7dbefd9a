#!/usr/bin/env bash
# Flies for 27 seconds through the eight-terabyte world, in a window, or headless without a display. Sets up
# a fresh Debian 12 first (packages through apt). The window stays open until you close it; without a
# terminal it closes after 27 seconds.
#   tools/demo.sh [psygen fly options...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -B build/demo >/dev/null
cmake --build build/demo --target psygen

fly() {
  build/demo/bin/psygen fly --world game/worlds/paper.toml --path game/paths/walk27.toml \
    --out "${PSYGEN_DEMO_OUT:-out/demo}" --images 300 "$@"
}
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  limit=()
  [ -t 2 ] || limit=(--seconds 27)
  code=0
  fly "${limit[@]}" "$@" || code=$?
  [ "$code" -eq 4 ] || exit "$code"  # 4: the display cannot be used
fi
fly --headless "$@"
