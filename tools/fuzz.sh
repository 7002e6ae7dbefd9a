#!/usr/bin/env bash
# Fuzzes all readers of user files with libFuzzer, under the address and undefined-behaviour
# sanitizers. Starts from the shipped worlds and paths. Needs clang (tools/setup.sh --clang).
#   tools/fuzz.sh [SECONDS [SEED]]     default: 60 seconds, another seed each time
# Prints the number of inputs at the end. Failing inputs are stored in build/fuzz/failures.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh --clang
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target psygen_fuzz_readers
mkdir -p build/fuzz/corpus build/fuzz/failures
export UBSAN_OPTIONS="print_stacktrace=1"
exec build/fuzz/bin/psygen_fuzz_readers build/fuzz/corpus game/worlds game/paths \
  -max_total_time="${1:-60}" -seed="${2:-0}" -max_len=65536 -timeout=60 -rss_limit_mb=4096 \
  -artifact_prefix=build/fuzz/failures/ -print_final_stats=1
