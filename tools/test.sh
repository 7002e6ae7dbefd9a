#!/usr/bin/env bash
# Builds psygen and runs every test. Sets up a fresh Debian 12 or 13 first (packages through apt).
#   tools/test.sh [PRESET] [ctest arguments...]      PRESET: release (default), dev, asan, tsan
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh --test
preset="${1:-release}"
shift || true
case "$preset" in
  release | dev | asan | tsan) ;;
  *) echo "usage: tools/test.sh [release|dev|asan|tsan] [ctest arguments...]" >&2; exit 2 ;;
esac

# Sanitizers: the first report fails the test, but third-party drivers may leak. With
# intercept_tls_get_addr the leak checker of GCC 12 crashes in programs that load OpenImageIO.
export ASAN_OPTIONS="detect_leaks=1:abort_on_error=0:strict_string_checks=1:intercept_tls_get_addr=0"
export LSAN_OPTIONS="suppressions=$PWD/tools/lsan.supp:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$PWD/tools/tsan.supp:halt_on_error=1:second_deadlock_stack=1"
export UBSAN_OPTIONS="print_stacktrace=1"

# The presets leave out tests that run for an hour (label long), and sanitizers those with the labels
# not_asan and not_tsan. tests/CMakeLists.txt lists the folders that a sanitizer does not build.
cmake --preset "$preset" -DPSYGEN_TESTS=ON >/dev/null
cmake --build --preset "$preset"
# One more than processors: some tests wait for windows and other processes.
ctest --preset "$preset" --parallel "$(($(nproc) + 1))" "$@"
