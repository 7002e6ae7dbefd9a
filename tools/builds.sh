#!/usr/bin/env bash
# Builds psygen with each compiler, static and shared, installs each build, and uses the installation from
# other projects. All builds must make the same meshes. Takes half an hour, so it is not part of the
# complete check, which builds static libraries with g++.
#   tools/builds.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools/setup.sh --clang

hash_of() { # BUILD   of a region of the paper's world
  "$1/bin/psygen" amplify --world game/worlds/paper.toml --region 200,200,208,208 | awk '$1 == "hash" { print $2 }'
}
first=""
for compiler in g++ clang++; do
  for shared in OFF ON; do
    build="build/builds/$compiler-shared-$shared"
    echo "== $compiler, BUILD_SHARED_LIBS=$shared"
    cmake --preset release -B "$build" -DCMAKE_CXX_COMPILER="$compiler" -DBUILD_SHARED_LIBS="$shared" \
      -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF >/dev/null
    cmake --build "$build"
    CXX="$compiler" tests/tools/install_test.sh "$PWD/$build" "$PWD"
    hash="$(hash_of "$build")"
    echo "hash $hash"
    [ -n "$hash" ] && [ "$hash" = "${first:=$hash}" ] || { echo "builds: the meshes differ" >&2; exit 1; }
  done
done
