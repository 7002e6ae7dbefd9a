#!/usr/bin/env bash
# Installs packages on Debian 12, Debian 13 and Ubuntu 24.04, if they are missing.
#   tools/setup.sh           packages to build and run psygen and its game
#   tools/setup.sh --editor  also those of the editor, and of models with Draco compression
#   tools/setup.sh --test    also those of the editor, the cluster and all tests
#   tools/setup.sh --ci      also those of the complete check (clang-format, clang-tidy, npm)
#   tools/setup.sh --clang   those of --test, and clang with its sanitizers, for tools/fuzz.sh and tools/builds.sh
# docs/platforms.md has the names of the packages in other distributions.
set -euo pipefail

build=(
  g++ cmake ninja-build libglfw3-dev libglm-dev libvulkan-dev libvulkan-volk-dev
  mesa-vulkan-drivers glslc libopenimageio-dev libexpected-dev libcli11-dev libtomlplusplus-dev
  nlohmann-json3-dev libspdlog-dev libfmt-dev libxxhash-dev libimgui-dev libstb-dev fonts-dejavu-core libhwy-dev
  libtinygltf-dev libmeshoptimizer-dev libsqlite3-dev libopenal-dev libsndfile1-dev libbullet-dev
)
editor=(qt6-base-dev qt6-base-private-dev qt6-wayland libxcb1-dev pkg-config libdraco-dev)
test=(
  git python3 ccache spirv-tools vulkan-validationlayers libopenmpi-dev openmpi-bin slurm-wlm munge libgtest-dev
  libgmock-dev libbenchmark-dev libassimp-dev doxygen valgrind gdb linux-perf xvfb openbox xdotool x11-utils
  x11-xkb-utils sway grim libxkbcommon-tools chromium
)
ci=(clang-format clang-tidy)
# For the test in which other programs read tilesets. A newer Node.js from elsewhere works too.
command -v npm >/dev/null || ci+=(nodejs npm)
clang=(clang libclang-rt-dev)

case "${1:-}" in
  "") packages=("${build[@]}") ;;
  --editor) packages=("${build[@]}" "${editor[@]}") ;;
  --test) packages=("${build[@]}" "${editor[@]}" "${test[@]}") ;;
  --ci) packages=("${build[@]}" "${editor[@]}" "${test[@]}" "${ci[@]}") ;;
  --clang) packages=("${build[@]}" "${editor[@]}" "${test[@]}" "${clang[@]}") ;;
  *) echo "usage: tools/setup.sh [--editor|--test|--ci|--clang]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
    missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
  echo "setup: this is not Debian; please install the equivalents of: ${missing[*]}" >&2
  exit 1
fi
sudo=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "setup: run as root, or install these packages first: ${missing[*]}" >&2
    exit 1
  }
  sudo="sudo"
fi
echo "setup: installing ${#missing[@]} packages: ${missing[*]}" >&2
$sudo apt-get update -qq
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
