#!/usr/bin/env bash
# Builds the engine with both compilers, as static and as shared libraries. Each build is installed, other
# projects are built against it and run, and all must make the same world. Takes half an hour on two
# cores: it is not a part of the complete check.
#   tools/builds.sh [COMPILER...]     default: g++ clang++
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools/setup.sh --fuzz # with clang
[ $# -gt 0 ] || set -- g++ clang++
same=""
for compiler in "$@"; do
  for shared in OFF ON; do
    echo "== $compiler, BUILD_SHARED_LIBS=$shared"
    build="$PWD/build/with-$compiler-$shared"
    cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
      -DBUILD_SHARED_LIBS=$shared -DPSYGEN_TESTS=OFF -DPSYGEN_BENCHMARKS=OFF -DPSYGEN_WERROR=ON >/dev/null
    cmake --build "$build"
    CXX="$compiler" tests/tools/install_test.sh "$build" "$PWD"
    hash="$("$build/bin/psygen" amplify --world game/worlds/paper.toml --region 100,100,8,8 | grep '^hash')"
    echo "$hash"
    [ "$hash" = "${same:=$hash}" ] || { echo "the world is another than that of the first build"; exit 1; }
  done
done
