#!/usr/bin/env bash
# Plays Cairns, the game of psygen (docs/game.md). Sets up a fresh Debian 12 first (packages through
# apt), and builds. Needs a display, except for --autoplay --headless.
#   tools/play.sh [psygen-game options...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -B build/demo >/dev/null
cmake --build build/demo --target psygen-game
exec build/demo/bin/psygen-game "$@"
