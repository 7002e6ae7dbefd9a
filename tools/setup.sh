#!/usr/bin/env bash
# Installs the packages that psygen needs on Debian 12, if they are missing.
#   tools/setup.sh          packages to build, run and test
#   tools/setup.sh --ci     also those of the complete check (clang-format, clang-tidy)
#   tools/setup.sh --clang  also clang and its sanitizers, for tools/fuzz.sh and tools/builds.sh
set -euo pipefail

packages=(
  build-essential python3 cmake ninja-build ccache git pkg-config
  libglfw3-dev libglm-dev libvulkan-dev libvulkan-volk-dev vulkan-validationlayers
  mesa-vulkan-drivers glslc spirv-tools libopenimageio-dev libexpected-dev libcli11-dev
  libtomlplusplus-dev nlohmann-json3-dev libspdlog-dev libfmt-dev libxxhash-dev
  libimgui-dev libstb-dev fonts-dejavu-core libhwy-dev libtinygltf-dev libmeshoptimizer-dev libdraco-dev libsqlite3-dev
  libopenal-dev libsndfile1-dev libbullet-dev qt6-base-dev libxcb1-dev libopenmpi-dev openmpi-bin
  slurm-wlm munge
  libgtest-dev libgmock-dev libbenchmark-dev libassimp-dev doxygen valgrind gdb linux-perf
  xvfb openbox xdotool x11-utils x11-xkb-utils chromium
)
# For the test in which other programs read tilesets. A newer Node.js from elsewhere works too.
command -v npm >/dev/null || packages+=(nodejs npm)
[ "${1:-}" = "--ci" ] && packages+=(clang-format clang-tidy)
[ "${1:-}" = "--clang" ] && packages+=(clang libclang-rt-dev)

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
