#!/usr/bin/env bash
# Formats all C++ sources with clang-format. With --check it only lists unformatted files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(-i)
[ "${1:-}" = "--check" ] && mode=(--dry-run --Werror)
git ls-files 'ecs/*' 'engine/*' 'game/*' 'editor/*' 'tests/*' 'tools/*' 'shaders/*' |
  grep -E '\.(cpp|hpp|h)$' | xargs -r clang-format "${mode[@]}"
