#!/usr/bin/env bash
# Fuzzes everything that reads files of people, from the shipped worlds and paths on, with libFuzzer
# under the address and undefined-behaviour sanitizers. Needs clang (tools/setup.sh --fuzz).
#   tools/fuzz.sh [SECONDS [SEED]]     default: 60 seconds, another seed each time
# Ends with the number of inputs; one that fails stays in build/fuzz/failures.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh --fuzz
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target psygen_fuzz_readers
mkdir -p build/fuzz/corpus build/fuzz/failures
export UBSAN_OPTIONS="print_stacktrace=1"
exec build/fuzz/bin/psygen_fuzz_readers build/fuzz/corpus game/worlds game/paths \
  -max_total_time="${1:-60}" -seed="${2:-0}" -max_len=65536 -timeout=60 -rss_limit_mb=4096 \
  -artifact_prefix=build/fuzz/failures/ -print_final_stats=1
