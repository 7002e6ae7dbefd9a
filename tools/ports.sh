#!/usr/bin/env bash
# Builds psygen for other processors and systems, with other compilers and options, and runs those tests that this
# machine can run. Prints a row for each port. A port whose tools are missing is left out, with the reason.
#   tools/ports.sh [--record] [PORT ...]     PORT: a name below; default: all
# --record replaces the rows of these ports in docs/platforms.md. Builds are in build/port-PORT, messages in
# build/port-PORT.log. Exit code 1: a port failed.
#
# tools/rows.sh describes how a port is written.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/rows.sh

rows=(arm64 mingw no-renderer cxx23 lto multi-config clang-14 clang-19)

# configure PORT [ARGUMENTS OF CMAKE]
configure() {
  cmake --preset release -B "build/port-$1" -DPSYGEN_BENCHMARKS=OFF -DPSYGEN_EDITOR=OFF -DPSYGEN_INSTALL=OFF "${@:2}"
}
# build PORT [TARGET ...]
build() {
  cmake --build "build/port-$1" ${2:+--target "${@:2}"}
}
# run_tests PORT FOLDERS [ARGUMENTS OF CTEST]   FOLDERS: "ecs core", prefixes of the tests' names
run_tests() {
  local log="build/port-$1-ctest.log"
  # A build of several configurations has tests only for the one that is named.
  ctest --test-dir "build/port-$1" -C RelWithDebInfo --output-on-failure -R "^(${2// /|})[:.]" "${@:3}" | tee "$log"
  sed -n 's/^100% tests passed, 0 tests failed out of \([0-9]*\)$/\1 tests pass/p' "$log" >&3
}
# The programs, and the tests that prove the same bits: of models and of the golden hashes of worlds.
same_bits() { # PORT [ARGUMENTS OF CMAKE]
  configure "$@"
  build "$1" psygen psygen-game psygen_test_amplify psygen_test_models
  run_tests "$1" "amplify models" -E AMillion
}

# A folder with the libraries of arm64, as Debian has them. Nothing in it runs while it is made.
arm64_root() {
  [ -e "$PSYGEN_SYSROOT/done" ] && return
  rm -rf "$PSYGEN_SYSROOT"
  local packages
  packages="$(grep -oE '\b(lib[a-z0-9.+-]+|nlohmann-json3)-dev\b' tools/setup.sh | grep -vE 'openmpi|clang' | sort -u | paste -sd,)"
  mmdebstrap --variant=extract --architectures=arm64 --include="$packages,zlib1g-dev,fonts-dejavu-core" \
    "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$PSYGEN_SYSROOT"
  # No script of a package runs, so the alternatives of BLAS and LAPACK, which OpenImageIO needs, are set here.
  ln -sfn blas/libblas.so.3 lapack/liblapack.so.3 "$PSYGEN_SYSROOT/usr/lib/aarch64-linux-gnu"
  local link
  find "$PSYGEN_SYSROOT" -type l -lname '/*' | while read -r link; do
    ln -sfn "$PSYGEN_SYSROOT$(readlink "$link")" "$link"
  done
  # Some packages name their files by absolute paths.
  find "$PSYGEN_SYSROOT" -name '*.cmake' -exec perl -pi -e 's{(["\s;>:])/usr/(lib|include)}{$1$ENV{PSYGEN_SYSROOT}/usr/$2}g' {} +
  touch "$PSYGEN_SYSROOT/done"
}

how_arm64="GCC, cross-compiled; tests under QEMU (NEON and scalar)"
row_arm64() {
  needs aarch64-linux-gnu-g++ qemu-aarch64-static mmdebstrap
  export PSYGEN_SYSROOT="$PWD/build/port-arm64-root"
  arm64_root
  configure arm64 --toolchain cmake/toolchains/arm64.cmake -DPSYGEN_MPI=OFF
  local folders="ecs core models world query synthesis visibility amplify exchange"
  build arm64 psygen psygen-game $(printf 'psygen_test_%s ' $folders)
  # Left out: tests that start programs of arm64, which this kernel cannot, and tests that take hours under QEMU.
  run_tests arm64 "$folders" -E 'DeathTest|ChildProcess|AMillion|BlockReadBack'
}

how_mingw="MinGW-w64: all sources of \`ecs\`, \`core\`, \`models\`, \`world\`, \`query\`, \`synthesis\`, \`visibility\` compile"
row_mingw() {
  needs x86_64-w64-mingw32-g++-posix
  # Debian has no libraries of these packages for Windows, but their headers serve it too.
  local headers="$PWD/build/port-mingw" name
  mkdir -p "$headers"
  for name in fmt glm hwy spdlog tl toml++ xxhash.h xxh_x86dispatch.h; do
    ln -sfn "/usr/include/$name" "$headers/$name"
  done
  local sources
  sources="$(git ls-files --cached --others --exclude-standard \
    ecs/*.cpp engine/{core,models,world,query,synthesis,visibility}/'*.cpp' |
    grep -vE '_posix\.cpp$|core/child_process\.cpp$')"
  xargs -P "$(nproc)" -I {} x86_64-w64-mingw32-g++-posix -std=c++20 -fsyntax-only -I. -isystem "$headers" \
    -Wall -Wextra -Wconversion -Wshadow -Werror -D_WIN32_WINNT=0x0A00 -DWIN32_LEAN_AND_MEAN -DNOMINMAX \
    -DFMT_HEADER_ONLY -DSPDLOG_FMT_EXTERNAL '-DHWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SVE)' \
    '-DPSYGEN_DATA_FROM_EXECUTABLE="."' '-DPSYGEN_VERSION="0"' {} <<<"$sources"
  echo "$(wc -l <<<"$sources") sources compile" >&3
}

how_no_renderer="\`-DPSYGEN_RENDER=OFF\`, without Vulkan, GLFW and Dear ImGui"
row_no_renderer() {
  configure no-renderer -DPSYGEN_RENDER=OFF -DPSYGEN_MPI=OFF -DPSYGEN_GLSLC=/absent \
    -DCMAKE_DISABLE_FIND_PACKAGE_{Vulkan,glfw3,imgui}=ON
  build no-renderer
  run_tests no-renderer "cli amplify"
}

how_cxx23="\`-DCMAKE_CXX_STANDARD=23\`"
row_cxx23() { same_bits cxx23 -DCMAKE_CXX_STANDARD=23; }

how_lto="link-time optimisation"
row_lto() { same_bits lto -DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON; }

how_multi_config="Ninja Multi-Config"
row_multi_config() { same_bits multi-config -G "Ninja Multi-Config" -DCMAKE_DEFAULT_BUILD_TYPE=RelWithDebInfo; }

how_clang_14="clang 14"
row_clang_14() {
  needs clang++-14
  same_bits clang-14 -DCMAKE_C_COMPILER=clang-14 -DCMAKE_CXX_COMPILER=clang++-14
}

how_clang_19="clang 19"
row_clang_19() {
  needs clang++-19
  same_bits clang-19 -DCMAKE_C_COMPILER=clang-19 -DCMAKE_CXX_COMPILER=clang++-19
}

try_rows port "$@"
