#!/usr/bin/env bash
# Flies for 27 seconds through the eight-terabyte world: in a window when there is a display,
# headless otherwise. Sets up a fresh Debian 12 first (packages through apt).
#   tools/demo.sh [psygen fly options...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -B build/demo >/dev/null
cmake --build build/demo --target psygen

mode=(--headless)
[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && mode=()
out="${PSYGEN_DEMO_OUT:-out/demo}"
exec build/demo/game/psygen fly --world game/worlds/paper.toml --path game/paths/walk27.toml \
  --out "$out" --images 300 "${mode[@]}" "$@"
