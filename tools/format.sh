#!/usr/bin/env bash
# Formats all C++ and JavaScript sources with clang-format, untracked ones too. With --check it only lists
# unformatted files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(-i)
[ "${1:-}" = "--check" ] && mode=(--dry-run --Werror)
git ls-files --cached --others --exclude-standard \
  ecs engine examples game editor tests tools shaders |
  grep -E '\.(cpp|hpp|h|js)$' | xargs -r clang-format "${mode[@]}"
