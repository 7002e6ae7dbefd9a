#!/usr/bin/env bash
# Builds the packages: .deb files for Debian, and an archive of the programs that runs from any folder. Two builds of one
# commit with the same compiler and libraries have the same bytes, whatever their folders (docs/package.md).
#   tools/package.sh [FOLDER]     FOLDER receives the packages; default: build/package/packages
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/package packages="${1:-build/package/packages}"
umask 022
tools/setup.sh --editor
for program in python3 dpkg-shlibdeps file; do
  command -v "$program" >/dev/null ||
    { echo "package: $program is missing (Debian: apt-get install python3 dpkg-dev file)" >&2; exit 1; }
done
cmake --preset release -B "$build" -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -DPSYGEN_REPRODUCIBLE=ON \
  -DCMAKE_INSTALL_PREFIX=/usr >/dev/null
cmake --build "$build"
cpack --config "$build/CPackConfig.cmake" -B "$packages"
rm -rf "$packages/_CPack_Packages"
