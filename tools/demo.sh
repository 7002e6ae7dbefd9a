#!/usr/bin/env bash
# Flies for 12 seconds down a river of the most beautiful world, then for 27 seconds through the paper's
# eight-terabyte world, and prints the figures of that walk. In a window, or headless without a display. Sets
# up a fresh Debian 12 first (packages through apt). The window of the walk stays open until you close it;
# without a terminal it closes after 27 seconds. Options go to the walk, and leave the river out.
#   tools/demo.sh [psygen fly options...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -B build/demo >/dev/null
cmake --build build/demo --target psygen

out="${PSYGEN_DEMO_OUT:-out/demo}"
fly() { # WORLD PATH OPTIONS...
  build/demo/bin/psygen fly --world "game/worlds/$1.toml" --path "game/paths/$2.toml" "${@:3}"
}
river() { fly watershed watershed --seconds 12 --out "$out/river" --images 60 "$@" >/dev/null; }
walk() { fly paper walk27 --out "$out" --images 300 "$@"; }

# Runs a part in a window if there is a display, else headless.
part() { # NAME OPTIONS...
  local code=0 limit=()
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    if [ "$1" = walk ] && [ ! -t 2 ] && [[ " $* " != *" --seconds"* ]]; then limit=(--seconds 27); fi
    "$1" "${limit[@]}" "${@:2}" || code=$?
    [ "$code" -eq 4 ] || return "$code"  # 4: the display cannot be used
  fi
  "$1" --headless "${@:2}"
}
if [ $# -eq 0 ]; then
  echo "1 of 2: 12 seconds down a river of the world watershed, the most beautiful one; files in $out/river"
  part river
  echo "2 of 2: 27 seconds of the paper's walk; all figures are of this walk"
else
  echo "The paper's walk with your options"
fi
part walk "$@"
