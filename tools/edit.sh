#!/usr/bin/env bash
# Opens the editor with a shipped world, or with the given one. Sets up a fresh Debian
# first (packages through apt), and builds. Needs a display.
#   tools/edit.sh [WORLD] [psygen-editor options...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh --editor
cmake --preset release -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -DPSYGEN_EDITOR=ON -B build/demo >/dev/null
cmake --build build/demo --target psygen psygen-editor
exec build/demo/bin/psygen-editor "$@"
